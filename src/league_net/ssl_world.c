// Positions of a shared vision -> a world with velocities.
#include <math.h>

#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/ssl_vision.h"

// Deviations: of what is measured, of how the objects accelerate, of a rate that is not known yet.
#define NOISE_M      0.002
#define NOISE_RAD    0.02
#define ROBOT_MPS2   8.0
#define ROBOT_RADPS2 150.0
#define BALL_MPS2    8.0
#define RATE_MPS     1.0
#define RATE_RADPS   10.0
#define LONGEST_S    0.5 // the sender was stopped, or restarted

static void follow(vs_kalman *k, bool anew, double dt_s, double value, bool angle, double acceleration, double noise,
                   double rate) {
  if (anew) {
    vs_kalman_start(k, value, noise, rate);
    return;
  }
  vs_kalman_predict(k, dt_s, acceleration);
  double innovation = value - k->value;
  vs_kalman_update(k, angle ? vs_wrap_rad(innovation) : innovation, noise);
  if (angle) k->value = vs_wrap_rad(k->value);
}

// True: it begins anew.
static bool seen_again(vs_ssl_object *o, int64_t now_us, double *dt_s) {
  bool anew = o->seen_us == 0 || now_us - o->seen_us > VS_SSL_HOLD_US;
  *dt_s = 1e-6 * (double)(now_us - o->seen_us);
  o->seen_us = now_us;
  return anew;
}

static void follow_robot(vs_ssl_object *o, const vs_pose *p, int64_t now_us) {
  double dt_s;
  bool anew = seen_again(o, now_us, &dt_s);
  follow(&o->x, anew, dt_s, p->x_m, false, ROBOT_MPS2, NOISE_M, RATE_MPS);
  follow(&o->y, anew, dt_s, p->y_m, false, ROBOT_MPS2, NOISE_M, RATE_MPS);
  follow(&o->theta, anew, dt_s, p->theta_rad, true, ROBOT_RADPS2, NOISE_RAD, RATE_RADPS);
}

static void follow_ball(vs_ssl_object *o, double x_m, double y_m, int64_t now_us) {
  double dt_s;
  bool anew = seen_again(o, now_us, &dt_s);
  follow(&o->x, anew, dt_s, x_m, false, BALL_MPS2, NOISE_M, RATE_MPS);
  follow(&o->y, anew, dt_s, y_m, false, BALL_MPS2, NOISE_M, RATE_MPS);
}

static bool held(const vs_ssl_object *o, int64_t now_us) { return o->seen_us && now_us - o->seen_us <= VS_SSL_HOLD_US; }

// Several cameras may tell of one moment, or of moments in another order.
static int64_t moment(vs_ssl_world *s, double capture_s, int64_t now_us) {
  double dt_s = capture_s - s->capture_s;
  bool told = s->time_us && capture_s > 0 && s->capture_s > 0 && fabs(dt_s) < LONGEST_S;
  int64_t by_sender_us = s->time_us + llround(1e6 * dt_s);
  // Its clock may go faster or slower than ours, and never ahead of it.
  int64_t us = told && by_sender_us <= now_us && now_us - by_sender_us < VS_SSL_HOLD_US ? by_sender_us : now_us;
  if (us <= s->time_us) return s->time_us;
  s->capture_s = capture_s;
  s->time_us = us;
  return us;
}

void vs_ssl_world_see(vs_ssl_world *s, const vs_ssl_frame *f, int64_t now_us, vs_world *w) {
  int64_t us = moment(s, f->capture_s, now_us);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      vs_ssl_object *o = &s->robot[t][i];
      vs_robot *r = &w->robot[t][i];
      if (f->seen[t][i]) follow_robot(o, &f->robot[t][i], us);
      r->valid = held(o, us);
      if (!r->valid) continue;
      r->pose = (vs_pose){o->x.value, o->y.value, o->theta.value};
      r->vx_mps = o->x.rate, r->vy_mps = o->y.rate, r->omega_radps = o->theta.rate;
    }
  if (f->ball_seen) follow_ball(&s->ball, f->ball_x_m, f->ball_y_m, us);
  w->ball.valid = held(&s->ball, us);
  if (w->ball.valid)
    w->ball = (vs_ball){s->ball.x.value, s->ball.y.value, VS_BALL_RADIUS_M, s->ball.x.rate, s->ball.y.rate, 0, true};
}
