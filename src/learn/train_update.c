// The training loop: collect, value targets and advantages, update, report.
#include <math.h>

#include "reward_mix.h"
#include "train_internal.h"
#include "vsss/clock.h"

static double seconds(void) { return 1e-6 * (double)vs_clock_monotonic_us(); }

vs_status vs_train_collect(vs_train *t, const vs_reward_weights *weights, double *simulate_s, double *infer_s,
                           vs_error *err) {
  const float *parameters = t->learner.parameters;
  vs_rollout_begin(&t->rollout);
  for (int step = 0; step < t->def.steps; step++) {
    double start = seconds();
    vs_rollout_act(&t->rollout, step, parameters);
    double acted = seconds();
    vs_status s = t->matches.step(t->matches.self, &t->rollout.io, err);
    if (s != VS_OK) return s;
    double stepped = seconds();
    vs_rollout_record(&t->rollout, step, parameters, weights);
    *simulate_s += stepped - acted;
    *infer_s += acted - start + seconds() - stepped;
  }
  return VS_OK;
}

vs_status vs_train_targets(vs_train *t, vs_ppo_batch *out, vs_error *err) {
  vs_rollout *r = &t->rollout;
  vs_rollout_bootstrap(r, t->learner.parameters);
  vs_rollout_advantages(r);
  *out = vs_rollout_batch(r);
  const vs_value_batch values = {out->rows, r->target, r->old_value, r->value};
  return vs_value_scale_follow(&t->scale, t->group, &values, &t->learner.net, t->learner.parameters, err);
}

vs_status vs_train_sum_up(const vs_train *t, vs_rollout_stats *played, vs_ppo_stats *ppo, vs_error *err) {
  if (!t->group) return VS_OK;
  vs_status s = t->group->sum_doubles(t->group->self, (double *)played, sizeof *played / sizeof(double), err);
  if (s == VS_OK) s = t->group->sum_doubles(t->group->self, (double *)ppo, sizeof *ppo / sizeof(double), err);
  return s;
}

// Lately, against a kind of opponent; NaN where the mix has none or no episode ended.
static double recent_score(const vs_league *league, vs_opponent_kind kind) {
  for (int k = 0; k < league->def.shares; k++)
    if (league->def.share[k].kind == kind && league->record[k].episodes > 0) return league->record[k].recent_score;
  return NAN;
}

static void make_report(const vs_train *t, const vs_reward_weights *weights, const vs_learner_stats *learnt,
                        vs_train_report *report) {
  const vs_rollout_stats *played = &t->rollout.stats;
  const vs_ppo_stats *ppo = &learnt->last;
  double episodes = played->episodes > 0.0 ? played->episodes : NAN; // none ended: nothing was measured
  report->update = (double)t->updates;
  report->transitions = (double)t->transitions;
  report->wall_s = t->wall_s;
  report->reward = played->reward / played->transitions;
  for (int k = 0; k < VS_REWARD_TERMS; k++) {
    report->term[k] = played->terms[k] / played->transitions;
    report->weight[k] = weights->weight[k];
  }
  report->entropy = ppo->entropy / ppo->rows;
  report->kl = ppo->kl / ppo->rows;
  report->clip_fraction = ppo->clipped / ppo->rows;
  report->policy_loss = ppo->policy_loss / ppo->rows;
  report->value_loss = ppo->value_loss / ppo->rows;
  report->explained_variance = learnt->explained_variance;
  report->gradient_norm = learnt->gradient_norm;
  report->learning_rate = t->learner.def.learning_rate;
  report->episodes = played->episodes;
  report->episode_s = played->episode_s / episodes;
  report->goals_for = played->goals_for / episodes;
  report->goals_against = played->goals_against / episodes;
  const vs_league_window window = vs_league_results(&t->league);
  report->frozen_score = window.count > 0.0 && t->league.frozen >= 0 ? vs_league_window_score(&window) : NAN;
  report->self_score = recent_score(&t->league, VS_OPPONENT_SELF);
  report->pool_score = recent_score(&t->league, VS_OPPONENT_POOL);
  report->replacements = t->league.replacements;
  report->pool = 0;
  for (int i = 0; i < t->league.selves; i++) report->pool += t->league.self[i].in_pool;
}

// Counters and the league after an update.
static vs_status advance(vs_train *t, int rows, vs_error *err) {
  t->updates++;
  t->transitions += (long long)rows * vs_group_size(t->group);
  vs_net_extract_actor(&t->learner.net, t->learner.parameters, &t->rollout.actor, t->actor);
  vs_actor_mean_follow(t, t->actor, (long long)rows * vs_group_size(t->group));
  vs_league_window results = vs_league_results(&t->league);
  vs_status s = VS_OK;
  if (t->group) s = t->group->sum_doubles(t->group->self, (double *)&results, sizeof results / sizeof(double), err);
  return s == VS_OK ? vs_league_after_update(&t->league, t->updates, t->actor, &results, NULL, err) : s;
}

static vs_status start_matches(vs_train *t, vs_error *err) {
  if (t->started) return VS_OK;
  t->started = true;
  return t->matches.reset(t->matches.self, &t->rollout.io, err);
}

vs_status vs_train_update(vs_train *train, vs_train_report *report, vs_error *err) {
  double start = seconds();
  *report = (vs_train_report){0};
  vs_ppo_batch batch = {0};
  vs_learner_stats learnt = {0};
  const vs_reward_weights weights = vs_reward_mix_at(&train->reward_start, &train->reward_end, train->def.anneal_from_m,
                                                     train->def.anneal_to_m, (double)train->transitions * 1e-6);
  train->learner.def.learning_rate = vs_train_learning_rate(&train->def, (double)train->transitions);
  uint64_t seed = vs_seed_mix(train->def.seed, (uint64_t)train->updates);

  if (train->matches.learnt) train->matches.learnt(train->matches.self, (double)train->transitions * 1e-6);

  // Collect: `steps` decisions of every match by the present policy.
  vs_status s = start_matches(train, err);
  if (s == VS_OK) s = vs_train_collect(train, &weights, &report->simulate_s, &report->infer_s, err);
  double collected = seconds();
  // Value targets and advantages.
  if (s == VS_OK) s = vs_train_targets(train, &batch, err);
  // Update: epochs of minibatches, then the league looks at the result.
  if (s == VS_OK) s = vs_learner_update(&train->learner, &batch, seed, &learnt, err);
  if (s == VS_OK) s = vs_train_sum_up(train, &train->rollout.stats, &learnt.last, err);
  if (s == VS_OK) s = advance(train, batch.rows, err);
  if (s != VS_OK) return s;
  // Report.
  double end = seconds();
  report->learn_s = end - collected;
  report->transitions_per_s = batch.rows * vs_group_size(train->group) / (end - start);
  train->wall_s += end - start;
  make_report(train, &weights, &learnt, report);
  return VS_OK;
}
