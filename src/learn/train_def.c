// The settings of a training run: defaults, presets, ranges.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/config_rows.h"
#include "base/word.h"
#include "league.h"
#include "net.h"
#include "reward_mix.h"
#include "train_internal.h"
#include "vsss/learn.h"
#include "vsss/referee.h"
#include "vsss/sim.h"

// What was found to help (deploy/docs/strength.md): 20 million transitions of kick-offs at a high learning rate, then
// start states, a shorter still clock and small steps, without which a run loses to strangers what it wins against itself.
// Half of the opponents are earlier selves that drive slower, faster or less at random than they learnt to, since those
// that play alike stop each other's every penalty. The other levers (realism, canonical observations) are off.
vs_train_def vs_train_def_default(void) {
  return (vs_train_def){
      .drive = "planar",
      .placement = "mixed",
      .predicts = "learned",
      .episode_s = 40.0,
      .still_distance_m = VS_STILL_DISTANCE_M,
      .still_low_s = 2.0,
      .still_high_s = VS_STILL_S,
      .start_open = 0.2,
      .start_penalty = 0.25,
      .start_free_ball = 0.25,
      .start_from_m = 20.0,
      .envs = 96,
      .steps = 32,
      .threads = 2,
      .seed = 1,
      .opponent = "self=0.5,pool=0.5",
      .opponent_gain_high = 1.7, // what policy files drive at
      .opponent_mean = 0.5,
      .replace_score = 0.6,
      .pool_size = 16,
      .pool_every = 20,
      .reward = "dense",
      // Three tenths of the dense reward stay: against goals alone a policy of 25 M transitions lost half its score
      // against INF and EMC in the next 13 M.
      .reward_end = "goals,progress=0.44,approach=0.09,own_distance=0.03,distance=0.015,offence=0.015,defence=0.015",
      .anneal_from_m = 8.0,
      .anneal_to_m = 24.0,
      .gamma = 0.98,
      .lambda = 0.95,
      .clip = 0.2,
      .entropy = 0.003,
      .value_weight = 0.5,
      .value_scale = true,
      .learning_rate = 6e-4,
      .learning_rate_end = 1e-5,
      .learning_rate_decay = "exponential",
      .learning_rate_hold_m = 16.0,
      .adam_epsilon = 1e-5,
      .max_gradient_norm = 0.5,
      .epochs = 3,
      .minibatch = 1024,
      .microbatches = 4,
      .reversible = true,
      .canonical = false,
      .action_gain = 1.4,
      .export_average = true,
      .export_gain = 1.7,
      .export_horizon_m = 5.0,
      .hidden = "256,256",
      .initial_concentration = 4.0,
      .learner = "own",
      .precision = "auto",
      .transitions_m = 60.0,
  };
}

// Every episode a kick-off by the rules' own clock; the network sees and drives as the contract says; the learning rate
// falls in a straight line.
static void without_levers(vs_train_def *def) {
  def->realism[0] = '\0';
  snprintf(def->placement, sizeof def->placement, "random");
  def->still_distance_m = VS_STILL_DISTANCE_M;
  def->still_low_s = def->still_high_s = VS_STILL_S;
  def->start_open = def->start_penalty = def->start_free_ball = def->start_from_m = 0.0;
  snprintf(def->learning_rate_decay, sizeof def->learning_rate_decay, "linear");
  def->learning_rate_hold_m = 0.0;
  def->opponent_gain_low = def->opponent_gain_high = def->opponent_mean = 0.0;
  def->augment = 0;
  def->reversible = false;
  def->canonical = false;
  def->action_gain = 1.0;
  def->export_average = false;
  def->export_gain = 0.0;
  def->export_horizon_m = 0.0;
}

void vs_train_def_before(vs_train_def *def) {
  snprintf(def->precision, sizeof def->precision, "fp32");
  without_levers(def);
}

// Paper, Table 2 and section VII; what the paper leaves open is marked + or * in paper.md: Adam's
// epsilon, value clipping, gradient norm, entropy and value weights, minibatches, layer sizes.
static vs_train_def paper(void) {
  vs_train_def def = vs_train_def_default();
  def.envs = 200;
  def.steps = 214;
  without_levers(&def);
  snprintf(def.opponent, sizeof def.opponent, "frozen");
  def.replace_score = 0.6;
  def.score_window_zero_filled = true;
  snprintf(def.reward, sizeof def.reward, "paper");
  snprintf(def.reward_end, sizeof def.reward_end, "paper");
  def.anneal_from_m = def.anneal_to_m = 0.0;
  def.gamma = 0.99;
  def.entropy = 0.01;
  def.clip_value = true;
  def.value_scale = false;
  def.learning_rate = def.learning_rate_end = 4e-4;
  def.epochs = 5;
  def.minibatch = 4280;
  def.initial_concentration = 1.6931471805599453; // zero bias: 1 + softplus(0)
  def.transitions_m = 160.0;
  return def;
}

