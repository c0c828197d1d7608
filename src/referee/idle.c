#include "vsss/idle.h"

#include "referee_internal.h"
#include "vsss/geom.h"

// The robot in its own area that is nearest to its goal, while the ball is elsewhere; -1: none is excused.
static int excused(const vs_world *w, int team) {
  const vs_pitch *field = vs_pitch_of(w->division);
  int side = team == VS_BLUE ? -1 : 1, keeper = -1;
  if (vs_in_area(field, side, w->ball.x_m, w->ball.y_m)) return -1;
  double goal_x_m = side * field->half_length_m, nearest_m = INFINITY;
  for (int i = 0; i < field->team_size; i++) {
    const vs_pose *p = &w->robot[team][i].pose;
    double d = vs_distance_m(p->x_m, p->y_m, goal_x_m, 0);
    if (vs_in_area(field, side, p->x_m, p->y_m) && d < nearest_m) nearest_m = d, keeper = i;
  }
  return keeper;
}

void vs_idle_step(vs_idle *idle, const vs_world *w, const vs_event *event, double dt_s) {
  bool restart = event->kind != VS_EVENT_NONE && event->kind != VS_EVENT_SENT_OFF,
       half =
           event->kind == VS_EVENT_HALF_TIME || event->kind == VS_EVENT_EXTRA_TIME || event->kind == VS_EVENT_SHOOT_OUT;
  for (int t = 0; t < VS_TEAMS; t++) {
    int keeper = excused(w, t);
    for (int i = 0, n = vs_team_size(w); i < n; i++) {
      const vs_pose *p = &w->robot[t][i].pose;
      double x_m = idle->robot[t][i].x_m, y_m = idle->robot[t][i].y_m;
      bool moved = vs_distance_m(p->x_m, p->y_m, x_m, y_m) > VS_IDLE_RADIUS_M;
      if (half) idle->robot[t][i].off = false;
      if (moved || half) idle->robot[t][i].warned = false;
      if (moved || restart || i == keeper || idle->robot[t][i].off) {
        idle->robot[t][i].x_m = p->x_m;
        idle->robot[t][i].y_m = p->y_m;
        idle->robot[t][i].stayed_s = 0;
        continue;
      }
      idle->robot[t][i].stayed_s += dt_s;
      if (!vs_reached(idle->robot[t][i].stayed_s, VS_IDLE_S, dt_s)) continue;
      idle->warnings[t]++;
      if (idle->robot[t][i].warned) {
        idle->sent_off[t]++;
        idle->robot[t][i].off = true;
      }
      idle->robot[t][i].warned = true;
      idle->robot[t][i].stayed_s = 0;
    }
  }
}
