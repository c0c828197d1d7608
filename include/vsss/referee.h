// World in, event out; and where the pieces stand after an event. Pure: reads no clock, moves nothing.
#ifndef VSSS_REFEREE_H
#define VSSS_REFEREE_H

#include "vsss/rng.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_rules { VS_RULES_PAPER, VS_RULES_LEAGUE } vs_rules;
typedef enum vs_placement_mode { VS_PLACEMENT_PAPER, VS_PLACEMENT_RANDOM } vs_placement_mode;

typedef struct vs_referee_def {
  vs_rules rules;
  vs_placement_mode placement;
  double duration_s;        // 120
  int goal_difference_stop; // 10; 0: never
  bool end_at_first_goal;   // training episodes
  int halves;               // 1 (paper) or 2
} vs_referee_def;

vs_referee_def vs_referee_def_default(vs_rules rules); // a match; ranges checked by vs_referee_init
vs_referee_def vs_referee_def_training(void);          // 40 s, first goal ends it, random placement

// Plain data: a copy is a snapshot.
typedef struct vs_referee {
  vs_referee_def def;
  vs_game game; // clock, score, last event (absolute frame)
  bool over;
  double still_x_m, still_y_m, still_s;        // where and since when the ball has not moved
  double area_s[VS_TEAMS], attack_s[VS_TEAMS]; // league: how long a foul has lasted
  vs_team kick_off;                            // who kicks off next
} vs_referee;

vs_status vs_referee_init(vs_referee *referee, const vs_referee_def *def, vs_error *err);
// Time goes on by dt_s and the true world is judged. Returns what happened (VS_EVENT_NONE mostly); game is up to date.
// GOAL, PENALTY, FREE_BALL, GOAL_KICK, HALF_TIME and KICK_OFF want vs_place; END means over (score in game).
vs_event vs_referee_step(vs_referee *referee, const vs_world *world, double dt_s);
// Forgets the stillness clock after a placement.
void vs_referee_restarted(vs_referee *referee, const vs_world *world);

// Legal poses for the restart that event calls for (a goal is followed by the conceding side's kick-off). For paper
// placement rng is drawn from only where the paper leaves a choice. time_us and seq are left alone.
void vs_place(vs_rules rules, vs_placement_mode mode, const vs_event *event, const vs_world *before, vs_rng *rng,
              vs_world *out);

vs_status vs_rules_parse(const char *name, vs_rules *out, vs_error *err);
vs_status vs_placement_parse(const char *name, vs_placement_mode *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
