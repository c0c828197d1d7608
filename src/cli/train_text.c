#include "train_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void append(char *out, size_t size, const char *format, ...) {
  size_t used = strlen(out);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(out + used, size - used, format, arguments);
  va_end(arguments);
}

void train_text(const vs_train *train, const vs_train_report *r, char *out, size_t size) {
  double percent = 100.0 / (r->simulate_s + r->infer_s + r->learn_s);
  out[0] = '\0';
  append(out, size, "%.2f M, %.0f/s (sim %.0f infer %.0f learn %.0f %%)", r->transitions * 1e-6, r->transitions_per_s,
         percent * r->simulate_s, percent * r->infer_s, percent * r->learn_s);
  append(out, size, "\n  reward %+.3f:", r->reward);
  for (int k = 0; k < VS_REWARD_TERMS; k++)
    if (r->weight[k] != 0.0)
      append(out, size, " %s %+.3f", vs_reward_name((vs_reward_term)k), r->weight[k] * r->term[k]);
  append(out, size, "\n  entropy %.2f kl %.4f clipped %.2f explained %.2f  score", r->entropy, r->kl, r->clip_fraction,
         r->explained_variance);
  vs_train_opponent opponent[8];
  int count = vs_train_opponents(train, opponent, 8);
  for (int i = 0; i < count; i++) append(out, size, " %s %+.2f", opponent[i].name, opponent[i].recent_score);
  append(out, size, ", %.0f replaced", r->replacements);
}
