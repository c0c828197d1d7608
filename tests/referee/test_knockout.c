// Tests src/referee/knockout.c: extra time, shoot-out, who wins.
#include "referee/referee_world.h"

#include <string.h>

static vs_referee match_of(vs_rules rules, bool knockout) {
  vs_referee_def def = vs_referee_def_default(rules);
  def.knockout = knockout;
  vs_referee r;
  assert_ok(vs_referee_init(&r, &def, err));
  return r;
}

// The next frame is the last of the time played so far.
static vs_event step_at(vs_referee *r, double time_s, const vs_world *w) {
  r->game.time_s = time_s - FRAME_S;
  return vs_referee_step(r, w, FRAME_S);
}

static void extra_time_is_as_long_as_the_rules_say(void **state) {
  (void)state;
  static const double extra_half_s[] = {36, 180, 120, 120}, kick_s[] = {10, 10, 30, 10};
  for (int rules = VS_RULES_PAPER; rules <= VS_RULES_LARC_2026; rules++) {
    vs_referee_def def = vs_referee_def_default((vs_rules)rules);
    assert_false(def.knockout);
    assert_near(def.extra_half_s, extra_half_s[rules], 0);
    assert_near(def.kick_s, kick_s[rules], 0);
    vs_referee_def_lasts(&def, def.duration_s / 4);
    assert_near(def.extra_half_s, extra_half_s[rules] / 4, 1e-12);
  }
}

