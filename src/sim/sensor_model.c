// From the true world to what the camera and the tracker tell, and from decided commands to those that arrive.
#include "vsss/sensor_model.h"

#include <math.h>
#include <string.h>

#include "vsss/check.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/unseen.h"

#define NEAR_WALL_M 0.1 // detections are lost twice as often there: light falls off, walls throw shadows

static double draw(vs_rng *rng, vs_range range) { return vs_rng_range(rng, range.low, range.high); }

static bool is_ideal(const vs_realism *realism, uint64_t seed) {
  vs_rng rng = vs_rng_make(seed, 3);
  return realism->ideal_share > 0 && vs_rng_uniform(&rng) < realism->ideal_share;
}

void vs_sensors_never(const vs_realism *realism, uint64_t seed, bool never[VS_TEAMS][VS_SENSOR_OBJECTS]) {
  memset(never, 0, VS_TEAMS * sizeof never[0]);
  if (realism->never_seen_share <= 0 || is_ideal(realism, seed)) return;
  vs_rng rng = vs_rng_make(seed, 4);
  const int ball = VS_SENSOR_OBJECTS - 1;
  for (int team = 0; team < VS_TEAMS; team++) {
    for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
      bool own = i / VS_TEAM_SIZE == team, is_never = vs_rng_uniform(&rng) < realism->never_seen_share;
      never[team][i / VS_TEAM_SIZE * VS_TEAM_MOST + i % VS_TEAM_SIZE] = is_never && !own;
    }
    never[team][ball] = vs_rng_uniform(&rng) < realism->never_seen_share;
  }
  // The robots of larger teams last: what a seed means to 3 against 3 stays.
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = VS_TEAM_SIZE; i < VS_TEAM_MOST; i++)
      never[team][!team * VS_TEAM_MOST + i] = vs_rng_uniform(&rng) < realism->never_seen_share;
}

void vs_sensors_hide(const bool never[VS_SENSOR_OBJECTS], vs_world *measured) {
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0, n = vs_team_size(measured); i < n; i++)
      if (never[team * VS_TEAM_MOST + i])
        measured->robot[team][i] = (vs_robot){.pose = vs_world_parked(measured->division, (vs_team)team, i)};
  if (never[VS_SENSOR_OBJECTS - 1]) measured->ball = (vs_ball){.z_m = VS_BALL_RADIUS_M};
}

void vs_sensors_reset(vs_sensors *sensors, const vs_realism *realism, uint64_t seed) {
  const vs_realism ideal = vs_realism_default();
  if (is_ideal(realism, seed)) realism = &ideal;
  memset(sensors, 0, sizeof *sensors);
  sensors->rng = vs_rng_make(seed, 0);
  sensors->params = vs_realism_draw(realism, seed);
  sensors->noise = realism->noise;
  sensors->noise_scale = draw(&sensors->rng, realism->noise_scale);
  double bias = draw(&sensors->rng, realism->position_bias_m), to = vs_rng_range(&sensors->rng, 0, 2 * VS_PI);
  sensors->bias_x_m = bias * cos(to);
  sensors->bias_y_m = bias * sin(to);
  double turn = draw(&sensors->rng, realism->heading_bias_rad);
  sensors->bias_heading_rad = vs_rng_below(&sensors->rng, 2) ? turn : -turn;
  sensors->position_scale = draw(&sensors->rng, realism->position_scale);
  sensors->latency_s = draw(&sensors->rng, realism->latency_s);
  sensors->latency_jitter_s = draw(&sensors->rng, realism->latency_jitter_s);
  sensors->detection_loss = draw(&sensors->rng, realism->detection_loss);
  sensors->radio_loss = draw(&sensors->rng, realism->radio_loss);
  sensors->detection_burst_frames = realism->detection_burst_frames;
  sensors->radio_burst_frames = realism->radio_burst_frames;
}

static bool bursts_ok(const vs_range *frames) {
  return vs_all_finite(&frames->low, 2) && frames->low >= 0 && frames->low <= frames->high && frames->high <= 1e6;
}

