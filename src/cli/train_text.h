// How a training run does, as three lines for people.
#ifndef VSSS_CLI_TRAIN_TEXT_H
#define VSSS_CLI_TRAIN_TEXT_H

#include "vsss/learn.h"

// How fast; the reward and what its terms add to it; how the policy learns and fares. Lines are separated by '\n'.
void train_text(const vs_train *train, const vs_train_report *report, char *out, size_t size);

#endif
