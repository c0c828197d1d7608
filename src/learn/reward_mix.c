#include "reward_mix.h"

#include <stdio.h>
#include <string.h>

#include "vsss/geom.h"
#include "vsss/number.h"

// Dense: each robot's own way to the ball, ball progress without the paper's constant offset, the paper's distance and
// angles; goals worth some 50 decisions of good play. A trial with these learnt to beat random play in minutes, where
// the paper's showed nothing (the offset alone is worth -43 of value).
static const vs_reward_weights dense = {{[VS_REWARD_DISTANCE] = 0.05,
                                         [VS_REWARD_OFFENCE] = 0.05,
                                         [VS_REWARD_DEFENCE] = 0.05,
                                         [VS_REWARD_GOAL] = 5.0,
                                         [VS_REWARD_FOUL] = 1.0,
                                         [VS_REWARD_PROGRESS] = 1.0,
                                         [VS_REWARD_APPROACH] = 0.3,
                                         [VS_REWARD_OWN_DISTANCE] = 0.1}};
// Goals and fouls alone, and a trace of ball progress, so that a game without goals still teaches.
static const vs_reward_weights goals = {{[VS_REWARD_GOAL] = 5.0, [VS_REWARD_FOUL] = 1.0, [VS_REWARD_PROGRESS] = 0.2}};

static vs_status preset(const char *name, vs_reward_weights *out, vs_error *err) {
  if (!strcmp(name, "paper"))
    *out = vs_reward_paper();
  else if (!strcmp(name, "dense"))
    *out = dense;
  else if (!strcmp(name, "goals"))
    *out = goals;
  else
    return vs_fail(err, VS_USAGE, "reward '%s': expected paper, dense or goals, then term=weight", name);
  return VS_OK;
}

static vs_status change(const char *word, vs_reward_weights *out, vs_error *err) {
  const char *equals = strchr(word, '=');
  for (int t = 0; equals && t < VS_REWARD_TERMS; t++) {
    const char *name = vs_reward_name((vs_reward_term)t);
    if (strlen(name) != (size_t)(equals - word) || strncmp(name, word, strlen(name)) != 0) continue;
    double weight;
    if (!vs_parse_real(equals + 1, &weight) || !(weight >= -1000.0 && weight <= 1000.0))
      return vs_fail(err, VS_USAGE, "reward '%s': the weight must be between -1000 and 1000", word);
    out->weight[t] = weight;
    return VS_OK;
  }
  char known[256] = "";
  for (int t = 0; t < VS_REWARD_TERMS; t++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", t ? ", " : "", vs_reward_name((vs_reward_term)t));
  }
  return vs_fail(err, VS_USAGE, "reward '%s': expected term=weight with one of the terms %s", word, known);
}

vs_status vs_reward_mix_parse(const char *text, vs_reward_weights *out, vs_error *err) {
  bool first = true;
  do {
    char word[64];
    size_t n = strcspn(text, ",");
    if (n >= sizeof word) return vs_fail(err, VS_USAGE, "reward '%.40s...' is too long", text);
    memcpy(word, text, n);
    word[n] = '\0';
    vs_status s = first ? preset(word, out, err) : change(word, out, err);
    if (s != VS_OK) return s;
    first = false;
    text += n + (text[n] == ',');
  } while (*text);
  return VS_OK;
}

vs_reward_weights vs_reward_mix_at(const vs_reward_weights *start, const vs_reward_weights *end, double from, double to,
                                   double at) {
  double part = to > from ? vs_clamp((at - from) / (to - from), 0.0, 1.0) : at >= from;
  vs_reward_weights out;
  for (int t = 0; t < VS_REWARD_TERMS; t++) out.weight[t] = (1.0 - part) * start->weight[t] + part * end->weight[t];
  return out;
}
