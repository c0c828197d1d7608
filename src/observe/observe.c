#include "vsss/observe.h"

#include <math.h>

#include "vsss/field.h"
#include "vsss/geom.h"

// The line from one point to another.
typedef struct bearing {
  float sin, cos, angle; // angle/pi in (-1, 1]
  float distance_m;
} bearing;

// What the robots of a team share, so that every pair is worked out once.
typedef struct scene {
  float own_xy[VS_TEAM_SIZE][2], adversary_xy[VS_TEAM_SIZE][2], ball_xy[2];
  bearing robot_ball[VS_TEAM_SIZE];
  bearing goal_ball[2];                                // own goal, their goal
  bearing robot_robot[VS_TEAM_SIZE][VS_TEAM_SIZE];     // [i][j]: own robot i to ally j, i != j
  bearing robot_adversary[VS_TEAM_SIZE][VS_TEAM_SIZE]; // [i][slot]
} scene;

static float unit(double value) { return (float)(value < -1.0 ? -1.0 : value > 1.0 ? 1.0 : value); }

static inline void bearing_of(double from_x_m, double from_y_m, double to_x_m, double to_y_m, bearing *out) {
  // + 0.0 turns -0 into +0: a ball at y = -0 lies at angle pi like one at y = 0, not at -pi.
  double dx = (to_x_m - from_x_m) + 0.0, dy = (to_y_m - from_y_m) + 0.0;
  double square = dx * dx + dy * dy;
  if (square < 1e-18) { // the same point: the direction +x, as atan2(0, 0) has it
    *out = (bearing){0, 1, 0, 0};
    return;
  }
  double distance = sqrt(square), inverse = 1.0 / distance;
  out->sin = (float)(dy * inverse);
  out->cos = (float)(dx * inverse);
  out->angle = (float)(atan2(dy, dx) / VS_PI);
  out->distance_m = (float)distance;
}

static bearing reversed(bearing b) {
  if (b.distance_m == 0) return b;
  return (bearing){-b.sin, -b.cos, b.angle > 0 ? b.angle - 1 : b.angle + 1, b.distance_m};
}

static void scene_of(const vs_world *view, const int *order, scene *s) {
  const vs_ball *ball = &view->ball;
  s->ball_xy[0] = unit(ball->x_m / VS_OBS_SCALE_X_M);
  s->ball_xy[1] = unit(ball->y_m / VS_OBS_SCALE_Y_M);
  bearing_of(-VS_OBS_GOAL_X_M, 0, ball->x_m, ball->y_m, &s->goal_ball[0]);
  bearing_of(VS_OBS_GOAL_X_M, 0, ball->x_m, ball->y_m, &s->goal_ball[1]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_pose *own = &view->robot[VS_OWN][i].pose;
    const vs_pose *adversary = &view->robot[VS_ADVERSARY][order ? order[i] : i].pose;
    s->own_xy[i][0] = unit(own->x_m / VS_OBS_SCALE_X_M);
    s->own_xy[i][1] = unit(own->y_m / VS_OBS_SCALE_Y_M);
    s->adversary_xy[i][0] = unit(adversary->x_m / VS_OBS_SCALE_X_M);
    s->adversary_xy[i][1] = unit(adversary->y_m / VS_OBS_SCALE_Y_M);
    bearing_of(own->x_m, own->y_m, ball->x_m, ball->y_m, &s->robot_ball[i]);
    for (int j = i + 1; j < VS_TEAM_SIZE; j++) {
      const vs_pose *ally = &view->robot[VS_OWN][j].pose;
      bearing_of(own->x_m, own->y_m, ally->x_m, ally->y_m, &s->robot_robot[i][j]);
      s->robot_robot[j][i] = reversed(s->robot_robot[i][j]);
    }
    for (int j = 0; j < VS_TEAM_SIZE; j++) {
      const vs_pose *other = &view->robot[VS_ADVERSARY][order ? order[j] : j].pose;
      bearing_of(own->x_m, own->y_m, other->x_m, other->y_m, &s->robot_adversary[i][j]);
    }
  }
}

