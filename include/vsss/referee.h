// Stable: part of libvsss (deploy/docs/library.md).
//
// World in, event out; and where the pieces stand after an event. Pure: reads no clock, moves nothing.
//
// Sets of rules, each a table: the paper's (section V: goal, penalty, free ball) and the league's (the automatic
// referee of the simulation league, VSSSLeague/VSSReferee, tag LARC2022: also goal kicks, areas judged play by play).
// Two more follow the texts for real robots, Serie A 2023 and LARC 2026, as far as positions show it; with LARC's the idle rule
// is enforced (idle.h).
// Any division (division.h): the worlds say which. What the texts say for 3 against 3 is judged alike in 5 against 5.
// The league's pauses between whistle and restart are left out: a restart happens at once.
#ifndef VSSS_REFEREE_H
#define VSSS_REFEREE_H

#include "vsss/api.h"
#include "vsss/idle.h"
#include "vsss/rng.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_rules { VS_RULES_PAPER, VS_RULES_LEAGUE, VS_RULES_SERIE_A_2023, VS_RULES_LARC_2026 } vs_rules;
typedef enum vs_placement_mode { VS_PLACEMENT_PAPER, VS_PLACEMENT_RANDOM, VS_PLACEMENT_MIXED } vs_placement_mode;

// Paper: a ball that has not moved 2 cm for 10 s. League: a ball slower than 0.1 m/s for 5 s, a foul in an area for 3 s,
// a robot's centre within 1.5 robots of 7.5 cm counts as being at the ball.
#define VS_STILL_DISTANCE_M   0.02
#define VS_STILL_S            10.0
#define VS_LEAGUE_STUCK_MPS   0.1
#define VS_LEAGUE_STUCK_S     5.0
#define VS_LEAGUE_FOUL_S      3.0
#define VS_LEAGUE_NEAR_BALL_M (1.5 * 0.075)
#define VS_SERIE_A_PATIENCE_S 10.0 // Serie A, LARC: stalemates, and how long a keeper may hold the ball
// Serie A, LARC: pushing without the ball. The texts name no numbers; ours: a robot moves one of the other team that it touches
// before it, both faster than VS_PUSH_MPS that way and farther than VS_PUSH_BALL_M from the ball, for VS_PUSH_S.
#define VS_PUSH_MPS    0.1
#define VS_PUSH_BALL_M 0.20
#define VS_PUSH_S      1.0
// Serie A, LARC: a robot covers more than this share of the ball's diameter, as seen from above: it holds the ball.
#define VS_HOLD_SHARE 0.30

// Extra time: two halves. Shoot-out: so many kicks each, from the penalty mark in turn, then in pairs until one is ahead;
// after VS_SHOOT_OUT_MOST each a coin is thrown (ours: two teams that never score would not end). A kick is over with a goal,
// a ball out of the field, or its time.
#define VS_SHOOT_OUT_KICKS 3
#define VS_SHOOT_OUT_MOST  20

typedef struct vs_referee_def {
  vs_rules rules;
  vs_placement_mode placement;
  double duration_s;        // 120; both halves together
  int goal_difference_stop; // 10; 0: never
  bool end_at_first_goal;   // training episodes
  int halves;               // 1 (paper) or 2 (league); sides are not changed
  vs_team kick_off;         // who begins
  double still_s;           // paper's rules: a free ball after so long within still_distance_m; VS_STILL_S
  double still_distance_m;  // VS_STILL_DISTANCE_M
  bool knockout;            // a tied match goes on until there is a winner
  double extra_half_s;      // paper 36, league 180, Serie A and LARC 120; 0: no extra time
  double kick_s;            // of a shoot-out: 10, Serie A 30
} vs_referee_def;

VSSS_API vs_referee_def vs_referee_def_default(vs_rules rules);             // a match: paper 120 s, league 2 x 300 s
VSSS_API void vs_referee_def_lasts(vs_referee_def *def, double duration_s); // extra time in proportion
VSSS_API vs_referee_def vs_referee_def_training(void); // 40 s, first goal ends it, random placement

// Of vs_referee.half. A match of one half has only the first; 0 and 1 are regular time.
enum { VS_HALF_EXTRA_1 = 2, VS_HALF_EXTRA_2, VS_HALF_SHOOT_OUT };

// Time-outs of a team in a match, between whistle and restart, which only a match with pauses has (`vsss serve`). League: as
// VSSReferee's configuration of 2025 has them, 2 of 120 s; LARC 2 of 180 s; Serie A 2, whose length our copy of the text
// does not give: LARC's; paper none.
typedef struct vs_time_outs {
  int number;
  double length_s;
} vs_time_outs;
VSSS_API vs_time_outs vs_time_outs_by(vs_rules rules);