vs_status vs_train_def_preset(const char *name, vs_train_def *out, vs_error *err) {
  static const char *const names[] = {"default", "paper", NULL};
  int preset;
  vs_status s = vs_word_parse("preset", name, names, &preset, err);
  if (s == VS_OK) *out = preset ? paper() : vs_train_def_default();
  return s;
}

void vs_train_schema(vs_train_def *d, vs_config_key keys[VS_TRAIN_KEYS_MAX]) {
  const vs_config_key rows[] = {
      TEXT(drive, "planar (fast) or contact (the reference)"),
      TEXT(realism, "INI file of sensors and dynamics, drawn anew each episode"),
      TEXT(predicts, "who sees the world moved on by the delay: learned, none or all"),
      TEXT(placement, "restarts: random (legal poses), paper, or mixed: each one or the other"),
      REAL(episode_s, 1, 600, "an episode ends here, or at the first goal"),
      REAL(still_distance_m, 0.001, 1, "a ball that stays within this distance lies still (a jam, a duel at the wall)"),
      REAL(still_low_s, 0.5, 60, "free ball after so many seconds of a still ball, drawn for each episode"),
      REAL(still_high_s, 0.5, 60, "... up to"),
      REAL(start_open, 0, 1, "share of episodes that begin in open play, ball rolling"),
      REAL(start_penalty, 0, 1, "... with a penalty"),
      REAL(start_free_ball, 0, 1, "... with a free ball; the rest with a kick-off"),
      REAL(start_from_m, 0, 1e6,
           "... from so many millions of transitions on, and still_low_s too; before: kick-offs, still_high_s"),
      WHOLE(envs, 1, 4096, "matches side by side"),
      WHOLE(steps, 1, 4096, "decisions of each match per update"),
      WHOLE(threads, 1, 256, "threads"),
      SEED(seed, "everything random follows from it"),
      TEXT(opponent, "mix of self, frozen, pool and players, such as self=0.6,pool=0.4"),
      REAL(replace_score, -10, 10, "frozen: mean goal difference at which it is replaced"),
      SWITCH(score_window_zero_filled, "frozen: the paper's window of 100 results, zeros at first and never cleared"),
      WHOLE(pool_size, 1, 1000, "pool: earlier selves kept"),
      WHOLE(pool_every, 1, 1000000, "pool: updates between two additions"),
      REAL(opponent_gain_low, 0, 4, "earlier selves drive at a gain drawn for each episode, from"),
      REAL(opponent_gain_high, 0, 4, "... to; 0: at action_gain"),
      REAL(opponent_mean, 0, 1, "share of episodes in which they take the mean of what they would draw from"),
      TEXT(reward, "paper, dense or goals, then term=weight"),
      TEXT(reward_end, "what the reward becomes"),
      REAL(anneal_from_m, 0, 1e6, "millions of transitions where the change begins"),
      REAL(anneal_to_m, 0, 1e6, "... and ends"),
      REAL(gamma, 0.5, 0.99999, "discount per decision"),
      REAL(lambda, 0, 1, "of the advantage estimate"),
      REAL(clip, 0.01, 1, "of the probability ratio"),
      REAL(entropy, 0, 1, "weight of the entropy bonus"),
      REAL(value_weight, 0.001, 100, "weight of the value loss"),
      SWITCH(clip_value, "clip the value like the ratio"),
      SWITCH(value_scale, "value in units of the returns"),
      REAL(learning_rate, 1e-7, 0.1, "of Adam, at the start"),
      REAL(learning_rate_end, 1e-7, 0.1, "... at transitions_m"),
      TEXT(learning_rate_decay, "... linear or exponential in between"),
      REAL(learning_rate_hold_m, 0, 1e6, "... once so many millions of transitions are done"),
      REAL(adam_epsilon, 1e-12, 0.1, "of Adam"),
      REAL(max_gradient_norm, 1e-3, 1e6, "gradients are scaled down to it"),
      WHOLE(epochs, 1, 100, "passes over a batch"),
      WHOLE(minibatch, 16, 10000000, "rows of one gradient"),
      WHOLE(microbatches, 1, 64, "parts a minibatch is computed in (results depend on it, not on threads)"),
      WHOLE(augment, 0, 1000000,
            "decisions until a robot's networks see another symmetric version, at random; 0: never"),
      SWITCH(reversible, "networks see a robot by the end that faces their goal: front and back are alike"),
      SWITCH(canonical, "networks see the canonical one of an observation's mirror images and numberings"),
      REAL(action_gain, 1, 4, "the policy's output times this, clipped, is the wheel command"),
      SWITCH(export_average, "policy files ask the network about all 24 symmetric versions and take the mean"),
      REAL(export_gain, 0, 4, "action_gain of policy files; 0: as in training"),
      REAL(export_horizon_m, 0, 1000,
           "policy files hold the mean of the networks of so many million transitions; 0: the last"),
      TEXT(hidden, "layer sizes of both networks"),
      REAL(initial_concentration, 1.01, 100, "alpha = beta of the untrained policy's Beta distributions"),
      TEXT(learner, "own (kernels over BLAS) or torch"),
      TEXT(precision, "own learner's backward pass: fp32, bf16, or auto: the faster one here, tried at the start"),
      REAL(transitions_m, 0, 1e9, "millions of transitions to stop at; 0: until stopped"),
      // Names of before 0.1.0, in checkpoints and in scripts.
      ALIAS(pieces, microbatches),
      ALIAS(first_shape, initial_concentration),
      ALIAS(window_of_zeros, score_window_zero_filled),
      {.name = NULL},
  };
  _Static_assert(sizeof rows / sizeof *rows <= VS_TRAIN_KEYS_MAX, "raise VS_TRAIN_KEYS_MAX");
  memcpy(keys, rows, sizeof rows);
}

