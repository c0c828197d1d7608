// The columns of a training report: one table for CSV, TensorBoard and the status line.
#include <string.h>

#include "vsss/learn.h"

#define COLUMN(field, tag)                                                                                             \
  { #field, tag "/" #field, offsetof(vs_train_report, field) }
#define TERM(name, index)                                                                                              \
  { "term_" name, "reward/" name, offsetof(vs_train_report, term) + (index) * sizeof(double) }

static const vs_train_column columns[] = {
    COLUMN(update, "run"),
    COLUMN(transitions, "run"),
    COLUMN(wall_s, "run"),
    COLUMN(transitions_per_s, "speed"),
    COLUMN(simulate_s, "speed"),
    COLUMN(infer_s, "speed"),
    COLUMN(learn_s, "speed"),
    COLUMN(reward, "reward"),
    TERM("speed", VS_REWARD_SPEED),
    TERM("distance", VS_REWARD_DISTANCE),
    TERM("offence", VS_REWARD_OFFENCE),
    TERM("defence", VS_REWARD_DEFENCE),
    TERM("goal", VS_REWARD_GOAL),
    TERM("foul", VS_REWARD_FOUL),
    TERM("progress", VS_REWARD_PROGRESS),
    TERM("approach", VS_REWARD_APPROACH),
    TERM("own_distance", VS_REWARD_OWN_DISTANCE),
    TERM("still", VS_REWARD_STILL),
    COLUMN(entropy, "ppo"),
    COLUMN(kl, "ppo"),
    COLUMN(clip_fraction, "ppo"),
    COLUMN(explained_variance, "ppo"),
    COLUMN(policy_loss, "ppo"),
    COLUMN(value_loss, "ppo"),
    COLUMN(gradient_norm, "ppo"),
    COLUMN(learning_rate, "ppo"),
    COLUMN(episodes, "episode"),
    COLUMN(episode_s, "episode"),
    COLUMN(goals_for, "episode"),
    COLUMN(goals_against, "episode"),
    COLUMN(frozen_score, "league"),
    COLUMN(replacements, "league"),
    COLUMN(pool, "league"),
    COLUMN(self_score, "league"),
    COLUMN(pool_score, "league"),
};

const vs_train_column *vs_train_columns(int *count) {
  *count = (int)(sizeof columns / sizeof *columns);
  return columns;
}

double vs_train_value(const vs_train_report *report, const vs_train_column *column) {
  double value;
  memcpy(&value, (const char *)report + column->offset, sizeof value);
  return value;
}
