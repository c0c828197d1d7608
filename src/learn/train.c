// A training run: made, freed, asked about, exported. Its loop is train_update.c.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "export.h"
#include "precision.h"
#include "reward_mix.h"
#include "torch_engine.h"
#include "train_internal.h"
#include "train_matches.h"

static vs_policy_io training_io(const vs_train_def *def) {
  return (vs_policy_io){.reversible = def->reversible,
                        .canonical = def->canonical,
                        .augment = def->augment,
                        .action_gain = def->action_gain};
}

static vs_policy_io export_io(const vs_train_def *def) {
  double gain = def->export_gain > 0.0 ? def->export_gain : def->action_gain;
  return (vs_policy_io){
      .reversible = def->reversible, .canonical = def->canonical, .average = def->export_average, .action_gain = gain};
}

static vs_learner_def learner_def(const vs_train_def *def, const vs_net_shape *shape) {
  return (vs_learner_def){.shape = *shape,
                          .ppo = {.clip = def->clip,
                                  .clip_value = def->clip_value,
                                  .entropy = def->entropy,
                                  .value_weight = def->value_weight},
                          .learning_rate = def->learning_rate,
                          .adam_beta1 = 0.9,
                          .adam_beta2 = 0.999,
                          .adam_epsilon = def->adam_epsilon,
                          .max_gradient_norm = def->max_gradient_norm,
                          .initial_concentration = def->initial_concentration,
                          .epochs = def->epochs,
                          .minibatch = def->minibatch,
                          .microbatches = def->microbatches};
}

// precision = auto becomes the faster one, and the run's setting: a run that is resumed computes as it began. Ranks that
// average their gradients compute them alike.
static vs_status choose_precision(vs_train *t, vs_learner_def *def, vs_error *err) {
  vs_status s = vs_train_precision(&t->def, &def->precision, err);
  if (s != VS_OK || def->precision != VS_PRECISION_AUTO) return s;
  vs_precision_times times;
  s = vs_precision_time(def, t->pool, &times, err);
  double sums[2] = {times.fp32_s, times.bf16_s};
  if (s == VS_OK && t->group) s = t->group->sum_doubles(t->group->self, sums, 2, err);
  bool bf16 = sums[1] < sums[0];
  def->precision = bf16 ? VS_PRECISION_BF16 : VS_PRECISION_FP32;
  snprintf(t->def.precision, sizeof t->def.precision, "%s", bf16 ? "bf16" : "fp32");
  if (s == VS_OK && isfinite(sums[1]))
    snprintf(t->products_times, sizeof t->products_times, " (a minibatch: bf16 %.1f ms, fp32 %.1f ms)",
             1e3 * times.bf16_s, 1e3 * times.fp32_s);
  return s;
}

static void name_products(vs_train *t) {
  const vs_learner *l = &t->learner;
  bool onednn = l->blas.dnnl_sgemm != NULL;
  const char *name = l->engine ? "libtorch"
                     : l->bf16 ? "gradients in bf16 by oneDNN"
                     : onednn  ? "gradients in fp32 by oneDNN"
                               : "gradients in fp32 by OpenBLAS";
  snprintf(t->products, sizeof t->products, "%s%s", name, t->products_times);
}

static vs_status make_learner(vs_train *t, vs_error *err) {
  vs_net_shape shape = {.inputs = VS_OBS_SIZE, .actions = VS_ACTION_SIZE, .critic = true};
  vs_status s = vs_train_hidden(&t->def, &shape, err);
  if (s != VS_OK) return s;
  vs_learner_def def = learner_def(&t->def, &shape);
  s = vs_pool_new(t->def.threads, &t->pool, err);
  if (!strcmp(t->def.learner, "torch")) {
    def.precision = VS_PRECISION_FP32;
    def.block = def.minibatch; // it gains nothing from small ones
  } else if (s == VS_OK) {
    s = choose_precision(t, &def, err);
  }
  if (s == VS_OK) s = vs_learner_init(&t->learner, &def, t->pool, t->def.seed, err);
  if (s != VS_OK) return s;
  t->learner.group = t->group;
  if (strcmp(t->def.learner, "torch") == 0) {
    s = vs_torch_engine_open(&t->engine, err);
    t->learner.engine = &t->engine;
  }
  name_products(t);
  return s;
}

static vs_status make_league_and_rollout(vs_train *t, vs_error *err) {
  vs_league_def league = {.replace_score = t->def.replace_score,
                          .score_window_zero_filled = t->def.score_window_zero_filled,
                          .pool_size = t->def.pool_size,
                          .pool_every = t->def.pool_every};
  vs_net actor;
  vs_net_shape shape = t->learner.net.shape;
  shape.critic = false;
  vs_status s = vs_league_parse(t->def.opponent, &league, err);
  if (s == VS_OK) s = vs_net_init(&actor, &shape, err);
  if (s != VS_OK) return s;
  t->actor = malloc(actor.size * sizeof *t->actor);
  if (!t->actor) return vs_fail(err, VS_FAIL, "out of memory");
  vs_net_extract_actor(&t->learner.net, t->learner.parameters, &actor, t->actor);
  // Every rank plays its own matches.
  uint64_t seed = vs_seed_mix(t->def.seed, 1000 + (uint64_t)vs_group_rank(t->group));
  s = vs_league_init(&t->league, &league, t->def.envs, actor.size, t->actor, seed, err);
  const vs_rollout_def def = {t->def.envs,
                              t->def.steps,
                              t->def.gamma,
                              t->def.lambda,
                              seed,
                              training_io(&t->def),
                              {t->def.opponent_gain_low, t->def.opponent_gain_high, t->def.opponent_mean}};
  if (s == VS_OK) s = vs_rollout_init(&t->rollout, &def, &t->learner, &t->scale, &t->league, err);
  return s == VS_OK ? vs_actor_mean_open(t, err) : s;
}

