// Sixteen matches at once against the EMC strategy, played by robots that drive at random: the loop any trainer begins with.
#include <stdio.h>

#include "vsss/vecenv.h"

enum { ENVS = 16, ROWS = 3 * ENVS, STEPS = 1500 }; // decisions at 10 Hz: a match of two minutes each

static float observation[ROWS][VS_OBS_SIZE], action[ROWS][VS_ACTION_SIZE], episode_s[ENVS];
static double terms[ROWS][VS_REWARD_TERMS];
static uint8_t done[ENVS], time_limit[ENVS];
static int32_t score[ENVS][VS_TEAMS];

static int failed(const vs_error *err) { return fprintf(stderr, "loop: %s\n", err->text), 1; }

int main(void) {
  vs_error err = {0};
  vs_model *model = NULL;
  vs_vecenv *vec = NULL;
  vs_model_def physics = vs_model_def_default(VS_DRIVE_PLANAR);
  if (vs_model_load(&physics, &model, &err)) return failed(&err);
  vs_vecenv_def def = {vs_env_def_default(model), ENVS, 2, 1 /* seed */, VS_ROWS_BLUE, false};
  def.env.player[VS_YELLOW] = "emc:"; // blue stays NULL: its actions come from here
  vs_vecenv_buffers buffers = {observation[0], action[0], terms[0], done, time_limit, NULL, score[0], episode_s, NULL};
  if (vs_vecenv_new(&def, &vec, &err) || vs_vecenv_reset(vec, &buffers, &err)) return failed(&err);

  vs_rng rng = vs_rng_make(1, 0);
  int matches = 0, goals[VS_TEAMS] = {0, 0};
  for (int step = 0; step < STEPS; step++) {
    for (int i = 0; i < ROWS * VS_ACTION_SIZE; i++)
      action[i / VS_ACTION_SIZE][i % VS_ACTION_SIZE] = (float)vs_rng_range(&rng, -1.0, 1.0);
    if (vs_vecenv_step(vec, &buffers, &err)) return failed(&err);
    for (int e = 0; e < ENVS; e++)
      if (done[e]) matches++, goals[0] += score[e][0], goals[1] += score[e][1];
  }
  printf("%d matches, random %d : %d emc\n", matches, goals[0], goals[1]);
  vs_vecenv_free(vec);
  vs_model_free(model);
  return 0;
}