// Plain data: a copy is a snapshot.
typedef struct vs_referee {
  vs_referee_def def;
  vs_game game; // clock, score, last event (absolute frame)
  bool over;
  vs_team kick_off; // who kicks off next; in a shoot-out: who kicks
  int half;
  // The ball lies still, by either set of rules' meaning, since still_s seconds, the paper's from this point.
  double still_x_m, still_y_m, still_s;
  // League. The team in whose area the ball is (-1: none) and what went wrong there since it came in: for how long two
  // defenders, two attackers have been in the area, and the match time at which this was last so (-1: not yet).
  int play_area;
  // Serie A and LARC: for how long the ball there has been uncontested, contested, and when a second defender, a second
  // attacker interfered.
  double defence_s, attack_s, defence_seen_s, attack_seen_s;
  int free_balls;          // in a row
  double push_s[VS_TEAMS]; // for how long the team has been pushing
  vs_idle idle;            // LARC
  // Shoot-out.
  int kicks[VS_TEAMS], kicks_scored[VS_TEAMS];
  int lot;       // 0, or 1 + the team that won by it
  double kick_s; // since this kick began
} vs_referee;

// game.last_event is then the first KICK_OFF, which wants vs_place. VS_USAGE: a number out of range.
VSSS_API vs_status vs_referee_init(vs_referee *referee, const vs_referee_def *def, vs_error *err);
// Whether a copy, of a match of this def, can be gone on from: false for numbers that no match has, as in a damaged file.
VSSS_API bool vs_referee_ok(const vs_referee *referee, const vs_referee_def *def);
// Time goes on by dt_s and the true world is judged. Returns what happened (VS_EVENT_NONE mostly); game is up to date.
// GOAL, PENALTY, FREE_BALL, FREE_KICK, GOAL_KICK, HALF_TIME, EXTRA_TIME and SHOOT_OUT want vs_place and vs_referee_restarted, unless the match is over.
// It is over after END (time is up) and after a GOAL that ends it (first goal of an episode, goal difference, or time
// up in the same frame: no END follows then). A match that is over returns NONE.
// SENT_OFF: see vs_referee_off.
VSSS_API vs_event vs_referee_step(vs_referee *referee, const vs_world *world, double dt_s);
// Of a match that is over; -1: a draw.
VSSS_API int vs_referee_winner(const vs_referee *referee);
// A false start (Serie A, LARC): a robot leaves the place where it was put before GAME ON; the texts give no distance, this one is
// ours. FOUL: one team did, event is the other's free kick. PUT_BACK: both did, or in a shoot-out: all go back to placed.
#define VS_FALSE_START_M 0.03
typedef enum vs_start { VS_START_PLAY, VS_START_FOUL, VS_START_PUT_BACK } vs_start;
VSSS_API vs_start vs_referee_start(vs_referee *referee, const vs_world *placed, const vs_world *now, vs_event *event);
// Who is off until the half ends: to be put beside the field (vs_world_beside) and left out of restarts.
VSSS_API bool vs_referee_off(const vs_referee *referee, vs_team team, int robot);
// ... whose wheels stand still, whatever their team commands.
VSSS_API void vs_referee_hold_off(const vs_referee *referee, vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST]);
// After a placement: the clocks of stillness and of fouls start anew.
VSSS_API void vs_referee_restarted(vs_referee *referee, const vs_world *world);

// Legal poses for the restart that event calls for (a goal is followed by the conceding side's kick-off), everything at
// rest; time_us and seq are before's. PAPER: the fixed positions, rng is not used; robot 0 keeps the goal and, at a
// penalty, stands on its line pointed straight at the ball. RANDOM: the ball where the restart puts it, robots anywhere
// the rules allow, roles and headings random. MIXED: each restart one or the other, half and half. Events without a
// placement (NONE, END, HALT) give before itself.
VSSS_API void vs_place(vs_placement_mode mode, const vs_event *event, const vs_world *before, vs_rng *rng,
                       vs_world *out);

// PAPER's poses of one team at that restart; standing at the centre for events without a placement.
VSSS_API void vs_place_team(vs_division division, const vs_event *event, vs_team team, vs_pose *out /* [team_size] */);

// Puts those that are off beside the field. The others of their team move up: the last one takes the place of a missing keeper
// (robot 0) or taker (robot 1).
VSSS_API void vs_place_without(const vs_referee *referee, vs_world *placed);

// Whether a team may stand like this (pose: of each of its robots) at that restart: inside the field, on nobody and not on the ball's place, where the
// rules let it, and with the robot that the restart needs (taker, keeper on its line). Absolute frame. VS_FAIL says which
// robot and why. The fixed positions of vs_place pass.
VSSS_API vs_status vs_placement_check(vs_division division, const vs_event *event, vs_team team, const vs_pose *pose,
                                      vs_error *err);

// Open play, for the starts of training episodes: robots anywhere with any heading, the ball anywhere outside the areas
// (a third of the time at a wall or in a corner) and, but for those, rolling at up to VS_OPEN_PLAY_MPS.
#define VS_OPEN_PLAY_MPS 1.0
VSSS_API void vs_place_open_play(const vs_world *before, vs_rng *rng, vs_world *out);

// "paper", "league", "serie-a-2023", "larc-2026"
VSSS_API vs_status vs_rules_parse(const char *name, vs_rules *out, vs_error *err);
VSSS_API vs_status vs_placement_parse(const char *name, vs_placement_mode *out,
                                      vs_error *err); // "paper", "random", "mixed"

#ifdef __cplusplus
}
#endif
#endif