// With as few digits as read back as the same number.
static void print_real(char *line, size_t size, const char *name, double value) {
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(line, size, "%s = %.*g\n", name, digits, value);
    if (strtod(strchr(line, '=') + 1, NULL) == value) break;
  }
}

static void add_text(const char *text, char *out, size_t size, size_t *used) {
  size_t n = strlen(text);
  if (*used + n < size) memcpy(out + *used, text, n + 1);
  *used += n;
}

static void comment(const vs_config_key *k, char *line, size_t size) {
  if (k->min != 0.0 || k->max != 0.0)
    snprintf(line, size, "# %s; %.10g to %.10g\n", k->help, k->min, k->max);
  else
    snprintf(line, size, "# %s\n", k->help);
}

size_t vs_train_def_text(const vs_train_def *def, bool comments, char *out, size_t size) {
  vs_train_def copy = *def;
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  vs_train_schema(&copy, keys);
  size_t used = 0;
  for (const vs_config_key *k = keys; k->name; k++) {
    char line[768], quoted[640];
    if (k->type == VS_CONFIG_ALIAS) continue;
    if (comments) comment(k, line, sizeof line), add_text(line, out, size, &used);
    switch (k->type) {
    case VS_CONFIG_INT: snprintf(line, sizeof line, "%s = %d\n", k->name, *(int *)k->target); break;
    case VS_CONFIG_SEED: snprintf(line, sizeof line, "%s = %" PRIu64 "\n", k->name, *(uint64_t *)k->target); break;
    case VS_CONFIG_REAL: print_real(line, sizeof line, k->name, *(double *)k->target); break;
    case VS_CONFIG_BOOL:
      snprintf(line, sizeof line, "%s = %s\n", k->name, *(bool *)k->target ? "true" : "false");
      break;
    case VS_CONFIG_TEXT:
      vs_config_quote(k->target, quoted, sizeof quoted);
      snprintf(line, sizeof line, "%s = %s\n", k->name, quoted);
      break;
    case VS_CONFIG_ALIAS: break;
    }
    add_text(line, out, size, &used);
  }
  return used;
}

vs_status vs_train_hidden(const vs_train_def *def, vs_net_shape *shape, vs_error *err) {
  const char *text = def->hidden;
  shape->layers = 0;
  do {
    char *end;
    long width = strtol(text, &end, 10);
    if (end == text || (*end && *end != ',') || width < 1 || width > 4096 || shape->layers == VS_NET_MAX_LAYERS)
      return vs_fail(err, VS_USAGE, "hidden = %s: expected 1 to %d sizes of 1 to 4096, such as 256,256", def->hidden,
                     VS_NET_MAX_LAYERS);
    shape->width[shape->layers++] = (int)width;
    text = *end ? end + 1 : end;
  } while (*text);
  return VS_OK;
}