vs_status vs_train_new_over(const vs_train_def *def, const vs_matches *matches, const vs_group *group, vs_train **out,
                            vs_error *err) {
  *out = NULL;
  vs_train *t = calloc(1, sizeof *t);
  if (!t) return vs_fail(err, VS_FAIL, "out of memory");
  pthread_mutex_init(&t->kept.lock, NULL);
  t->def = *def;
  if (matches) t->matches = *matches;
  t->group = group;
  t->scale = vs_value_scale_make(def->value_scale);
  vs_status s = vs_train_def_check(def, err);
  if (s == VS_OK) s = vs_reward_mix_parse(def->reward, &t->reward_start, err);
  if (s == VS_OK) s = vs_reward_mix_parse(def->reward_end, &t->reward_end, err);
  if (s == VS_OK) s = make_learner(t, err);
  if (s == VS_OK) s = make_league_and_rollout(t, err);
  if (s == VS_OK && !matches) s = vs_train_matches_open(def, &t->league, vs_group_rank(group), NULL, &t->matches, err);
  if (s != VS_OK) {
    vs_train_free(t);
    return s;
  }
  *out = t;
  return VS_OK;
}

vs_status vs_train_new(const vs_train_def *def, const vs_group *group, vs_train **out, vs_error *err) {
  return vs_train_new_over(def, NULL, group, out, err);
}

void vs_train_free(vs_train *train) {
  if (!train) return;
  vs_rollout_free(&train->rollout);
  vs_league_free(&train->league);
  if (train->engine.free) train->engine.free(train->engine.self);
  vs_learner_free(&train->learner);
  vs_pool_free(train->pool);
  if (train->matches.free) train->matches.free(train->matches.self);
  vs_bytes_free(&train->kept.state);
  pthread_mutex_destroy(&train->kept.lock);
  free(train->actor);
  free(train->actor_mean);
  free(train);
}

bool vs_train_done(const vs_train *train) {
  return train->def.transitions_m > 0.0 && (double)train->transitions >= train->def.transitions_m * 1e6;
}

void vs_train_go_on(vs_train *train, double transitions_m) {
  train->def.transitions_m = transitions_m;
  train->def.learning_rate = train->def.learning_rate_end;
}

double vs_train_updates(const vs_train *train) { return (double)train->updates; }

double vs_train_transitions(const vs_train *train) { return (double)train->transitions; }

double vs_train_wall_s(const vs_train *train) { return train->wall_s; }

const char *vs_train_products(const vs_train *train) { return train->products; }

const vs_train_def *vs_train_settings(const vs_train *train) { return &train->def; }

int vs_train_opponents(const vs_train *train, vs_train_opponent *out, int max) {
  static const char *const names[] = {"self", "frozen", "pool"};
  const vs_league *l = &train->league;
  int count = l->def.shares < max ? l->def.shares : max;
  for (int k = 0; k < count; k++) {
    const vs_league_share *share = &l->def.share[k];
    const vs_league_record *r = &l->record[k];
    out[k] = (vs_train_opponent){share->kind == VS_OPPONENT_SCRIPT ? share->uri : names[share->kind],
                                 r->episodes,
                                 r->wins,
                                 r->draws,
                                 r->losses,
                                 r->recent_score};
  }
  return count;
}

vs_status vs_train_export(const vs_train *train, const char *path, bool with_spread, const char *const *notes,
                          vs_error *err) {
  enum { OWN = 5, MAX = 24 };
  char numbers[3][32];
  snprintf(numbers[0], sizeof numbers[0], "%" PRIu64, train->def.seed);
  snprintf(numbers[1], sizeof numbers[1], "%lld", train->transitions);
  snprintf(numbers[2], sizeof numbers[2], "%.0f", train->wall_s);
  char settings[VS_TRAIN_TEXT_MAX];
  vs_train_def_text(&train->def, false, settings, sizeof settings);
  vs_onnx_note note[MAX] = {{"seed", numbers[0]},
                            {"transitions", numbers[1]},
                            {"wall_s", numbers[2]},
                            {"settings", settings},
                            {"learner", vs_train_products(train)}};
  int count = OWN;
  for (; notes && notes[0] && count < MAX; notes += 2) note[count++] = (vs_onnx_note){notes[0], notes[1]};
  const vs_export_def def = {"vsss", export_io(&train->def), with_spread, note, count};
  if (train->actor_mean) return vs_export_actor(path, &train->rollout.actor, train->actor_mean, &def, err);
  return vs_export_actor(path, &train->learner.net, train->learner.parameters, &def, err);
}
