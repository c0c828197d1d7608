// src/policy/strategies/inf_tactics.c: a test per row of the tactics table, its special cases, overrides and the logic of
// stuck robots. Robots 0, 1, 2 are attacker, midfielder, keeper.
#include "policy/strategies/inf.h"
#include "rows.h"

#define DT_S 0.03125

typedef struct row {
  const char *name;
  inf_phase phase;
  vs_point ball, at[VS_TEAM_SIZE]; // a robot left out stands far away
  inf_tactic want[VS_TEAM_SIZE];
} row;

static inf_state scene(inf_phase phase, vs_point ball, const vs_point *at) {
  static const vs_point away[] = {{200, 20}, {220, 20}, {240, 20}};
  inf_state s;
  inf_init(&s);
  s.phase = phase;
  s.ball = ball;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    s.robot[i].at = at[i].x == 0 ? away[i] : at[i];
    s.robot[i].before = (vs_point){s.robot[i].at.x + 50, s.robot[i].at.y}; // on the move: not stuck
  }
  return s;
}

static void run(void **state) {
  const row *r = *state;
  inf_state s = scene(r->phase, r->ball, r->at);
  inf_choose_tactics(&s, DT_S);
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_int_equal(s.robot[i].tactic, r->want[i]);
}

static const row rows[] = {
    {"advance", INF_ADVANCE, {400, 240}, {{0, 0}}, {INF_CATCH, INF_WAIT, INF_BLOCK}},
    {"advance, attacker touches and can kick", INF_ADVANCE, {400, 240}, {{370, 240}}, {INF_KICK, INF_WAIT, INF_BLOCK}},
    {"advance, attacker touches and cannot kick",
     INF_ADVANCE,
     {400, 240},
     {{400, 270}},
     {INF_SPIN, INF_WAIT, INF_BLOCK}},
    {"push", INF_PUSH, {300, 240}, {{0, 0}}, {INF_CATCH, INF_OPENING, INF_BLOCK}},
    {"recover, far half", INF_RECOVER, {400, 240}, {{0, 0}}, {INF_CATCH, INF_PUSHB, INF_BLOCK}},
    {"recover, kept in the near half", INF_RECOVER, {300, 240}, {{0, 0}}, {INF_CATCH, INF_BLOCK, INF_BLOCK}},
    {"pass", INF_PASS, {300, 240}, {{0, 0}}, {INF_OPENING, INF_CATCH, INF_BLOCK}},
    {"return", INF_RETURN, {400, 240}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_BLOCK}},
    {"danger", INF_DANGER, {300, 240}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_BLOCK}},
    {"our end, upper corner", INF_PUSH, {100, 400}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_BLOCK}},
    {"our end, lower corner", INF_PUSH, {100, 80}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_BLOCK}},
    {"our end, before the goal", INF_PUSH, {100, 240}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_PUSHB}},
    {"our end, beside the goal", INF_PUSH, {100, 350}, {{0, 0}}, {INF_SIDE, INF_OPENING, INF_CATCH}},
    {"our end, beside the goal, keeper touches",
     INF_PUSH,
     {100, 350},
     {{0, 0}, {0, 0}, {100, 330}},
     {INF_OPENING, INF_OPENING, INF_SPIN}},
    {"their end", INF_RETURN, {550, 100}, {{0, 0}}, {INF_CATCH, INF_WAIT, INF_BLOCK}},
    {"their end, attacker touches", INF_ADVANCE, {550, 240}, {{520, 240}}, {INF_SPIN, INF_WAIT, INF_BLOCK}},
    {"keeper touches: spins", INF_PUSH, {300, 240}, {{0, 0}, {0, 0}, {270, 240}}, {INF_CATCH, INF_OPENING, INF_SPIN}},
    {"keeper touches before the goal: spins, does not push",
     INF_PUSH,
     {100, 240},
     {{0, 0}, {0, 0}, {70, 240}},
     {INF_SIDE, INF_OPENING, INF_SPIN}},
    {"midfielder touches: spins", INF_PUSH, {300, 240}, {{0, 0}, {270, 240}}, {INF_CATCH, INF_SPIN, INF_BLOCK}},
    {"midfielder touches while it pushes: goes on",
     INF_RECOVER,
     {400, 240},
     {{0, 0}, {370, 240}},
     {INF_CATCH, INF_PUSHB, INF_BLOCK}},
    {"attacker touches: spins", INF_PUSH, {300, 240}, {{270, 240}}, {INF_SPIN, INF_OPENING, INF_BLOCK}},
    {"35.9 px is a touch", INF_PUSH, {300, 240}, {{264.1, 240}}, {INF_SPIN, INF_OPENING, INF_BLOCK}},
    {"36.1 px is none", INF_PUSH, {300, 240}, {{263.9, 240}}, {INF_CATCH, INF_OPENING, INF_BLOCK}},
};