vs_status vs_train_precision(const vs_train_def *def, vs_precision *out, vs_error *err) {
  static const char *const names[] = {
      [VS_PRECISION_FP32] = "fp32", [VS_PRECISION_BF16] = "bf16", [VS_PRECISION_AUTO] = "auto", NULL};
  int precision;
  vs_status s = vs_word_parse("precision", def->precision, names, &precision, err);
  if (s == VS_OK) *out = (vs_precision)precision;
  return s;
}

double vs_train_learning_rate(const vs_train_def *def, double transitions) {
  double falls_m = def->transitions_m - def->learning_rate_hold_m; // the length of the fall
  double part = falls_m > 0.0 ? fmin(fmax(transitions * 1e-6 - def->learning_rate_hold_m, 0.0) / falls_m, 1.0) : 0.0;
  if (!strcmp(def->learning_rate_decay, "exponential"))
    return def->learning_rate * pow(def->learning_rate_end / def->learning_rate, part);
  return def->learning_rate + part * (def->learning_rate_end - def->learning_rate);
}

vs_status vs_train_def_check(const vs_train_def *def, vs_error *err) {
  vs_drive drive;
  vs_placement_mode placement;
  vs_net_shape shape;
  vs_league_def league;
  vs_reward_weights weights;
  vs_status s = vs_drive_parse(def->drive, &drive, err);
  if (s == VS_OK) s = vs_placement_parse(def->placement, &placement, err);
  vs_predicts predicts;
  if (s == VS_OK) s = vs_predicts_parse(def->predicts, &predicts, err);
  if (s == VS_OK) s = vs_train_hidden(def, &shape, err);
  if (s == VS_OK) s = vs_league_parse(def->opponent, &league, err);
  if (s == VS_OK) s = vs_reward_mix_parse(def->reward, &weights, err);
  if (s == VS_OK) s = vs_reward_mix_parse(def->reward_end, &weights, err);
  if (s != VS_OK) return s;
  static const char *const decays[] = {"linear", "exponential", NULL}, *const learners[] = {"own", "torch", NULL};
  int which;
  vs_precision precision = VS_PRECISION_FP32;
  s = vs_word_parse("learning_rate_decay", def->learning_rate_decay, decays, &which, err);
  if (s == VS_OK) s = vs_word_parse("learner", def->learner, learners, &which, err);
  if (s == VS_OK) s = vs_train_precision(def, &precision, err);
  if (s != VS_OK) return s;
  if (precision == VS_PRECISION_BF16 && !strcmp(def->learner, "torch"))
    return vs_fail(err, VS_USAGE, "precision = bf16: is for learner = own; torch computes in fp32");
  if (def->canonical && def->augment)
    return vs_fail(err, VS_USAGE, "canonical and augment exclude each other: set canonical = false or augment = 0");
  if (def->canonical && def->export_average)
    return vs_fail(err, VS_USAGE, "canonical and export_average exclude each other: set one of them to false");
  if (def->opponent_gain_high < def->opponent_gain_low)
    return vs_fail(err, VS_USAGE, "opponent_gain_high = %g: must not be below opponent_gain_low = %g",
                   def->opponent_gain_high, def->opponent_gain_low);
  if (def->still_high_s < def->still_low_s)
    return vs_fail(err, VS_USAGE, "still_high_s = %g: must not be below still_low_s = %g", def->still_high_s,
                   def->still_low_s);
  if (def->start_open + def->start_penalty + def->start_free_ball > 1.0 + 1e-9)
    return vs_fail(err, VS_USAGE, "start_open + start_penalty + start_free_ball = %g: at most 1",
                   def->start_open + def->start_penalty + def->start_free_ball);
  if (def->anneal_to_m < def->anneal_from_m)
    return vs_fail(err, VS_USAGE, "anneal_to_m = %g: must not be below anneal_from_m = %g", def->anneal_to_m,
                   def->anneal_from_m);
  long long batch = 3LL * def->envs * def->steps;
  if (def->minibatch > 2 * batch)
    return vs_fail(err, VS_USAGE,
                   "minibatch = %d: a batch of %d matches x %d steps has %lld rows with one side learning",
                   def->minibatch, def->envs, def->steps, batch);
  return VS_OK;
}
