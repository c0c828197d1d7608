// Periodic evaluation of a run: the exported policy as anyone would play it.
#include <stdio.h>
#include <stdlib.h>

#include "vsss/eval.h"
#include "vsss/learn.h"

static vs_status play(const vs_series_def *def, vs_match_result *results, vs_train_score *out, vs_error *err) {
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

vs_status vs_train_evaluate(const vs_train_eval_def *def, vs_train_score *out, vs_error *err) {
  *out = (vs_train_score){.opponent = def->opponent};
  char uri[512];
  if ((size_t)snprintf(uri, sizeof uri, "onnx:%s", def->policy_file) >= sizeof uri)
    return vs_fail(err, VS_FAIL, "%.300s: path too long", def->policy_file);
  vs_model_def model_def = vs_model_def_default(def->drive);
  vs_model *model = NULL;
  vs_status s = vs_model_load(&model_def, &model, err);
  if (s != VS_OK) return s;
  vs_series_def series = {.env = vs_env_def_default(model),
                          .matches = def->matches,
                          .threads = def->threads,
                          .seed = def->seed,
                          .go_on = def->go_on,
                          .context = def->context};
  series.env.player[VS_BLUE] = uri;
  series.env.player[VS_YELLOW] = def->opponent;
  vs_match_result *results = calloc((size_t)def->matches, sizeof *results);
  s = results ? play(&series, results, out, err) : vs_fail(err, VS_FAIL, "out of memory for %d matches", def->matches);
  free(results);
  vs_model_free(model);
  return s;
}