// The attacker in PUSH, whose table says CATCH.
typedef struct stuck {
  const char *name;
  double moved_px;
  bool locked;
  double locked_s, timer_s;
  vs_point ball;
  inf_tactic before, want;
  double want_locked_s, want_timer_s, want_sign;
} stuck;

#define FAR_BALL                                                                                                       \
  { 300, 240 }
#define NEAR_BALL                                                                                                      \
  { 220, 20 }

static const stuck stucks[] = {
    {"slow: time runs", 0.3, false, 0.125, 0, FAR_BALL, INF_CATCH, INF_CATCH, 0.125 + DT_S, 0, 1},
    {"slow for 0.2 s, ball far: unlocks and turns the sign", 0.3, false, 0.25, 0, FAR_BALL, INF_CATCH, INF_UNLOCK, 0,
     0.8 - DT_S, -1},
    {"slow for 0.2 s, ball near: spins", 0.3, false, 0.25, 0, NEAR_BALL, INF_CATCH, INF_SPIN, 0.25, 0.5 - DT_S, 1},
    {"moving: time starts anew", 0.4, false, 0.25, 0, FAR_BALL, INF_CATCH, INF_CATCH, 0, 0, 1},
    {"slow but standing on purpose: time starts anew", 0.3, true, 0.25, 0, FAR_BALL, INF_CATCH, INF_CATCH, 0, 0, 1},
    {"tactic on a timer: kept, the timer runs twice", 0.3, false, 0.25, 0.5, FAR_BALL, INF_UNLOCK, INF_UNLOCK, 0.25,
     0.5 - 2 * DT_S, 1},
    {"tactic on a timer, standing on purpose: the timer runs once", 0.3, true, 0.25, 0.5, FAR_BALL, INF_SPIN, INF_SPIN,
     0, 0.5 - DT_S, 1},
    {"timer ends in the first step: the table again", 0.3, false, 0.25, DT_S, FAR_BALL, INF_UNLOCK, INF_CATCH, 0.25, 0,
     1},
};

static void run_stuck(void **state) {
  const stuck *r = *state;
  const vs_point away[VS_TEAM_SIZE] = {{0, 0}};
  inf_state s = scene(INF_PUSH, r->ball, away);
  inf_robot *a = &s.robot[0];
  a->before = (vs_point){a->at.x + r->moved_px, a->at.y}; // slow is under 10 px/s: 0.3125 px in this tick
  a->locked = r->locked;
  a->locked_s = r->locked_s;
  a->timer_s = r->timer_s;
  a->tactic = r->before;
  inf_choose_tactics(&s, DT_S);
  assert_int_equal(a->tactic, r->want);
  assert_near(a->locked_s, r->want_locked_s, 1e-12);
  assert_near(a->timer_s, r->want_timer_s, 1e-12);
  assert_near(s.unlock_sign, r->want_sign, 0);
}

int main(void) { return RUN_ROWS("tactics", rows, run) + RUN_ROWS("stuck", stucks, run_stuck); }
