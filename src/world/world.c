#include "vsss/world.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "vsss/check.h"
#include "vsss/field.h"
#include "vsss/geom.h"

vs_pose vs_pose_rotate_pi(vs_pose pose) {
  vs_pose turned = {-pose.x_m, -pose.y_m, vs_wrap_rad(pose.theta_rad + VS_PI)};
  return turned;
}

static vs_robot robot_rotate_pi(const vs_robot *robot) {
  vs_robot turned = *robot;
  turned.pose = vs_pose_rotate_pi(robot->pose);
  turned.vx_mps = -robot->vx_mps;
  turned.vy_mps = -robot->vy_mps;
  return turned;
}

vs_pose vs_world_parked(vs_division division, vs_team team, int robot) {
  static const double from_side_m[VS_TEAM_MOST] = {0.05, 0.05, 0.17, 0.17, 0.29};
  const vs_pitch *field = vs_pitch_of(division);
  double y_m = field->half_width_m - from_side_m[robot];
  vs_pose blue = {-(field->half_length_m - 0.05), robot == 1 || robot == 3 ? -y_m : y_m, 0};
  return team == VS_BLUE ? blue : vs_pose_rotate_pi(blue);
}

vs_pose vs_world_beside(vs_division division, vs_team team, int robot) {
  double x_m = 0.2 * (robot + 1);
  return (vs_pose){team == VS_BLUE ? -x_m : x_m, vs_pitch_of(division)->half_width_m + VS_BESIDE_M + 0.05, 0};
}

void vs_world_for_team(const vs_world *absolute, vs_team team, vs_world *view) {
  if (team == VS_BLUE) {
    if (view != absolute) *view = *absolute;
    return;
  }
  vs_world turned = *absolute;
  for (int i = 0, n = vs_team_size(absolute); i < n; i++) {
    turned.robot[VS_OWN][i] = robot_rotate_pi(&absolute->robot[VS_YELLOW][i]);
    turned.robot[VS_ADVERSARY][i] = robot_rotate_pi(&absolute->robot[VS_BLUE][i]);
  }
  turned.ball.x_m = -absolute->ball.x_m;
  turned.ball.y_m = -absolute->ball.y_m;
  turned.ball.vx_mps = -absolute->ball.vx_mps;
  turned.ball.vy_mps = -absolute->ball.vy_mps;
  *view = turned;
}

void vs_game_for_team(const vs_game *absolute, vs_team team, vs_game *view) {
  vs_game seen = *absolute;
  if (team == VS_YELLOW) {
    static const int turned_quadrant[] = {0, 3, 4, 1, 2};
    seen.score[0] = absolute->score[1];
    seen.score[1] = absolute->score[0];
    seen.last_event.team = absolute->last_event.team == VS_BLUE ? VS_YELLOW : VS_BLUE;
    seen.last_event.quadrant = turned_quadrant[absolute->last_event.quadrant];
  }
  *view = seen;
}

static vs_status check_point(const vs_pitch *field, const char *what, int index, double x, double y, vs_error *err) {
  if (fabs(x) <= field->half_length_m + 1.0 && fabs(y) <= field->half_width_m + 1.0) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s %d at (%g, %g) m: not on the field", what, index, x, y);
}

static vs_status check_numbers(const char *what, int index, const double *value, int n, vs_error *err) {
  for (int i = 0; i < n; i++)
    if (!isfinite(value[i])) return vs_fail(err, VS_FAIL, "%s %d: %g is not a number", what, index, value[i]);
  return VS_OK;
}

vs_status vs_world_check(const vs_world *world, vs_error *err) {
  const vs_pitch *field = vs_pitch_of(world->division);
  for (int t = 0; t < VS_TEAMS; t++) {
    for (int i = 0; i < field->team_size; i++) {
      const vs_robot *r = &world->robot[t][i];
      const double value[] = {r->pose.theta_rad, r->vx_mps, r->vy_mps, r->omega_radps, r->left_radps, r->right_radps};
      char what[32];
      snprintf(what, sizeof what, "%s robot", vs_team_name((vs_team)t));
      if (check_point(field, what, i, r->pose.x_m, r->pose.y_m, err) != VS_OK) return VS_FAIL;
      if (check_numbers(what, i, value, sizeof value / sizeof *value, err) != VS_OK) return VS_FAIL;
    }
  }
  const vs_ball *b = &world->ball;
  const double value[] = {b->z_m, b->vx_mps, b->vy_mps, b->vz_mps};
  if (check_point(field, "ball", 0, b->x_m, b->y_m, err) != VS_OK) return VS_FAIL;
  return check_numbers("ball", 0, value, sizeof value / sizeof *value, err);
}

bool vs_world_ok(const vs_world *w) {
  bool ok = (unsigned)w->division < VS_DIVISIONS && vs_all_finite(&w->ball.x_m, 6) && vs_are_bools(&w->ball.valid, 1);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_MOST; i++) {
    const vs_robot *r = &w->robot[i / VS_TEAM_MOST][i % VS_TEAM_MOST];
    ok = ok && vs_all_finite(&r->pose.x_m, 8) && vs_are_bools(&r->valid, 1);
  }
  return ok && llabs(w->time_us) < INT64_C(1) << 53;
}

uint64_t vs_hash_bytes(uint64_t hash, const void *data, unsigned long size) {
  const unsigned char *byte = data;
  for (unsigned long i = 0; i < size; i++) hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
  return hash;
}

uint64_t vs_world_hash(uint64_t hash, const vs_world *world) {
  hash = vs_hash_bytes(hash, &world->time_us, sizeof world->time_us);
  hash = vs_hash_bytes(hash, &world->seq, sizeof world->seq);
  if (world->division != VS_3V3) hash = vs_hash_bytes(hash, &world->division, sizeof world->division);
  for (int t = 0; t < VS_TEAMS; t++) {
    for (int i = 0, n = vs_team_size(world); i < n; i++) {
      const vs_robot *r = &world->robot[t][i];
      const double value[] = {r->pose.x_m,    r->pose.y_m,   r->pose.theta_rad, r->vx_mps,       r->vy_mps,
                              r->omega_radps, r->left_radps, r->right_radps,    (double)r->valid};
      hash = vs_hash_bytes(hash, value, sizeof value);
    }
  }
  const vs_ball *b = &world->ball;
  const double value[] = {b->x_m, b->y_m, b->z_m, b->vx_mps, b->vy_mps, b->vz_mps, (double)b->valid};
  return vs_hash_bytes(hash, value, sizeof value);
}

const char *vs_event_name(vs_event_kind kind) {
  static const char *const names[VS_EVENT_KINDS] = {"none",      "kick-off",   "goal",     "penalty", "free ball",
                                                    "goal kick", "half time",  "end",      "halt",    "free kick",
                                                    "sent off",  "extra time", "shoot-out"};
  return kind < VS_EVENT_KINDS ? names[kind] : "unknown";
}

const char *vs_team_name(vs_team team) { return team == VS_BLUE ? "blue" : "yellow"; }
