// A plugin as interface 1 had it (vsss before 5 against 5), its structs written out: three robots a team, the ball after them.
#include <stddef.h>
#include <stdint.h>

typedef struct robot {
  double x_m, y_m, theta_rad, vx_mps, vy_mps, omega_radps, left_radps, right_radps;
  _Bool valid;
} robot;

typedef struct world {
  int64_t time_us;
  uint32_t seq;
  robot robots[2][3];
  double ball_x_m, ball_y_m, ball_z_m, ball_vx_mps, ball_vy_mps, ball_vz_mps;
  _Bool ball_valid;
} world;

typedef struct wheels {
  double left_radps, right_radps;
} wheels;

typedef struct player {
  uint32_t version;
  const char *name;
  double rate_hz;
  size_t state_size;
  int (*init)(void *state, uint64_t seed, const char *options, void *err);
  void (*step)(void *state, const world *w, const void *game, double dt_s, wheels out[3]);
  void (*free)(void *state);
} player;

static int init(void *state, uint64_t seed, const char *options, void *err) {
  (void)state, (void)seed, (void)options, (void)err;
  return 0;
}

static void step(void *state, const world *w, const void *game, double dt_s, wheels out[3]) {
  (void)state, (void)game, (void)dt_s;
  out[0].left_radps = 100 * w->ball_x_m;
  out[2].right_radps = 10 * w->robots[1][2].y_m;
}

const player *vsss_player(void) {
  static const player api = {1, "first", 10, 1, init, step, NULL};
  return &api;
}