bool vs_sensors_ok(const vs_sensors *s) {
  bool ok = vs_are_bools(&s->noise, 1) && vs_are_bools(s->ever, VS_SENSOR_OBJECTS) &&
            vs_all_finite(&s->noise_scale, 9) && bursts_ok(&s->detection_burst_frames) &&
            bursts_ok(&s->radio_burst_frames) &&
            vs_all_finite(&s->queue[0][0][0].left_radps, sizeof s->queue / sizeof(double)) &&
            vs_all_finite(&s->applied[0][0].left_radps, sizeof s->applied / sizeof(double)) &&
            vs_all_finite(&s->filter[0][0].value, sizeof s->filter / sizeof(double)) &&
            vs_are_bools(s->filtering, VS_SENSOR_OBJECTS);
  for (int i = 0; i < VS_SENSOR_OBJECTS; i++)
    ok = ok && s->lost_frames[i] >= 0 && s->held_frames[i] >= 0 && s->held_frames[i] < 1000000000;
  for (int t = 0; t < VS_TEAMS; t++) ok = ok && s->radio_lost_frames[t] >= 0;
  return ok;
}

// Length of a loss that begins now, in whole frames, this one included.
static int burst(vs_rng *rng, vs_range frames) {
  int low = (int)lround(frames.low), high = (int)lround(frames.high);
  return low + (int)vs_rng_below(rng, (uint32_t)(high - low) + 1);
}

static double error(vs_sensors *s, double sigma) {
  return s->noise ? s->noise_scale * sigma * vs_rng_normal(&s->rng) : 0;
}

static void measure_place(vs_sensors *s, double *x_m, double *y_m) {
  *x_m = *x_m * s->position_scale + s->bias_x_m + error(s, VS_NOISE_X_M);
  *y_m = *y_m * s->position_scale + s->bias_y_m + error(s, VS_NOISE_Y_M);
}

// Whether this frame's detection of an object at (x, y) is lost; counts what is left of the burst.
static bool lost(vs_sensors *s, const vs_pitch *field, int object, double x_m, double y_m) {
  if (s->detection_loss <= 0) return false;
  if (s->lost_frames[object] == 0) {
    bool near_wall = fabs(x_m) > field->half_length_m - NEAR_WALL_M || fabs(y_m) > field->half_width_m - NEAR_WALL_M;
    if (vs_rng_uniform(&s->rng) >= s->detection_loss * (near_wall ? 2 : 1)) return false;
    s->lost_frames[object] = burst(&s->rng, s->detection_burst_frames);
  }
  s->lost_frames[object]--;
  return true;
}

// Since the last detection; for ever where there was none since a placement.
static int64_t since_us(const vs_sensors *s, int object) {
  return s->filtering[object] ? llround(1e6 / VS_CAMERA_HZ * s->held_frames[object]) : INT64_MAX;
}

void vs_sensors_restart(vs_sensors *s) {
  memset(s->filtering, 0, sizeof s->filtering);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_MOST; i++) {
    vs_robot *last = &s->last.robot[i / VS_TEAM_MOST][i % VS_TEAM_MOST];
    last->vx_mps = last->vy_mps = last->omega_radps = 0;
  }
  s->last.ball.vx_mps = s->last.ball.vy_mps = 0;
}

// One more measurement of an object. One that was out of sight for longer than it is held begins anew.
static void filter(vs_sensors *s, int object, const double value[3], double acceleration) {
  static const double unknown_rate[3] = {1.0, 1.0, 10.0}; // m/s, m/s, rad/s
  const double noise[3] = {VS_NOISE_X_M, VS_NOISE_Y_M, VS_NOISE_HEADING_RAD};
  const double change[3] = {acceleration, acceleration, VS_SENSOR_TURN_ACCELERATION_RADPS2};
  bool held = since_us(s, object) <= VS_UNSEEN_HOLD_US;
  for (int k = 0; k < 3; k++) {
    vs_kalman *f = &s->filter[object][k];
    if (!held) {
      vs_kalman_start(f, value[k], noise[k], unknown_rate[k]);
      continue;
    }
    for (int frame = 0; frame <= s->held_frames[object]; frame++) vs_kalman_predict(f, 1.0 / VS_CAMERA_HZ, change[k]);
    double innovation = value[k] - f->value;
    vs_kalman_update(f, k == 2 ? vs_wrap_rad(innovation) : innovation, noise[k]);
  }
  s->filtering[object] = s->ever[object] = true;
  s->held_frames[object] = 0;
}