static void a_tie_goes_to_extra_time_and_then_to_the_shoot_out(void **state) {
  (void)state;
  for (int rules = VS_RULES_PAPER; rules <= VS_RULES_LARC_2026; rules++) {
    vs_world w = quiet_world(0.1, 0);
    vs_referee r = match_of((vs_rules)rules, true);
    double end_s = r.def.duration_s, extra_s = r.def.extra_half_s;
    if (r.def.halves == 2) assert_event(step_at(&r, end_s / 2, &w), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
    assert_event(step_at(&r, end_s, &w), VS_EVENT_EXTRA_TIME, VS_BLUE, 0);
    assert_int_equal(r.half, VS_HALF_EXTRA_1);
    assert_near(r.game.duration_s, end_s + 2 * extra_s, 0);
    vs_referee_restarted(&r, &w);
    assert_event(step_at(&r, end_s + extra_s, &w), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
    assert_event(step_at(&r, end_s + 2 * extra_s, &w), VS_EVENT_SHOOT_OUT, VS_BLUE, 0);
    assert_int_equal(r.half, VS_HALF_SHOOT_OUT);
    assert_false(r.over);
    assert_int_equal(vs_referee_winner(&r), -1);
    assert_true(vs_referee_ok(&r, &r.def));
  }
}

static void without_knockout_a_tie_is_the_end_and_a_winner_needs_none(void **state) {
  (void)state;
  for (int knockout = 0; knockout < 2; knockout++) {
    vs_world w = quiet_world(0.1, 0);
    vs_referee r = match_of(VS_RULES_PAPER, knockout);
    r.game.score[VS_YELLOW] = knockout;
    assert_int_equal(step_at(&r, 120, &w).kind, VS_EVENT_END);
    assert_true(r.over);
    assert_int_equal(vs_referee_winner(&r), knockout ? VS_YELLOW : -1);
  }
}

// A goal in the last frame of regular time that ties the match does not end it; one that wins extra time does.
static void a_goal_in_the_last_frame_counts(void **state) {
  (void)state;
  vs_world play = quiet_world(0.1, 0), goal = quiet_world(0.8, 0);
  vs_referee r = match_of(VS_RULES_PAPER, true);
  r.game.score[VS_YELLOW] = 1;
  assert_event(step_at(&r, 120, &goal), VS_EVENT_GOAL, VS_BLUE, 0);
  assert_false(r.over);
  assert_event(vs_referee_step(&r, &play, FRAME_S), VS_EVENT_EXTRA_TIME, VS_BLUE, 0);
  assert_event(step_at(&r, 130, &goal), VS_EVENT_GOAL, VS_BLUE, 0);
  assert_false(r.over); // no golden goal
  assert_event(step_at(&r, 156, &play), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
  assert_event(step_at(&r, 192, &goal), VS_EVENT_GOAL, VS_BLUE, 0);
  assert_true(r.over);
  assert_int_equal(vs_referee_winner(&r), VS_BLUE);
}

static vs_referee shoot_out(void) {
  vs_world w = quiet_world(0.375, 0);
  vs_referee r = match_of(VS_RULES_LARC_2026, true);
  r.half = VS_HALF_EXTRA_2;
  assert_event(step_at(&r, r.def.duration_s + 2 * r.def.extra_half_s, &w), VS_EVENT_SHOOT_OUT, VS_BLUE, 0);
  return r;
}

// Kicks in order, 'x' scored, '.' not: of which team the last event is, and of what kind.
static vs_event kick(vs_referee *r, const char *kicks) {
  vs_event event = {.kind = VS_EVENT_NONE};
  for (; *kicks; kicks++) {
    vs_world w = quiet_world(0.4, 0), goal = quiet_world(r->kick_off == VS_BLUE ? 0.8 : -0.8, 0);
    double took_s = 0;
    assert_false(r->over);
    if (*kicks == 'x')
      event = vs_referee_step(r, &goal, FRAME_S);
    else
      event = wait_for_event(r, &w, 20, &took_s);
    if (*kicks == '.') assert_near(took_s, 10, FRAME_S);
  }
  return event;
}

static void three_kicks_each_in_turn_then_pairs_until_one_is_ahead(void **state) {
  (void)state;
  static const struct {
    const char *kicks;
    int winner; // -1: it goes on
  } row[] = {
      {"x", -1},
      {"x.", -1},
      {"x.x", -1},
      {"x.x.", VS_BLUE}, // 2 ahead with 1 left
      {".x.x", VS_YELLOW},
      {"xxxxx", -1},
      {"xxxxxx", -1},
      {"xxxxx.", VS_BLUE},
      {"xxxxxx.x", VS_YELLOW},
      {"......x", -1},
      {"......x.", VS_BLUE},
      {"......xx.", -1},
      {"......xx.x", VS_YELLOW},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_referee r = shoot_out();
    vs_event event = kick(&r, row[k].kicks);
    size_t n = strlen(row[k].kicks);
    assert_int_equal(vs_referee_winner(&r), row[k].winner);
    assert_int_equal(r.over, row[k].winner >= 0);
    if (r.over)
      assert_int_equal(event.kind, VS_EVENT_END);
    else
      assert_event(event, VS_EVENT_SHOOT_OUT, n % 2 ? VS_YELLOW : VS_BLUE, 0);
    assert_int_equal(r.game.score[VS_BLUE] + r.game.score[VS_YELLOW], 0); // goals of the match only
    assert_true(vs_referee_ok(&r, &r.def));
  }
}

// Into the own goal, or over a wall.
static void a_kick_that_goes_elsewhere_is_over_and_not_scored(void **state) {
  (void)state;
  for (int over_wall = 0; over_wall < 2; over_wall++) {
    vs_referee r = shoot_out();
    vs_world w = over_wall ? quiet_world(0.3, 0.7) : quiet_world(-0.8, 0);
    assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_SHOOT_OUT, VS_YELLOW, 0);
    assert_int_equal(r.kicks[VS_BLUE], 1);
    assert_int_equal(r.kicks_scored[VS_BLUE] + r.kicks_scored[VS_YELLOW], 0);
  }
}

// 20 each without a goal; the coin falls on both sides over worlds that differ, and the same way for the same one.
static void a_coin_ends_what_nobody_wins(void **state) {
  (void)state;
  int won[VS_TEAMS] = {0, 0};
  for (int k = 0; k < 64; k++) {
    int winner[2];
    for (int again = 0; again < 2; again++) {
      vs_referee r = shoot_out();
      for (int n = 0; n < 2 * VS_SHOOT_OUT_MOST; n++) {
        vs_world w = quiet_world(0.3 + 0.001 * k, 0.7);
        assert_false(r.over);
        vs_referee_step(&r, &w, FRAME_S);
      }
      assert_true(r.over);
      assert_true(r.lot > 0);
      winner[again] = vs_referee_winner(&r);
    }
    assert_int_equal(winner[0], winner[1]);
    won[winner[0]]++;
  }
  assert_true(won[VS_BLUE] > 15 && won[VS_YELLOW] > 15);
}

static void a_shoot_outs_kick_is_placed_as_a_penalty(void **state) {
  (void)state;
  vs_world before = quiet_world(0, 0), kick, penalty;
  for (int team = 0; team < VS_TEAMS; team++) {
    const vs_event a = {.kind = VS_EVENT_SHOOT_OUT, .team = (vs_team)team},
                   b = {.kind = VS_EVENT_PENALTY, .team = (vs_team)team};
    vs_place(VS_PLACEMENT_PAPER, &a, &before, NULL, &kick);
    vs_place(VS_PLACEMENT_PAPER, &b, &before, NULL, &penalty);
    assert_memory_equal(&kick, &penalty, sizeof kick);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(extra_time_is_as_long_as_the_rules_say),
      cmocka_unit_test(a_tie_goes_to_extra_time_and_then_to_the_shoot_out),
      cmocka_unit_test(without_knockout_a_tie_is_the_end_and_a_winner_needs_none),
      cmocka_unit_test(a_goal_in_the_last_frame_counts),
      cmocka_unit_test(three_kicks_each_in_turn_then_pairs_until_one_is_ahead),
      cmocka_unit_test(a_kick_that_goes_elsewhere_is_over_and_not_scored),
      cmocka_unit_test(a_coin_ends_what_nobody_wins),
      cmocka_unit_test(a_shoot_outs_kick_is_placed_as_a_penalty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
