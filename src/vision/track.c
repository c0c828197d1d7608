// Detections -> the world. Pure: no clock but the capture stamps, plain data.
#include "vsss/track.h"

#include <math.h>

#include "vsss/geom.h"
#include "vsss/unseen.h"

// A jump beyond the gate is first refused; a second one at the same place moves the track there.
#define GATE_M        0.06 // beyond four deviations
#define AGREE_M       0.10 // a robot at full speed moves 5 cm a frame
#define RESTART_US    1000000
#define FIRST_SPEED   1.0 // deviation of an unknown speed, m/s (rad/s for headings: times 10)
#define FIRST_TURNING 10.0

vs_track_def vs_track_def_default(void) {
  return (vs_track_def){.team = VS_BLUE,
                        .attack_plus_x = true,
                        .own = VS_MARK_APRIL,
                        .their = VS_MARK_PATCH,
                        .tag_id = {0, 1, 2},
                        .plate_id = {{1, 12, 23}, {101, 112, 123}},     // vs_plate_default_code
                        .aruco_id = {{256, 272, 273}, {955, 771, 939}}, // vs_aruco_league_id
                        .tag_height_m = VS_ROBOT_HEIGHT_M,
                        .patch_height_m = VS_ROBOT_HEIGHT_M,
                        .ball_height_m = VS_BALL_RADIUS_M,
                        .margin_m = 0.10,
                        // Wheels on a floor brake and turn with up to 9 m/s2; a hit ball is faster still.
                        .robot_acceleration_mps2 = 6.0,
                        .ball_acceleration_mps2 = 20.0,
                        .turn_acceleration_radps2 = 200.0,
                        .position_noise_m = 0.001,
                        .ball_noise_m = 0.002,
                        .patch_noise_m = 0.002,
                        .heading_noise_rad = 0.02};
}

static bool fresh(const vs_object *o, int64_t now_us) { return o->seen && now_us - o->seen_us <= VS_TRACK_HOLD_US; }

// Predictions end VS_TRACK_HOLD_US after the last sight.
static double seconds_ahead(const vs_object *o, int64_t time_us) {
  int64_t last = o->seen_us + VS_TRACK_HOLD_US;
  return 1e-6 * (double)((time_us < last ? time_us : last) - o->time_us);
}

static void predict(vs_object *o, int64_t time_us, double acceleration, double turn_acceleration) {
  double dt_s = o->seen ? seconds_ahead(o, time_us) : 0;
  if (dt_s <= 0) return;
  vs_kalman_predict(&o->x, dt_s, acceleration);
  vs_kalman_predict(&o->y, dt_s, acceleration);
  if (turn_acceleration > 0) vs_kalman_predict(&o->theta, dt_s, turn_acceleration);
  o->time_us += llround(1e6 * dt_s);
}

// A measurement in metres.
typedef struct sight {
  double x_m, y_m, theta_rad, noise_m, heading_noise_rad; // heading_noise_rad 0: no heading
} sight;

static void start_at(vs_object *o, const sight *z, int64_t now_us) {
  vs_kalman_start(&o->x, z->x_m, z->noise_m, FIRST_SPEED);
  vs_kalman_start(&o->y, z->y_m, z->noise_m, FIRST_SPEED);
  vs_kalman_start(&o->theta, z->theta_rad, z->heading_noise_rad, FIRST_TURNING);
  o->seen = o->ever = true;
  o->outliers = 0;
  o->time_us = o->seen_us = now_us;
}

static double gate_m(const vs_object *o, double noise_m) {
  return GATE_M + 4 * sqrt(fmax(o->x.p[0], o->y.p[0]) + noise_m * noise_m);
}

static double distance_to(const vs_object *o, const sight *z) {
  return hypot(z->x_m - o->x.value, z->y_m - o->y.value);
}

// Takes a measurement in; false: refused.
static bool offer(vs_object *o, const sight *z, int64_t now_us) {
  if (!fresh(o, now_us)) return start_at(o, z, now_us), true;
  if (distance_to(o, z) > gate_m(o, z->noise_m)) {
    bool agree = o->outliers > 0 && hypot(z->x_m - o->outlier_x, z->y_m - o->outlier_y) < AGREE_M;
    if (agree) return start_at(o, z, now_us), true;
    o->outliers++;
    o->outlier_x = z->x_m, o->outlier_y = z->y_m;
    return false;
  }
  vs_kalman_update(&o->x, z->x_m - o->x.value, z->noise_m);
  vs_kalman_update(&o->y, z->y_m - o->y.value, z->noise_m);
  if (z->heading_noise_rad > 0)
    vs_kalman_update(&o->theta, vs_wrap_rad(z->theta_rad - o->theta.value), z->heading_noise_rad);
  o->outliers = 0;
  o->time_us = o->seen_us = now_us;
  return true;
}

static bool on_field(const vs_track_def *def, double x_m, double y_m) {
  return fabs(x_m) <= VS_FIELD_HALF_LENGTH_M + def->margin_m && fabs(y_m) <= VS_FIELD_HALF_WIDTH_M + def->margin_m;
}