static void put_angle(float *out, const bearing *b) {
  out[0] = b->sin;
  out[1] = b->cos;
  out[2] = b->angle;
}

static void put_pair(float *out, const float *pair) {
  out[0] = pair[0];
  out[1] = pair[1];
}

static void put_heading(float *out, double theta_rad) {
  out[0] = (float)sin(theta_rad);
  out[1] = (float)cos(theta_rad);
  out[2] = (float)(vs_wrap_rad(theta_rad) / VS_PI);
}

static void put_robot(const scene *s, int i, double theta_rad, const float action[][2], float time_left, float *out) {
  put_pair(out + VS_OBS_OWN_XY, s->own_xy[i]);
  put_pair(out + VS_OBS_BALL_XY, s->ball_xy);
  put_heading(out + VS_OBS_OWN_HEADING, theta_rad);
  put_angle(out + VS_OBS_ANGLES, &s->robot_ball[i]);
  put_angle(out + VS_OBS_ANGLES + 3, &s->goal_ball[0]);
  put_angle(out + VS_OBS_ANGLES + 6, &s->goal_ball[1]);
  out[VS_OBS_OWN_BALL_DISTANCE] = unit(s->robot_ball[i].distance_m / VS_OBS_SCALE_DISTANCE_M);
  out[VS_OBS_BALL_GOAL_DISTANCES] = unit(s->goal_ball[0].distance_m / VS_OBS_SCALE_GOAL_DISTANCE_M);
  out[VS_OBS_BALL_GOAL_DISTANCES + 1] = unit(s->goal_ball[1].distance_m / VS_OBS_SCALE_GOAL_DISTANCE_M);
  put_pair(out + VS_OBS_OWN_ACTION, action[i]);
  out[VS_OBS_TIME_LEFT] = time_left;
  for (int j = 0, slot = 0; j < VS_TEAM_SIZE; j++) {
    put_pair(out + VS_OBS_ADVERSARIES_XY + 2 * j, s->adversary_xy[j]);
    put_angle(out + VS_OBS_ANGLES + 15 + 3 * j, &s->robot_adversary[i][j]);
    out[VS_OBS_ADVERSARIES_DISTANCE + j] = unit(s->robot_adversary[i][j].distance_m / VS_OBS_SCALE_DISTANCE_M);
    if (j == i) continue; // allies: the two others in index order
    put_pair(out + VS_OBS_ALLIES_XY + 2 * slot, s->own_xy[j]);
    put_angle(out + VS_OBS_ANGLES + 9 + 3 * slot, &s->robot_robot[i][j]);
    out[VS_OBS_ALLIES_BALL_DISTANCE + slot] = unit(s->robot_ball[j].distance_m / VS_OBS_SCALE_DISTANCE_M);
    out[VS_OBS_ALLIES_DISTANCE + slot] = unit(s->robot_robot[i][j].distance_m / VS_OBS_SCALE_DISTANCE_M);
    put_pair(out + VS_OBS_ALLIES_ACTION + 2 * slot, action[j]);
    slot++;
  }
}

void vs_observe_frame(const vs_world *view, const vs_game *game, const float *last_action, const int *adversary_order,
                      float *out) {
  scene s;
  scene_of(view, adversary_order, &s);
  float action[VS_TEAM_SIZE][2];
  for (int i = 0; i < VS_TEAM_SIZE * 2; i++) action[i / 2][i % 2] = unit(last_action[i]);
  float time_left = game->duration_s > 0 ? unit((game->duration_s - game->time_s) / game->duration_s) : 0;
  if (time_left < 0) time_left = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    put_robot(&s, i, view->robot[VS_OWN][i].pose.theta_rad, (const float(*)[2])action, time_left,
              out + i * VS_OBS_FRAME);
}
