// A tiny trainer: three robots learn to push the ball into an empty half, by random search over a linear policy (the
// method of augmented random search, without its normalisation). Each of the 32 matches plays with the present weights
// plus or minus a random direction; the weights then move along the directions, each weighed by what it gained. Under a
// minute on two cores. `vsss train` gives the same robots a network, PPO and opponents that play back.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/vecenv.h"

enum { DIRECTIONS = 16, ENVS = 2 * DIRECTIONS, ROWS = VS_TEAM_SIZE * ENVS };
enum { INPUTS = VS_OBS_FRAME + 1, WEIGHTS = VS_ACTION_SIZE * INPUTS, DECISIONS = 60 };
#define NOISE 0.05
#define STEP  0.02

typedef struct trainer {
  vs_vecenv *vec;
  vs_vecenv_buffers buffers;
  double weight[WEIGHTS], tried[ENVS][WEIGHTS], gain[ENVS];
  float observation[ROWS][VS_OBS_SIZE], action[ROWS][VS_ACTION_SIZE], episode_s[ENVS];
  double terms[ROWS][VS_REWARD_TERMS];
  uint8_t done[ENVS], time_limit[ENVS];
  int32_t score[ENVS][VS_TEAMS];
} trainer;

// Wheels of one robot from the newest frame of what it sees (the last of the stack) and a constant.
static void act(const double *weight, const float *observation, float *action) {
  const float *frame = observation + VS_OBS_SIZE - VS_OBS_FRAME;
  for (int wheel = 0; wheel < VS_ACTION_SIZE; wheel++, weight += INPUTS) {
    double sum = weight[VS_OBS_FRAME];
    for (int i = 0; i < VS_OBS_FRAME; i++) sum += weight[i] * frame[i];
    action[wheel] = (float)tanh(sum);
  }
}

// Six seconds of every match with the weights it tries; gain is its mean reward per decision. The two matches of a pair
// begin alike, so that only their weights differ.
static vs_status play(trainer *t, uint64_t seed, vs_error *err) {
  const vs_reward_weights reward = {.weight = {[VS_REWARD_PROGRESS] = 1.0, [VS_REWARD_APPROACH] = 0.3}};
  memset(t->gain, 0, sizeof t->gain);
  for (int e = 0; e < ENVS; e++) {
    vs_status s = vs_vecenv_seed_match(t->vec, e, vs_seed_mix(seed, (uint64_t)e / 2), err);
    if (s != VS_OK) return s;
  }
  vs_status s = vs_vecenv_start(t->vec, NULL, &t->buffers, err);
  for (int step = 0; step < DECISIONS && s == VS_OK; step++) {
    for (int row = 0; row < ROWS; row++) act(t->tried[row / VS_TEAM_SIZE], t->observation[row], t->action[row]);
    s = vs_vecenv_step(t->vec, &t->buffers, err);
    for (int e = 0; e < ENVS && s == VS_OK; e++) {
      float each[VS_TEAM_SIZE];
      vs_reward_sum((const double(*)[VS_REWARD_TERMS])t->terms[VS_TEAM_SIZE * e], &reward, each);
      for (int i = 0; i < VS_TEAM_SIZE; i++) t->gain[e] += each[i] / (VS_TEAM_SIZE * DECISIONS);
    }
  }
  return s;
}

// One step of the search; returns the mean reward of what was tried.
static vs_status improve(trainer *t, uint64_t update, double *mean, vs_error *err) {
  vs_rng rng = vs_rng_make(7, update);
  double direction[DIRECTIONS][WEIGHTS];
  for (int d = 0; d < DIRECTIONS; d++)
    for (int i = 0; i < WEIGHTS; i++) {
      direction[d][i] = vs_rng_normal(&rng);
      t->tried[2 * d][i] = t->weight[i] + NOISE * direction[d][i];
      t->tried[2 * d + 1][i] = t->weight[i] - NOISE * direction[d][i];
    }
  vs_status s = play(t, update, err);
  if (s != VS_OK) return s;
  double square = 0.0;
  *mean = 0.0;
  for (int e = 0; e < ENVS; e++) *mean += t->gain[e] / ENVS;
  for (int e = 0; e < ENVS; e++) square += (t->gain[e] - *mean) * (t->gain[e] - *mean) / ENVS;
  for (int d = 0; d < DIRECTIONS; d++)
    for (int i = 0; i < WEIGHTS; i++)
      t->weight[i] +=
          STEP / DIRECTIONS * (t->gain[2 * d] - t->gain[2 * d + 1]) / (sqrt(square) + 1e-9) * direction[d][i];
  return VS_OK;
}

static vs_status train(trainer *t, const vs_model *model, int updates, vs_error *err) {
  vs_vecenv_def def = {.env = vs_env_def_default(model), .envs = ENVS, .threads = 2, .teams = VS_ROWS_BLUE};
  def.env.player[VS_YELLOW] = "zero:";
  def.env.referee = vs_referee_def_training();
  def.env.referee.end_at_first_goal = false;
  t->buffers = (vs_vecenv_buffers){.observation = t->observation[0],
                                   .action = t->action[0],
                                   .reward_terms = t->terms[0],
                                   .done = t->done,
                                   .time_limit = t->time_limit,
                                   .score = t->score[0],
                                   .episode_s = t->episode_s};
  vs_status s = vs_vecenv_new(&def, &t->vec, err);
  if (s == VS_OK) s = vs_vecenv_reset(t->vec, &t->buffers, err);
  double mean = 0.0, sum = 0.0, first = 0.0, last = 0.0;
  const int window = updates < 40 ? (updates + 1) / 2 : 20;
  for (int update = 0; update < updates && s == VS_OK; update++) {
    s = improve(t, (uint64_t)update, &mean, err);
    sum += mean;
    if (update < window) first += mean / window;
    if (update >= updates - window) last += mean / window;
    if (update % 20 == 19) printf("update %4d  reward %+.4f\n", update + 1, sum / 20), sum = 0.0, fflush(stdout);
  }
  if (s == VS_OK) printf("reward per decision: first %d updates %+.4f, last %d %+.4f\n", window, first, window, last);
  vs_vecenv_free(t->vec);
  return s;
}

int main(int argc, char **argv) {
  vs_error err = {0};
  vs_model *model = NULL;
  trainer *t = calloc(1, sizeof *t);
  vs_model_def physics = vs_model_def_default(VS_DRIVE_PLANAR);
  vs_status s = t ? vs_model_load(&physics, &model, &err) : vs_fail(&err, VS_FAIL, "out of memory");
  if (s == VS_OK) s = train(t, model, argc > 1 ? atoi(argv[1]) : 200, &err);
  if (s != VS_OK) fprintf(stderr, "train: %s\n", err.text);
  vs_model_free(model);
  free(t);
  return (int)s;
}
