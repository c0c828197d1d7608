// random:, zero: and shake:, the players without a thought.
#include <string.h>

#include "policy_internal.h"
#include "vsss/field.h"
#include "vsss/rng.h"

static const vs_config_key no_options[] = {{0}};

static vs_status random_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  *(vs_rng *)state = vs_rng_make(seed, 0);
  return vs_player_options("random:", options, no_options, err);
}

#define ALL_DIVISIONS (VSSS_PLAYS(VS_3V3) | VSSS_PLAYS(VS_5V5))

static void random_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)game, (void)dt_s;
  for (int i = 0, n = vs_team_size(world); i < n; i++) {
    out[i].left_radps = vs_rng_range(state, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
    out[i].right_radps = vs_rng_range(state, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
  }
}

// Each wheel's speed anew at each decision, uniform (paper, section VII: the "random" opponent of Table 3).
const vsss_player_api vs_player_random = {
    .version = VSSS_PLAYER_VERSION,
    .name = "random",
    .rate_hz = VS_DECISION_HZ,
    .state_size = sizeof(vs_rng),
    .init = random_init,
    .step = random_step,
    .divisions = ALL_DIVISIONS,
};

static vs_status zero_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)state, (void)seed;
  return vs_player_options("zero:", options, no_options, err);
}

static void zero_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)state, (void)game, (void)dt_s;
  memset(out, 0, (size_t)vs_team_size(world) * sizeof *out);
}

const vsss_player_api vs_player_zero = {
    .version = VSSS_PLAYER_VERSION,
    .name = "zero",
    .rate_hz = VS_DECISION_HZ,
    .state_size = 1,
    .init = zero_init,
    .step = zero_step,
    .divisions = ALL_DIVISIONS,
};

// Each robot swings: forth and back, left and right, one wheel and the other, each movement and then its reverse, so that it
// stays about where it is, with a rest after each. A reversal at once would ask for twice the step: the simulator's motors
// are at their torque's limit, and its wheels close to slipping, from 7.7 rad/s on, and identify wants to see neither.
#define SHAKE_MIN_RADPS 3.0
#define SHAKE_MAX_RADPS 7.0
#define SHAKE_MIN_S     0.25
#define SHAKE_MAX_S     0.7
#define SHAKE_REST_S    0.25

typedef enum shake_part { SHAKE_FORTH, SHAKE_REST, SHAKE_BACK, SHAKE_REST_AGAIN, SHAKE_PARTS } shake_part;
typedef struct shake_robot {
  double left_s, length_s; // of this part, and of its movement; length 0: not begun
  vs_wheels wheels;        // of the movement forth
  shake_part part;
} shake_robot;
typedef struct shake_state {
  vs_rng rng;
  shake_robot robot[VS_TEAM_SIZE];
} shake_state;

static vs_status shake_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  *(shake_state *)state = (shake_state){.rng = vs_rng_make(seed, 0)};
  return vs_player_options("shake:", options, no_options, err);
}

static void shake_next(shake_state *s, shake_robot *r) {
  static const vs_wheels way[] = {{1, 1}, {1, -1}, {1, 0}, {0, 1}};
  r->part = r->length_s > 0 ? (shake_part)((r->part + 1) % SHAKE_PARTS) : SHAKE_FORTH;
  if (r->part == SHAKE_FORTH) {
    const vs_wheels *w = &way[vs_rng_below(&s->rng, 4)];
    double speed = vs_rng_range(&s->rng, SHAKE_MIN_RADPS, SHAKE_MAX_RADPS);
    if (vs_rng_below(&s->rng, 2)) speed = -speed;
    r->wheels = (vs_wheels){speed * w->left_radps, speed * w->right_radps};
    r->length_s = vs_rng_range(&s->rng, SHAKE_MIN_S, SHAKE_MAX_S);
  }
  bool rests = r->part == SHAKE_REST || r->part == SHAKE_REST_AGAIN;
  r->left_s = rests ? SHAKE_REST_S : r->length_s;
}

static void shake_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)world, (void)game;
  shake_state *s = state;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    shake_robot *r = &s->robot[i];
    r->left_s -= dt_s;
    if (r->left_s <= 0) shake_next(s, r);
    double share = r->part == SHAKE_FORTH ? 1 : r->part == SHAKE_BACK ? -1 : 0;
    out[i] = (vs_wheels){share * r->wheels.left_radps, share * r->wheels.right_radps};
  }
}

const vsss_player_api vs_player_shake = {
    .version = VSSS_PLAYER_VERSION,
    .name = "shake",
    .rate_hz = VS_CAMERA_HZ,
    .state_size = sizeof(shake_state),
    .init = shake_init,
    .step = shake_step,
};
