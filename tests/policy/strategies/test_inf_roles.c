// src/policy/strategies/inf.c: the kick angle, roles and states of play, a test per rule. Pixels of a 640 x 480 picture.
#include "policy/strategies/inf.h"
#include "rows.h"

typedef struct kick {
  const char *name;
  vs_point robot, ball;
  bool can;
} kick;

// The line ball -> (696, 240) has angle 0 for a ball on y = 240.
static const kick kicks[] = {
    {"robot straight behind the ball: can", {300, 240}, {400, 240}, true},
    {"44.6 degrees off: can", {329, 170}, {400, 240}, true},
    {"45.8 degrees off: cannot", {331, 169}, {400, 240}, false},
    {"44.6 degrees off on the other side: can", {329, 310}, {400, 240}, true},
    {"robot in front of the ball: cannot", {450, 240}, {400, 240}, false},
    // Robot -> (696, 240) is 52.5 degrees steep, though the ball lies in that direction.
    {"too steep to the goal: cannot", {650, 180}, {660, 195}, false},
    {"from beyond the goal, back into it: can", {760, 240}, {720, 240}, true},
};

static void run_kick(void **state) {
  const kick *k = *state;
  inf_state s;
  inf_init(&s);
  s.ball = k->ball;
  s.robot[1].at = k->robot;
  assert_int_equal(inf_can_kick(&s, 1), k->can);
}

typedef struct choice {
  const char *name;
  vs_point ball, robot[VS_TEAM_SIZE];
  int role[INF_ROLES]; // the robots that become attacker, midfielder, keeper
} choice;

static const choice choices[] = {
    {"attacker is who can kick, not who is nearest", {400, 240}, {{450, 240}, {300, 240}, {100, 240}}, {1, 0, 2}},
    {"a kicker 170 px away does not count: the nearest", {400, 240}, {{450, 240}, {230, 240}, {100, 240}}, {0, 1, 2}},
    {"of two kickers the nearer", {400, 240}, {{300, 240}, {350, 240}, {450, 240}}, {1, 2, 0}},
    {"nobody can kick: the nearest", {300, 240}, {{500, 240}, {450, 100}, {350, 240}}, {2, 0, 1}},
    {"keeper is the nearer to our goal of the others", {400, 240}, {{60, 300}, {350, 240}, {60, 250}}, {1, 0, 2}},
};

static inf_input input_of(vs_point ball, const vs_point *robot, double dt_s) {
  inf_input in = {.ball = ball, .dt_s = dt_s};
  for (int i = 0; i < VS_TEAM_SIZE; i++) in.at[i] = robot[i];
  return in;
}

static void run_choice(void **state) {
  const choice *c = *state;
  inf_state s;
  inf_init(&s);
  inf_input in = input_of(c->ball, c->robot, 0.25);
  double out[VS_TEAM_SIZE][2];
  inf_tick(&s, &in, out);
  for (int r = 0; r < INF_ROLES; r++) assert_int_equal(s.role[r], c->role[r]);
}

typedef struct phase {
  const char *name;
  double ball_x, attacker_x, midfielder_x, keeper_x;
  inf_phase before, after;
} phase;

static const phase phases[] = {
    {"attacker and midfielder behind, far half: advance", 400, 420, 300, 60, INF_PUSH, INF_ADVANCE},
    {"attacker and midfielder behind, near half: push", 300, 320, 200, 60, INF_ADVANCE, INF_PUSH},
    {"at the very middle: push", 320, 300, 200, 60, INF_ADVANCE, INF_PUSH},
    {"only the midfielder behind, far half: recover", 400, 440, 300, 60, INF_PUSH, INF_RECOVER},
    {"only the midfielder behind, near half: pass", 300, 340, 200, 60, INF_PUSH, INF_PASS},
    {"only the keeper behind, far half: return", 400, 500, 450, 60, INF_PUSH, INF_RETURN},
    {"only the keeper behind, near half: danger", 300, 500, 450, 60, INF_PUSH, INF_DANGER},
    {"attacker behind, midfielder not: danger", 300, 310, 350, 60, INF_PUSH, INF_DANGER},
    {"nobody behind: as it was", 50, 300, 100, 60, INF_RETURN, INF_RETURN},
    {"nobody behind, another one: as it was", 50, 300, 100, 60, INF_PASS, INF_PASS},
};

static void run_phase(void **state) {
  const phase *p = *state;
  inf_state s;
  inf_init(&s);
  s.phase = p->before;
  s.role_timer_s = 1; // roles stay: 0 attacker, 1 midfielder, 2 keeper
  vs_point robot[] = {{p->attacker_x, 100}, {p->midfielder_x, 200}, {p->keeper_x, 240}};
  inf_input in = input_of((vs_point){p->ball_x, 400}, robot, 1.0 / 30);
  double out[VS_TEAM_SIZE][2];
  inf_tick(&s, &in, out);
  assert_int_equal(s.phase, p->after);
}

// Chosen at the first tick; four ticks of 0.25 s run the second down; the next one chooses again.
static void roles_are_kept_for_a_second(void **state) {
  (void)state;
  inf_state s;
  inf_init(&s);
  const vs_point first[] = {{300, 240}, {200, 100}, {60, 240}}, later[] = {{100, 240}, {300, 240}, {60, 240}};
  inf_input in = input_of((vs_point){400, 240}, first, 0.25);
  double out[VS_TEAM_SIZE][2];
  inf_tick(&s, &in, out);
  assert_int_equal(s.role[INF_ATTACKER], 0);
  in = input_of((vs_point){400, 240}, later, 0.25);
  for (int tick = 1; tick <= 4; tick++) {
    inf_tick(&s, &in, out);
    assert_int_equal(s.role[INF_ATTACKER], 0);
  }
  inf_tick(&s, &in, out);
  assert_int_equal(s.role[INF_ATTACKER], 1);
}

static void match_starts_in_push_with_a_positive_sign_and_rear_first(void **state) {
  (void)state;
  inf_state s;
  inf_init(&s);
  assert_int_equal(s.phase, INF_PUSH);
  assert_near(s.unlock_sign, 1, 0);
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_int_equal(s.robot[i].front, -1);
}

int main(void) {
  const struct CMUnitTest others[] = {
      cmocka_unit_test(roles_are_kept_for_a_second),
      cmocka_unit_test(match_starts_in_push_with_a_positive_sign_and_rear_first),
  };
  int failed = RUN_ROWS("kick", kicks, run_kick);
  failed += RUN_ROWS("roles", choices, run_choice);
  failed += RUN_ROWS("states", phases, run_phase);
  return failed + cmocka_run_group_tests(others, NULL, NULL);
}
