// Times onnx: one decision of a team (three rows) of the 464-256-256-4 network, asked once, and as the policy that
// comes with vsss does it: about all 24 symmetric versions.
#include <stdio.h>
#include <stdlib.h>

#include "vsss/clock.h"
#include "vsss/policy.h"
#include "vsss/rng.h"

enum { RUNS = 7, CALLS = 5000 };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int time_player(const char *uri, const char *name, int calls) {
  vs_error err = {0};
  vs_player *player = NULL;
  if (vs_player_open(uri, &player, &err) != VS_OK) {
    fprintf(stderr, "bench_onnx: %s\n", err.text);
    return 1;
  }
  static float obs[VS_TEAM_SIZE][VS_OBS_SIZE], action[VS_TEAM_SIZE][VS_ACTION_SIZE];
  vs_rng rng = vs_rng_make(1, 0);
  for (int r = 0; r < VS_TEAM_SIZE; r++)
    for (int i = 0; i < VS_OBS_SIZE; i++) obs[r][i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  double us[RUNS];
  for (int run = 0; run < RUNS; run++) {
    int64_t start = vs_clock_monotonic_us();
    for (int i = 0; i < calls; i++)
      if (vs_player_act(player, obs[0], VS_TEAM_SIZE, action[0], &err) != VS_OK) return 1;
    us[run] = (double)(vs_clock_monotonic_us() - start) / calls;
  }
  qsort(us, RUNS, sizeof *us, by_value);
  printf("bench %s %.2f us\n", name, us[RUNS / 2]);
  vs_player_close(player);
  return 0;
}

int main(void) {
  int failed = time_player("onnx:build/untrained.onnx", "onnx_batch3", CALLS);
  return failed ? failed : time_player("onnx:", "onnx_batch3_shipped", CALLS / 10);
}
