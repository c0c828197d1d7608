// What a run leaves behind for people: progress.csv, eval.csv and a TensorBoard event file in its folder.
#ifndef VSSS_JOURNAL_H
#define VSSS_JOURNAL_H

#include "vsss/learn.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_journal vs_journal;

// Result of matches against one opponent.
typedef struct vs_journal_eval {
  const char *opponent;
  double matches, win, draw, loss, goals_for, goals_against, score, score_low, score_high;
} vs_journal_eval;

// Continues a folder's files after `update`: later lines, left by a run that was killed, are dropped; 0 starts anew.
vs_status vs_journal_open(const char *folder, double update, vs_journal **out, vs_error *err);
void vs_journal_close(vs_journal *journal);

// Plays matches of 120 s on the contact drive by the paper's rules: a policy file against any player. The same seed, the
// same matches. False from go_on (may be NULL) leaves it: matches is then how many were played.
vs_status vs_train_evaluate(const char *policy_file, const char *opponent, int matches, int threads, uint64_t seed,
                            bool (*go_on)(void *context), void *context, vs_journal_eval *out, vs_error *err);

vs_status vs_journal_add(vs_journal *journal, const vs_train_report *report, vs_error *err);
vs_status vs_journal_add_eval(vs_journal *journal, const vs_train_report *report, const vs_journal_eval *eval,
                              vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
