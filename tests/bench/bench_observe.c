// Times what one decision costs beside physics and policy: the observation of all six robots (two team views, two frames,
// two stacks of 464 floats per robot written), the referee, the rewards, a random placement.
#include <stdio.h>
#include <stdlib.h>

#include "vsss/clock.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/observe.h"
#include "vsss/referee.h"
#include "vsss/reward.h"

// Short runs, so that most of them are not interrupted on a busy machine.
enum { RUNS = 1001, CALLS = 200, WORLDS = 64 };

static vs_world world[WORLDS];
static vs_referee referee;
static vs_observer observer[VS_TEAMS];
static float stack[VS_TEAMS][VS_TEAM_SIZE * VS_OBS_SIZE];
static float sink;

static void observe(int n) {
  static const float action[VS_TEAM_SIZE * VS_ACTION_SIZE] = {0.1f, -0.2f, 0.3f, -0.4f, 0.5f, -0.6f};
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_world view;
    vs_game game;
    vs_world_for_team(&world[n % WORLDS], (vs_team)t, &view);
    vs_game_for_team(&referee.game, (vs_team)t, &game);
    vs_observer_push(&observer[t], &view, &game, action);
    vs_observer_write(&observer[t], stack[t]);
    sink += stack[t][n % VS_OBS_SIZE];
  }
}

static void judge(int n) { sink += (float)vs_referee_step(&referee, &world[n % WORLDS], 1e-6).kind; }

static void reward(int n) {
  static const vs_event none = {.kind = VS_EVENT_NONE};
  const vs_reward_weights weights = vs_reward_paper();
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_world previous, view;
    double terms[VS_TEAM_SIZE][VS_REWARD_TERMS];
    float sum[VS_TEAM_SIZE];
    vs_world_for_team(&world[n % WORLDS], (vs_team)t, &previous);
    vs_world_for_team(&world[(n + 1) % WORLDS], (vs_team)t, &view);
    vs_reward_terms(&previous, &view, &none, &referee.game, terms);
    vs_reward_sum((const double(*)[VS_REWARD_TERMS])terms, &weights, sum);
    sink += sum[0];
  }
}

static void place(int n) {
  static vs_rng rng;
  const vs_event event = {.kind = n % 2 ? VS_EVENT_KICK_OFF : VS_EVENT_PENALTY, .team = (vs_team)(n / 2 % 2)};
  vs_world out;
  vs_place(VS_PLACEMENT_RANDOM, &event, &world[0], &rng, &out);
  sink += (float)out.ball.x_m;
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void time_it(const char *name, void (*what)(int)) {
  static double us[RUNS];
  for (int run = 0; run < RUNS; run++) {
    int64_t start = vs_clock_monotonic_us();
    for (int n = 0; n < CALLS; n++) what(n);
    us[run] = (double)(vs_clock_monotonic_us() - start) / CALLS;
  }
  qsort(us, RUNS, sizeof *us, by_value);
  printf("bench %s %.3f us\n", name, us[RUNS / 2]);
}

int main(void) {
  vs_rng rng = vs_rng_make(1, 0);
  for (int n = 0; n < WORLDS; n++) { // midfield, so that the referee has nothing to say
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++)
        world[n].robot[t][i].pose = (vs_pose){vs_rng_range(&rng, -0.55, 0.55), vs_rng_range(&rng, -0.6, 0.6),
                                              vs_rng_range(&rng, -VS_PI, VS_PI)};
    world[n].ball.x_m = vs_rng_range(&rng, -0.55, 0.55);
    world[n].ball.y_m = vs_rng_range(&rng, -0.6, 0.6);
  }
  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  if (vs_referee_init(&referee, &def, NULL) != VS_OK) return 1;
  for (int t = 0; t < VS_TEAMS; t++) vs_observer_init(&observer[t], NULL);
  time_it("observe_6_agents", observe);
  time_it("referee_frame", judge);
  time_it("reward_6_agents", reward);
  time_it("random_placement", place);
  return sink == 12345.0f;
}
