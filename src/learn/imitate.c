// Imitation: learn what a scripted player does before playing oneself (the paper's future work).
#include <math.h>
#include <string.h>

#include "reward_mix.h"
#include "train_internal.h"
#include "train_matches.h"

// One batch of the scripts' play, learnt from by maximum likelihood.
static vs_status update(vs_train *t, uint64_t seed, double *loss, vs_error *err) {
  double unused_s = 0.0;
  vs_learner_stats learnt = {0};
  vs_status s = vs_train_collect(t, &t->reward_start, &unused_s, &unused_s, err);
  if (s != VS_OK) return s;
  vs_ppo_batch batch;
  s = vs_train_targets(t, &batch, err);
  if (s == VS_OK) s = vs_learner_update(&t->learner, &batch, seed, &learnt, err);
  if (s == VS_OK) s = vs_train_sum_up(t, &t->rollout.stats, &learnt.last, err);
  *loss = learnt.last.policy_loss / learnt.last.rows;
  return s;
}

void vs_train_hand_over(vs_train *t) {
  vs_net_extract_actor(&t->learner.net, t->learner.parameters, &t->rollout.actor, t->actor);
  vs_actor_mean_restart(t);
  for (int i = 0; i < t->league.selves; i++)
    if (t->league.self[i].parameters) memcpy(t->league.self[i].parameters, t->actor, t->league.size * sizeof *t->actor);
}

vs_status vs_train_imitate_over(vs_train *train, const vs_matches *matches, int updates,
                                bool (*progress)(void *context, double part, double loss), void *context,
                                vs_error *err) {
  // The run's own matches and rows wait; all six rows of each match are watched.
  vs_matches own_matches = train->matches;
  vs_rollout own_rollout = train->rollout;
  vs_ppo_def own_ppo = train->learner.def.ppo;
  vs_league_def watched = {.pool_size = 1, .pool_every = 1};
  vs_league league = {0};
  vs_status s = vs_league_parse("self", &watched, err);
  if (s == VS_OK)
    s = vs_league_init(&league, &watched, train->def.envs, train->league.size, train->actor, own_rollout.def.seed, err);
  train->matches = *matches;
  train->rollout = (vs_rollout){0};
  if (s == VS_OK) s = vs_rollout_init(&train->rollout, &own_rollout.def, &train->learner, &train->scale, &league, err);
  train->rollout.watch = true;
  train->learner.def.ppo.imitate = true;
  train->learner.def.ppo.clip_value = false;
  if (s == VS_OK) s = train->matches.reset(train->matches.self, &train->rollout.io, err);
  bool go_on = true;
  for (int i = 0; s == VS_OK && go_on && i < updates; i++) {
    double loss = 0.0;
    s = update(train, vs_seed_mix(train->def.seed, 5000 + (uint64_t)i), &loss, err);
    if (s == VS_OK && progress) go_on = progress(context, (i + 1.0) / updates, loss);
  }
  vs_rollout_free(&train->rollout);
  vs_league_free(&league);
  train->matches.free(train->matches.self);
  train->matches = own_matches;
  train->rollout = own_rollout;
  train->learner.def.ppo = own_ppo;
  // Adam's memory is of another loss.
  memset(train->learner.m, 0, train->learner.net.size * sizeof(float));
  memset(train->learner.v, 0, train->learner.net.size * sizeof(float));
  train->learner.steps = 0;
  if (s == VS_OK) vs_train_hand_over(train);
  return s;
}

vs_status vs_train_imitate(vs_train *train, const char *uri, int updates,
                           bool (*progress)(void *context, double part, double loss), void *context, vs_error *err) {
  if (train->updates > 0)
    return vs_fail(err, VS_USAGE, "imitation is for the start of a run: this one has %lld updates", train->updates);
  vs_matches matches;
  vs_status s = vs_train_matches_open(&train->def, &train->league, vs_group_rank(train->group), uri, &matches, err);
  return s == VS_OK ? vs_train_imitate_over(train, &matches, updates, progress, context, err) : s;
}
