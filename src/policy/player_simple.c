// random: and zero:, the two players without a thought.
#include <string.h>

#include "policy_internal.h"
#include "vsss/field.h"
#include "vsss/rng.h"

static const vs_config_key no_options[] = {{0}};

static vs_status random_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  *(vs_rng *)state = vs_rng_make(seed, 0);
  return vs_player_options("random:", options, no_options, err);
}

static void random_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)world, (void)game, (void)dt_s;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
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
};

static vs_status zero_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)state, (void)seed;
  return vs_player_options("zero:", options, no_options, err);
}

static void zero_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)state, (void)world, (void)game, (void)dt_s;
  memset(out, 0, VS_TEAM_SIZE * sizeof *out);
}

const vsss_player_api vs_player_zero = {
    .version = VSSS_PLAYER_VERSION,
    .name = "zero",
    .rate_hz = VS_DECISION_HZ,
    .state_size = 1,
    .init = zero_init,
    .step = zero_step,
};
