// What a run leaves behind for people: progress.csv, eval.csv and a TensorBoard event file in its folder.
#ifndef VSSS_JOURNAL_H
#define VSSS_JOURNAL_H

#include "vsss/learn.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_journal vs_journal;

// Continues a folder's files after `update`: later lines, left by a run that was killed, are dropped; 0 starts anew.
vs_status vs_journal_open(const char *folder, double update, vs_journal **out, vs_error *err);
void vs_journal_close(vs_journal *journal);

vs_status vs_journal_add(vs_journal *journal, const vs_train_report *report, vs_error *err);
vs_status vs_journal_add_eval(vs_journal *journal, const vs_train_report *report, const vs_train_score *score,
                              vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