static void measure_robot(vs_sensors *s, const vs_pitch *field, int team, int index, vs_robot *robot) {
  int object = team * VS_TEAM_MOST + index;
  bool is_lost = lost(s, field, object, robot->pose.x_m, robot->pose.y_m);
  measure_place(s, &robot->pose.x_m, &robot->pose.y_m);
  double heading = robot->pose.theta_rad + s->bias_heading_rad + error(s, VS_NOISE_HEADING_RAD);
  if (is_lost) {
    s->held_frames[object]++;
    vs_unseen_robot(&s->last.robot[team][index], 0, since_us(s, object), robot);
    robot->pose.theta_rad = vs_wrap_rad(robot->pose.theta_rad);
    if (!s->ever[object]) robot->pose = vs_world_parked(s->last.division, (vs_team)team, index);
    return;
  }
  robot->left_radps = robot->right_radps = 0;
  robot->pose.theta_rad = vs_wrap_rad(heading);
  const double pose[3] = {robot->pose.x_m, robot->pose.y_m, robot->pose.theta_rad};
  filter(s, object, pose, VS_SENSOR_ROBOT_ACCELERATION_MPS2);
  robot->vx_mps = s->filter[object][0].rate;
  robot->vy_mps = s->filter[object][1].rate;
  robot->omega_radps = s->filter[object][2].rate;
  robot->valid = true;
  s->last.robot[team][index] = *robot;
}

static void measure_ball(vs_sensors *s, const vs_pitch *field, vs_ball *ball) {
  enum { BALL = VS_SENSOR_OBJECTS - 1 };
  bool is_lost = lost(s, field, BALL, ball->x_m, ball->y_m);
  measure_place(s, &ball->x_m, &ball->y_m);
  if (is_lost) {
    s->held_frames[BALL]++;
    vs_unseen_ball(&s->last.ball, 0, since_us(s, BALL), ball);
    if (!s->ever[BALL]) *ball = (vs_ball){.z_m = VS_BALL_RADIUS_M};
    return;
  }
  const double place[3] = {ball->x_m, ball->y_m, 0};
  filter(s, BALL, place, VS_SENSOR_BALL_ACCELERATION_MPS2);
  ball->vx_mps = s->filter[BALL][0].rate;
  ball->vy_mps = s->filter[BALL][1].rate;
  ball->valid = true;
  s->last.ball = *ball;
}

void vs_sensors_measure(vs_sensors *s, const vs_world *truth, vs_world *measured) {
  const vs_pitch *field = vs_pitch_of(truth->division);
  vs_world world = *truth;
  s->last.division = truth->division;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < field->team_size; i++) measure_robot(s, field, t, i, &world.robot[t][i]);
  measure_ball(s, field, &world.ball);
  *measured = world;
}

// Not in sight for longer than it is held.
static bool out_of_sight(const vs_sensors *s, int object) {
  return s->held_frames[object] > 0 && since_us(s, object) > VS_UNSEEN_HOLD_US;
}

static vs_wheels mix(vs_wheels a, vs_wheels b, double share_of_b) {
  if (share_of_b == 0) return a;
  return (vs_wheels){a.left_radps + share_of_b * (b.left_radps - a.left_radps),
                     a.right_radps + share_of_b * (b.right_radps - a.right_radps)};
}

void vs_sensors_command(vs_sensors *s, const vs_wheels in[VS_TEAMS][VS_TEAM_MOST],
                        vs_wheels out[VS_TEAMS][VS_TEAM_MOST]) {
  const int team_size = vs_team_size(&s->last);
  memmove(s->queue[1], s->queue[0], sizeof s->queue - sizeof s->queue[0]);
  memcpy(s->queue[0], in, sizeof s->queue[0]);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_MOST; i++)
    if (out_of_sight(s, i)) s->queue[0][i / VS_TEAM_MOST][i % VS_TEAM_MOST] = (vs_wheels){0, 0};
  double latency_s = s->latency_s;
  if (s->latency_jitter_s > 0) latency_s += vs_rng_range(&s->rng, -s->latency_jitter_s, s->latency_jitter_s);
  double frames = vs_clamp(latency_s * VS_CAMERA_HZ, 0, VS_SENSOR_DELAY_FRAMES - 1.001);
  int whole = (int)frames;
  for (int team = 0; team < VS_TEAMS; team++) {
    if (s->radio_loss > 0 && s->radio_lost_frames[team] == 0 && vs_rng_uniform(&s->rng) < s->radio_loss) {
      s->radio_lost_frames[team] = burst(&s->rng, s->radio_burst_frames);
    }
    bool arrives = s->radio_lost_frames[team] == 0;
    if (!arrives) s->radio_lost_frames[team]--;
    for (int i = 0; i < team_size && arrives; i++) {
      s->applied[team][i] = mix(s->queue[whole][team][i], s->queue[whole + 1][team][i], frames - whole);
    }
  }
  memcpy(out, s->applied, sizeof s->applied);
}
