// Periodic evaluation of a run: the exported policy as anyone would play it, on the reference drive.
#include <stdio.h>
#include <stdlib.h>

#include "vsss/eval.h"
#include "vsss/journal.h"

static vs_status play(const vs_series_def *def, vs_match_result *results, vs_journal_eval *out, vs_error *err) {
  vs_status s = vs_series_play(def, results, err);
  if (s != VS_OK) return s;
  vs_series_summary sum;
  s = vs_series_sum_up(results, def->matches, &sum, err);
  if (s != VS_OK) return s;
  out->matches = sum.matches;
  out->win = sum.win.mean, out->draw = sum.draw.mean, out->loss = sum.loss.mean;
  out->goals_for = sum.goals_for.mean, out->goals_against = sum.goals_against.mean;
  out->score = sum.score.mean, out->score_low = sum.score.low, out->score_high = sum.score.high;
  return VS_OK;
}

vs_status vs_train_evaluate(const char *policy_file, const char *opponent, int matches, int threads, uint64_t seed,
                            bool (*go_on)(void *context), void *context, vs_journal_eval *out, vs_error *err) {
  *out = (vs_journal_eval){.opponent = opponent};
  char uri[512];
  if ((size_t)snprintf(uri, sizeof uri, "onnx:%s", policy_file) >= sizeof uri)
    return vs_fail(err, VS_FAIL, "%.300s: path too long", policy_file);
  vs_model_def model_def = vs_model_def_default(VS_DRIVE_CONTACT);
  vs_model *model = NULL;
  vs_status s = vs_model_load(&model_def, &model, err);
  if (s != VS_OK) return s;
  vs_series_def def = {.env = vs_env_def_default(model),
                       .matches = matches,
                       .threads = threads,
                       .seed = seed,
                       .go_on = go_on,
                       .context = context};
  def.env.player[VS_BLUE] = uri;
  def.env.player[VS_YELLOW] = opponent;
  vs_match_result *results = calloc((size_t)matches, sizeof *results);
  s = results ? play(&def, results, out, err) : vs_fail(err, VS_FAIL, "out of memory for %d matches", matches);
  free(results);
  vs_model_free(model);
  return s;
}
