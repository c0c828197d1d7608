// The reward's weights by name, and their schedule.
#ifndef VSSS_LEARN_REWARD_MIX_H
#define VSSS_LEARN_REWARD_MIX_H

#include "vsss/reward.h"

// "paper", "dense", "goals", then changes "term=weight" by the names of vs_reward_name, separated by commas.
vs_status vs_reward_mix_parse(const char *text, vs_reward_weights *out, vs_error *err);

// start until `from`, end after `to`, linear between.
vs_reward_weights vs_reward_mix_at(const vs_reward_weights *start, const vs_reward_weights *end, double from, double to,
                                   double at);

#endif
