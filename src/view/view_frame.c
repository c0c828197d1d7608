#include <stdio.h>

#include "vsss/view.h"

int vs_view_frame(double time_s, const vs_world *w, const vs_game *game, const vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST],
                  const char *event, char *out, size_t size) {
  int n = snprintf(out, size, "[%.3f,%d,%.4f,%.4f,[", time_s, w->ball.valid, w->ball.x_m, w->ball.y_m);
  const int robots = vs_team_size(w);
  for (int k = 0; k < VS_TEAMS * robots && (size_t)n < size; k++) {
    const vs_robot *r = &w->robot[k / robots][k % robots];
    vs_wheels c = wheels ? wheels[k / robots][k % robots] : (vs_wheels){0, 0};
    n += snprintf(out + n, size - (size_t)n, "%s[%d,%.4f,%.4f,%.3f,%.1f,%.1f]", k ? "," : "", r->valid, r->pose.x_m,
                  r->pose.y_m, r->pose.theta_rad, c.left_radps, c.right_radps);
  }
  if ((size_t)n < size)
    n += snprintf(out + n, size - (size_t)n, "],%d,%d,%.2f,\"%s\"]", game->score[VS_BLUE], game->score[VS_YELLOW],
                  game->time_s, event);
  return n;
}