static bool sight_of_tag(const vs_track_def *def, const vs_calib *calib, const vs_tag *tag, double yaw_rad, sight *z) {
  if (!vs_calib_square(calib, tag->corner_px, def->tag_height_m, &z->x_m, &z->y_m, &z->theta_rad)) return false;
  z->theta_rad = vs_wrap_rad(z->theta_rad - yaw_rad);
  z->noise_m = def->position_noise_m;
  z->heading_noise_rad = def->heading_noise_rad;
  return on_field(def, z->x_m, z->y_m);
}

static bool is_of(const vs_track_def *def, const vs_tag *tag, int side, int index) {
  vs_mark mark = side == VS_OWN ? def->own : def->their;
  vs_team team = side == VS_OWN ? def->team : (vs_team)(1 - def->team);
  int id = mark == VS_MARK_ARUCO    ? def->aruco_id[team][index]
           : mark == VS_MARK_COLOUR ? def->plate_id[team][index]
                                    : def->tag_id[index];
  return tag->kind == mark && tag->id == id;
}

// A robot known by its mark.
static void update_marked(vs_tracker *t, const vs_calib *calib, const vs_detections *seen, int side, int index) {
  vs_object *o = &t->robot[side][index];
  double yaw_rad = side == VS_OWN ? t->def.tag_yaw_rad[index] : 0.0;
  const sight *best = NULL;
  sight z[2]; // the best so far and the one in hand
  double best_score = 0;
  for (int i = 0; i < seen->tags; i++) {
    sight *this = best == &z[0] ? &z[1] : &z[0];
    if (!is_of(&t->def, &seen->tag[i], side, index)) continue;
    if (!sight_of_tag(&t->def, calib, &seen->tag[i], yaw_rad, this)) {
      t->stats.refused++;
      continue;
    }
    // Twice the same number: a reflection or a spare robot. The nearer to the track is ours.
    double score = fresh(o, seen->capture_us) ? -distance_to(o, this) : seen->tag[i].margin;
    if (!best || score > best_score) best = this, best_score = score;
  }
  bool taken = best && offer(o, best, seen->capture_us);
  t->stats.refused += best && !taken;
  t->stats.lost[side][index] += !taken;
}

// Blobs on the field, in metres, best first.
static int sights_of_blobs(vs_tracker *t, const vs_calib *calib, const vs_blob *blob, int count, double height_m,
                           double noise_m, sight *z) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    sight *s = &z[kept];
    *s = (sight){.noise_m = noise_m};
    if (vs_calib_to_field(calib, blob[i].x_px, blob[i].y_px, height_m, &s->x_m, &s->y_m) &&
        on_field(&t->def, s->x_m, s->y_m))
      kept++;
    else
      t->stats.refused++;
  }
  return kept;
}

static void update_ball(vs_tracker *t, const vs_calib *calib, const vs_detections *seen) {
  sight z[VS_MAX_BLOBS];
  int count = sights_of_blobs(t, calib, seen->ball, seen->balls, t->def.ball_height_m, t->def.ball_noise_m, z),
      best = 0;
  bool tracked = fresh(&t->ball, seen->capture_us);
  for (int i = 1; tracked && i < count; i++)
    if (distance_to(&t->ball, &z[i]) < distance_to(&t->ball, &z[best])) best = i;
  // Nothing near the track: the best looking one may be where the ball was put.
  if (tracked && count > 0 && distance_to(&t->ball, &z[best]) > gate_m(&t->ball, z[best].noise_m)) best = 0;
  bool taken = count > 0 && offer(&t->ball, &z[best], seen->capture_us);
  t->stats.refused += count > 0 && !taken;
  t->stats.ball_lost += !taken;
}

// The nearest free pair of slot and blob: among slots in sight only pairs within the gate, among the others any.
static bool nearest_pair(const vs_tracker *t, const sight *z, int count, unsigned slots, unsigned blobs, bool in_sight,
                         int64_t now_us, int *slot, int *blob) {
  double best = INFINITY;
  for (int s = 0; s < VS_TEAM_SIZE; s++) {
    const vs_object *o = &t->robot[VS_ADVERSARY][s];
    if (slots & 1u << s || (in_sight && !fresh(o, now_us))) continue;
    for (int b = 0; b < count; b++) {
      if (blobs & 1u << b) continue;
      double d = o->seen ? distance_to(o, &z[b]) : 10.0 + s; // never seen: last, in order
      if (in_sight && d > gate_m(o, z[b].noise_m)) continue;
      if (d < best) best = d, *slot = s, *blob = b;
    }
  }
  return isfinite(best);
}

