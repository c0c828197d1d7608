#include "vsss/reward.h"

#include <math.h>
#include <string.h>

#include "vsss/geom.h"

vs_reward_weights vs_reward_paper(void) {
  vs_reward_weights w = {{0}};
  w.weight[VS_REWARD_SPEED] = 0.7;
  w.weight[VS_REWARD_DISTANCE] = 0.1;
  w.weight[VS_REWARD_OFFENCE] = 0.1;
  w.weight[VS_REWARD_DEFENCE] = 0.1;
  w.weight[VS_REWARD_GOAL] = 10;
  w.weight[VS_REWARD_FOUL] = 1;
  return w;
}

const char *vs_reward_name(vs_reward_term term) {
  static const char *const names[VS_REWARD_TERMS] = {"speed", "distance", "offence",  "defence",      "goal",
                                                     "foul",  "progress", "approach", "own_distance", "still"};
  return (unsigned)term < VS_REWARD_TERMS ? names[term] : "unknown";
}

typedef struct point {
  double x_m, y_m;
} point;

static const point their_goal = {VS_REWARD_GOAL_X_M, 0}, own_goal = {-VS_REWARD_GOAL_X_M, 0};

static point ball_of(const vs_world *w) { return (point){w->ball.x_m, w->ball.y_m}; }

static point robot_of(const vs_world *w, int i) {
  const vs_pose *p = &w->robot[VS_OWN][i].pose;
  return (point){p->x_m, p->y_m};
}

static double distance_m(point a, point b) { return vs_distance_m(a.x_m, a.y_m, b.x_m, b.y_m); }

// Equations 10 to 13. The paper's arccos(dot/lengths) is the same angle as this one, which stays accurate near 0 and pi.
static double position_term(point a, point b, point c) {
  double ax = a.x_m - b.x_m, ay = a.y_m - b.y_m, cx = c.x_m - b.x_m, cy = c.y_m - b.y_m;
  return atan2(fabs(ax * cy - ay * cx), ax * cx + ay * cy) / VS_PI - 1.0;
}

static double step_term(double way_m) { return vs_clamp(way_m / VS_REWARD_STEP_M, -1.0, 1.0); }

static void dense_terms(const vs_world *previous, const vs_world *view, double terms[VS_TEAM_SIZE][VS_REWARD_TERMS]) {
  point ball = ball_of(view);
  double gain_m = distance_m(ball_of(previous), their_goal) - distance_m(ball, their_goal);
  double nearest_m = 1.0, still = distance_m(ball_of(previous), ball) < VS_REWARD_STILL_M ? -1.0 : 0.0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    point robot = robot_of(view, i);
    double before_m = distance_m(robot_of(previous, i), ball_of(previous)), now_m = distance_m(robot, ball);
    nearest_m = fmin(nearest_m, now_m);
    terms[i][VS_REWARD_SPEED] = step_term(gain_m - VS_REWARD_OFFSET_M);
    terms[i][VS_REWARD_OFFENCE] = position_term(robot, ball, their_goal);
    terms[i][VS_REWARD_DEFENCE] = position_term(ball, robot, own_goal);
    terms[i][VS_REWARD_PROGRESS] = gain_m / VS_REWARD_STEP_M;
    terms[i][VS_REWARD_STILL] = still;
    terms[i][VS_REWARD_APPROACH] = step_term(before_m - now_m);
    terms[i][VS_REWARD_OWN_DISTANCE] = -fmin(1.0, now_m);
  }
  for (int i = 0; i < VS_TEAM_SIZE; i++) terms[i][VS_REWARD_DISTANCE] = -nearest_m;
}

void vs_reward_terms(const vs_world *previous, const vs_world *view, const vs_event *event, const vs_game *game,
                     double terms[VS_TEAM_SIZE][VS_REWARD_TERMS]) {
  memset(terms, 0, VS_TEAM_SIZE * sizeof *terms);
  bool foul = event->kind == VS_EVENT_PENALTY && event->team == VS_YELLOW; // in team view: the adversary
  if (event->kind == VS_EVENT_GOAL) {
    double left = vs_clamp((game->duration_s - event->time_s) / game->duration_s, 0.0, 1.0); // equation 16
    double goal = (event->team == VS_BLUE ? 1.0 : -1.0) * (1.0 + left);
    for (int i = 0; i < VS_TEAM_SIZE; i++) terms[i][VS_REWARD_GOAL] = goal;
  } else if (foul) {
    for (int i = 0; i < VS_TEAM_SIZE; i++) terms[i][VS_REWARD_FOUL] = -1.0;
  } else {
    dense_terms(previous, view, terms);
  }
}

void vs_reward_sum(const double terms[VS_TEAM_SIZE][VS_REWARD_TERMS], const vs_reward_weights *weights,
                   float reward[VS_TEAM_SIZE]) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    double sum = 0;
    for (int k = 0; k < VS_REWARD_TERMS; k++) sum += weights->weight[k] * terms[i][k];
    reward[i] = (float)sum;
  }
}