static void update_adversaries(vs_tracker *t, const vs_calib *calib, const vs_detections *seen) {
  sight z[VS_MAX_BLOBS];
  int count =
      sights_of_blobs(t, calib, seen->adversary, seen->adversaries, t->def.patch_height_m, t->def.patch_noise_m, z);
  unsigned slots = 0, blobs = 0, measured = 0;
  for (int pass = 0; pass < 2; pass++) {
    int slot = 0, blob = 0;
    while (nearest_pair(t, z, count, slots, blobs, pass == 0, seen->capture_us, &slot, &blob)) {
      slots |= 1u << slot, blobs |= 1u << blob;
      bool taken = offer(&t->robot[VS_ADVERSARY][slot], &z[blob], seen->capture_us);
      measured |= (unsigned)taken << slot;
      t->stats.refused += !taken;
    }
  }
  for (int s = 0; s < VS_TEAM_SIZE; s++) t->stats.lost[VS_ADVERSARY][s] += !(measured & 1u << s);
}

// A colour patch shows no heading.
static bool heading_shown(const vs_track_def *def) { return def->their != VS_MARK_PATCH; }

void vs_track_init(vs_tracker *tracker, const vs_track_def *def) { *tracker = (vs_tracker){.def = *def}; }

void vs_track_restart(vs_tracker *tracker) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) tracker->robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].seen = false;
  tracker->ball.seen = false;
}

void vs_track_update(vs_tracker *t, const vs_calib *calib, const vs_detections *seen) {
  int64_t step_us = seen->capture_us - t->time_us;
  if (t->stats.frames && step_us <= 0 && step_us > -RESTART_US) {
    t->stats.late++;
    return;
  }
  // A source that began anew, or stood still for a second: nothing before it counts.
  if (t->stats.frames && (step_us <= -RESTART_US || step_us > RESTART_US)) vs_track_restart(t);
  t->stats.frames++;
  t->time_us = seen->capture_us;
  t->seq = seen->seq;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    predict(&t->robot[VS_OWN][i], t->time_us, t->def.robot_acceleration_mps2, t->def.turn_acceleration_radps2);
    predict(&t->robot[VS_ADVERSARY][i], t->time_us, t->def.robot_acceleration_mps2,
            heading_shown(&t->def) ? t->def.turn_acceleration_radps2 : 0.0);
  }
  predict(&t->ball, t->time_us, t->def.ball_acceleration_mps2, 0.0);
  for (int i = 0; i < VS_TEAM_SIZE; i++) update_marked(t, calib, seen, VS_OWN, i);
  for (int i = 0; heading_shown(&t->def) && i < VS_TEAM_SIZE; i++) update_marked(t, calib, seen, VS_ADVERSARY, i);
  if (!heading_shown(&t->def)) update_adversaries(t, calib, seen);
  update_ball(t, calib, seen);
}

// Not since a placement: as if for ever.
static int64_t since_us(const vs_object *o, int64_t now_us) { return o->seen ? now_us - o->seen_us : INT64_MAX; }

// With the filters' pose where nothing moves it on.
static void robot_at(const vs_object *o, int64_t time_us, double turn, vs_robot *out) {
  const vs_robot estimate = {.pose = {o->x.value, o->y.value, o->theta.value},
                             .vx_mps = o->seen ? o->x.rate : 0,
                             .vy_mps = o->seen ? o->y.rate : 0,
                             .omega_radps = o->seen ? o->theta.rate : 0};
  vs_unseen_robot(&estimate, o->time_us - o->seen_us, since_us(o, time_us), out);
  out->pose.x_m *= turn, out->pose.y_m *= turn;
  out->vx_mps *= turn, out->vy_mps *= turn;
}

void vs_track_world(const vs_tracker *t, int64_t time_us, vs_world *out) {
  if (time_us == 0) time_us = t->time_us;
  // Absolute frame: blue attacks +x.
  bool turned = (t->def.team == VS_BLUE) != t->def.attack_plus_x;
  double turn = turned ? -1.0 : 1.0;
  *out = (vs_world){.time_us = time_us, .seq = t->seq};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_robot *own = &out->robot[t->def.team][i], *other = &out->robot[1 - t->def.team][i];
    robot_at(&t->robot[VS_OWN][i], time_us, turn, own);
    own->pose.theta_rad = vs_wrap_rad(own->pose.theta_rad + (turned ? VS_PI : 0.0));
    robot_at(&t->robot[VS_ADVERSARY][i], time_us, turn, other);
    other->pose.theta_rad = heading_shown(&t->def) ? vs_wrap_rad(other->pose.theta_rad + (turned ? VS_PI : 0.0)) : 0.0;
    if (!t->robot[VS_OWN][i].ever) own->pose = vs_world_parked(VS_3V3, t->def.team, i);
    if (!t->robot[VS_ADVERSARY][i].ever) other->pose = vs_world_parked(VS_3V3, (vs_team)(1 - t->def.team), i);
  }
  vs_robot ball;
  robot_at(&t->ball, time_us, turn, &ball);
  out->ball = (vs_ball){.x_m = ball.pose.x_m, .y_m = ball.pose.y_m, .z_m = VS_BALL_RADIUS_M, .valid = ball.valid};
  out->ball.vx_mps = ball.vx_mps, out->ball.vy_mps = ball.vy_mps;
}
