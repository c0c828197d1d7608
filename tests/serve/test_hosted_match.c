// Tests src/serve/hosted_match.c: the pauses of a restart, placements, replacements, commands from outside.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/hosted_match.h"

static vs_model *model;

static int open_model(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_PLANAR);
  def.frame_hz = 60;
  def.substeps_per_frame = 3;
  vs_error err = {0};
  return vs_model_load(&def, &model, &err) == VS_OK ? 0 : -1;
}

static int close_model(void **state) {
  (void)state;
  vs_model_free(model);
  return 0;
}

static vs_hosted *make(vs_referee_mode mode, double pause_s, const char *blue, const char *yellow) {
  vs_hosted_def def = {.model = model,
                       .player = {blue, yellow},
                       .referee = vs_referee_def_default(VS_RULES_LEAGUE),
                       .mode = mode,
                       .pause_s = pause_s,
                       .seed = 1};
  assert_ok(vs_robot_preset_find("firasim", &def.robot, err));
  vs_hosted *match = NULL;
  assert_ok(vs_hosted_new(&def, &match, err));
  return match;
}

// Plays n frames; the calls of all of them in order.
static int frames(vs_hosted *match, int n, vs_ref_command *calls) {
  int count = 0;
  for (int k = 0; k < n; k++) {
    vs_hosted_said said;
    assert_ok(vs_hosted_frame(match, &said, err));
    for (int c = 0; c < said.calls; c++)
      if (calls) calls[count++] = said.call[c];
  }
  return count;
}

// 1 s of pause at 60 Hz: called at once, placed 60 frames later, in play after 60 more.
static void a_kick_off_is_called_placed_and_played(void **state) {
  (void)state;
  vs_hosted *match = make(VS_REFEREE_OWN, 1, NULL, NULL);
  assert_int_equal(frames(match, 100, NULL), 0);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_WAIT);
  vs_hosted_begin(match);
  vs_ref_command calls[8];
  assert_int_equal(frames(match, 59, calls), 1);
  assert_int_equal(calls[0].foul, VS_FOUL_KICKOFF);
  assert_int_equal(calls[0].team, VS_BLUE);
  assert_int_equal(calls[0].half, 1);
  assert_int_equal(frames(match, 1, calls), 1);
  assert_int_equal(calls[0].foul, VS_FOUL_STOP);
  assert_int_equal(frames(match, 59, calls), 0);
  assert_near(vs_hosted_game(match)->time_s, 0, 0); // the clock waits
  assert_int_equal(frames(match, 1, calls), 1);
  assert_int_equal(calls[0].foul, VS_FOUL_GAME_ON);
  frames(match, 30, NULL);
  assert_near(vs_hosted_game(match)->time_s, 0.5, 1e-9);
  vs_hosted_free(match);
}

static vs_ref_placement kick_off_placement(void) {
  return (vs_ref_placement){
      .team = VS_BLUE, .given = {true, true, true}, .pose = {{-0.7, 0.1, 0.5}, {-0.1, -0.05, 0}, {-0.5, 0.4, -1}}};
}

static void a_placement_is_taken_and_a_team_without_one_gets_the_defaults(void **state) {
  (void)state;
  vs_hosted *match = make(VS_REFEREE_OWN, 0.5, NULL, NULL);
  vs_hosted_begin(match);
  vs_ref_placement p = kick_off_placement();
  assert_ok(vs_hosted_place(match, &p, err));
  frames(match, 30, NULL);
  const vs_world *w = vs_hosted_world(match);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_STOPPED);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(w->robot[VS_BLUE][i].pose.x_m, p.pose[i].x_m, 1e-9);
    assert_near(w->robot[VS_BLUE][i].pose.theta_rad, p.pose[i].theta_rad, 1e-9);
  }
  assert_near(w->robot[VS_YELLOW][0].pose.x_m, 0.675, 1e-9);
  assert_near(w->robot[VS_YELLOW][1].pose.x_m, 0.2, 1e-9);
  vs_hosted_free(match);
}

static void an_illegal_placement_is_refused_with_the_robot(void **state) {
  (void)state;
  const struct {
    int robot;
    vs_pose pose;
    const char *why;
  } bad[] = {{2, {0.3, 0.2, 0}, "robot 2 at 0.300"},         // the other half
             {0, {-0.74, 0, 0}, "not inside the field"},     // in the wall
             {2, {-0.7, 0.12, 0}, "robots 0 and 2 overlap"}, // on the keeper
             {1, {-0.03, 0, 0}, "the ball's place"},
             {1, {-0.4, 0, 0}, "no robot stands where"}}; // nobody kicks off
  vs_hosted *match = make(VS_REFEREE_OWN, 1, NULL, NULL);
  vs_hosted_begin(match);
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    vs_ref_placement p = kick_off_placement();
    p.pose[bad[k].robot] = bad[k].pose;
    vs_error err = {0};
    assert_int_equal(vs_hosted_place(match, &p, &err), VS_FAIL);
    if (!strstr(err.text, bad[k].why)) fail_msg("'%s' lacks '%s'", err.text, bad[k].why);
  }
  frames(match, 60, NULL);
  assert_near(vs_hosted_world(match)->robot[VS_BLUE][1].pose.x_m, -0.2, 1e-9); // the default
  vs_hosted_free(match);
}

// Yellow drives to other legal places before the kick-off is placed, and stays there.
static void a_team_that_drove_to_legal_places_stays_there(void **state) {
  (void)state;
  vs_hosted *match = make(VS_REFEREE_OWN, 1, NULL, NULL);
  vs_hosted_begin(match);
  for (int i = 1; i < 3; i++) vs_hosted_command(match, VS_YELLOW, i, (vs_wheels){-15, -15}); // away from the middle
  frames(match, 40, NULL);
  for (int i = 1; i < 3; i++) vs_hosted_command(match, VS_YELLOW, i, (vs_wheels){0, 0});
  frames(match, 19, NULL);
  double before = vs_hosted_world(match)->robot[VS_YELLOW][1].pose.x_m;
  assert_true(before > 0.41);
  frames(match, 1, NULL);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_STOPPED);
  assert_near(vs_hosted_world(match)->robot[VS_YELLOW][1].pose.x_m, before, 0.01);
  vs_hosted_free(match);
}

static void replacements_are_for_matches_without_our_referee(void **state) {
  (void)state;
  vs_fira_packet p = {
      .places_ball = true, .ball = {.x_m = 0.3, .y_m = 0.2, .z_m = VS_BALL_RADIUS_M, .valid = true}, .robots = 1};
  p.place[0].team = VS_YELLOW;
  p.place[0].robot = 1;
  p.place[0].pose = (vs_pose){-0.2, 0.1, 1};
  const vs_referee_mode mode[] = {VS_REFEREE_OWN, VS_REFEREE_NONE, VS_REFEREE_EXTERNAL};
  for (int k = 0; k < 3; k++) {
    vs_hosted *match = make(mode[k], 1, NULL, NULL);
    assert_int_equal(vs_hosted_replace(match, &p), mode[k] != VS_REFEREE_OWN);
    const vs_world *w = vs_hosted_world(match);
    assert_near(w->ball.x_m, mode[k] == VS_REFEREE_OWN ? 0 : 0.3, 1e-9);
    assert_near(w->robot[VS_YELLOW][1].pose.x_m, mode[k] == VS_REFEREE_OWN ? 0.375 : -0.2, 1e-9);
    vs_hosted_free(match);
  }
}

// 2000 rad/s of a 2 cm wheel are far beyond 1.4 m/s; the last command holds; silence is counted, a local team is never
// silent and cannot be driven from outside.
static void commands_saturate_and_hold(void **state) {
  (void)state;
  vs_hosted *match = make(VS_REFEREE_NONE, 0, NULL, "zero:");
  assert_true(vs_hosted_command(match, VS_BLUE, 0, (vs_wheels){2000, 30}));
  assert_false(vs_hosted_command(match, VS_YELLOW, 0, (vs_wheels){30, 30}));
  frames(match, 45, NULL);
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
  vs_hosted_wheels(match, wheels);
  assert_near(wheels[VS_BLUE][0].left_radps, VS_WHEEL_LIMIT_RADPS, 1e-9);
  assert_near(wheels[VS_BLUE][0].right_radps, 20, 1e-9); // 30 x 0.02 / 0.03
  assert_near(wheels[VS_YELLOW][0].left_radps, 0, 0);
  assert_near(vs_hosted_silence_s(match, VS_BLUE), 0.75, 1e-9);
  assert_near(vs_hosted_silence_s(match, VS_YELLOW), 0, 0);
  vs_hosted_free(match);
}

static void a_goal_without_our_referee_counts_once(void **state) {
  (void)state;
  vs_hosted *match = make(VS_REFEREE_NONE, 0, NULL, NULL);
  vs_fira_packet p = {.places_ball = true, .ball = {.x_m = -0.8, .z_m = VS_BALL_RADIUS_M, .valid = true}};
  for (int goal = 1; goal <= 2; goal++) {
    p.ball.x_m = -0.8;
    vs_hosted_replace(match, &p);
    frames(match, 20, NULL);
    assert_int_equal(vs_hosted_game(match)->score[VS_YELLOW], goal);
    p.ball.x_m = 0;
    vs_hosted_replace(match, &p);
    frames(match, 2, NULL);
  }
  assert_int_equal(vs_hosted_game(match)->score[VS_BLUE], 0);
  vs_hosted_free(match);
}

// A transition a row: what the referee of the network says, and the phase it leads to.
static void an_external_referee_moves_the_match(void **state) {
  (void)state;
  const struct {
    vs_foul foul;
    vs_phase phase;
  } row[] = {{VS_FOUL_KICKOFF, VS_PHASE_CALLED},   {VS_FOUL_STOP, VS_PHASE_STOPPED},
             {VS_FOUL_GAME_ON, VS_PHASE_PLAY},     {VS_FOUL_FREE_BALL, VS_PHASE_CALLED},
             {VS_FOUL_GAME_ON, VS_PHASE_PLAY},     {VS_FOUL_PENALTY_KICK, VS_PHASE_CALLED},
             {VS_FOUL_STOP, VS_PHASE_STOPPED},     {VS_FOUL_GOAL_KICK, VS_PHASE_CALLED},
             {VS_FOUL_FREE_KICK, VS_PHASE_CALLED}, {VS_FOUL_GAME_ON, VS_PHASE_PLAY},
             {VS_FOUL_HALT, VS_PHASE_STOPPED}};
  vs_hosted *match = make(VS_REFEREE_EXTERNAL, 0, "emc:", NULL);
  vs_hosted_begin(match); // not ours to begin
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_WAIT);
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    const vs_ref_command call = {row[k].foul, -1, 0, (double)k, 1};
    vs_hosted_hear(match, &call);
    vs_hosted_hear(match, &call); // one of ten
    assert_int_equal(vs_hosted_phase(match), row[k].phase);
    frames(match, 30, NULL);
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
    vs_hosted_wheels(match, wheels);
    double moved = 0;
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      moved += fabs(wheels[VS_BLUE][i].left_radps) + fabs(wheels[VS_BLUE][i].right_radps);
    assert_true(row[k].phase == VS_PHASE_PLAY ? moved > 0 : moved == 0);
  }
  vs_hosted_free(match);
}

// LARC's rules against a team that keeps the ball moving: some robot of blue, which stands still, is sent off and stays beside
// the field whatever is commanded; play goes on. At half time, when the team sends no places, it is back.
static void idle_robots_are_sent_off_until_half_time_and_play_goes_on(void **state) {
  (void)state;
  vs_hosted_def def = {.model = model,
                       .player = {NULL, "emc22:"},
                       .referee = vs_referee_def_default(VS_RULES_LARC_2026),
                       .mode = VS_REFEREE_OWN,
                       .seed = 2};
  def.referee.duration_s = 80;
  def.referee.goal_difference_stop = 0;
  assert_ok(vs_robot_preset_find("firasim", &def.robot, err));
  vs_hosted *match = NULL;
  assert_ok(vs_hosted_new(&def, &match, err));
  vs_hosted_begin(match);
  vs_hosted_said said = {.event.kind = VS_EVENT_NONE};
  while (vs_hosted_game(match)->time_s < 39 && said.event.kind != VS_EVENT_SENT_OFF)
    assert_ok(vs_hosted_frame(match, &said, err));
  assert_int_equal(said.event.kind, VS_EVENT_SENT_OFF);
  assert_int_equal(said.event.team, VS_BLUE);
  assert_int_equal(said.calls, 0);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_PLAY);
  int off = -1;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (vs_hosted_world(match)->robot[VS_BLUE][i].pose.y_m > 0.9) off = i;
  assert_true(off >= 0);
  vs_pose beside = vs_world_beside(VS_3V3, VS_BLUE, off);
  vs_hosted_command(match, VS_BLUE, off, (vs_wheels){20, 20});
  while (vs_hosted_game(match)->time_s < 39.9) {
    assert_ok(vs_hosted_frame(match, &said, err));
    assert_near(vs_hosted_world(match)->robot[VS_BLUE][off].pose.x_m, beside.x_m, 1e-3);
    assert_near(vs_hosted_world(match)->robot[VS_BLUE][off].pose.y_m, beside.y_m, 1e-3);
  }
  while (vs_hosted_game(match)->time_s < 40.5) assert_ok(vs_hosted_frame(match, &said, err));
  assert_true(fabs(vs_hosted_world(match)->robot[VS_BLUE][off].pose.y_m) < 0.62);
  vs_hosted_free(match);
}

static int all_calls(vs_hosted *match, int n, vs_foul foul[], int team[], int most) {
  vs_ref_command calls[64];
  int count = 0;
  for (int k = 0; k < n; k++) {
    int said = frames(match, 1, calls);
    for (int c = 0; c < said && count < most; c++, count++) foul[count] = calls[c].foul, team[count] = calls[c].team;
  }
  return count;
}

// LARC's rules: blue drives between STOP and GAME ON. Yellow's free kick is called; as blue does it again, it is put back where it
// stood and play begins. By the league's rules nothing of that.
static void a_false_start_is_a_free_kick_and_the_next_is_put_back(void **state) {
  (void)state;
  for (int larc = 0; larc < 2; larc++) {
    vs_hosted_def def = {
        .model = model, .referee = vs_referee_def_default(larc ? VS_RULES_LARC_2026 : VS_RULES_LEAGUE), .pause_s = 1};
    assert_ok(vs_robot_preset_find("firasim", &def.robot, err));
    vs_hosted *match = NULL;
    assert_ok(vs_hosted_new(&def, &match, err));
    vs_hosted_begin(match);
    frames(match, 60, NULL);
    const vs_world *w = vs_hosted_world(match);
    for (int k = 0; k < 1 + larc; k++) {
      vs_ref_command calls[4];
      double x_m = w->robot[VS_BLUE][2].pose.x_m;
      assert_int_equal(vs_hosted_phase(match), VS_PHASE_STOPPED);
      vs_hosted_command(match, VS_BLUE, 2, (vs_wheels){-20, -20});
      frames(match, 59, NULL);
      vs_hosted_command(match, VS_BLUE, 2, (vs_wheels){0, 0});
      assert_true(w->robot[VS_BLUE][2].pose.x_m < x_m - 0.04);
      assert_int_equal(frames(match, 1, calls), 1);
      assert_int_equal(calls[0].foul, larc && k == 0 ? VS_FOUL_FREE_KICK : VS_FOUL_GAME_ON);
      if (calls[0].foul == VS_FOUL_FREE_KICK) {
        assert_int_equal(calls[0].team, VS_YELLOW);
        assert_int_equal(vs_hosted_game(match)->last_event.kind, VS_EVENT_FREE_KICK);
        frames(match, 60, NULL);
      } else if (larc) {
        assert_near(w->robot[VS_BLUE][2].pose.x_m, x_m, 1e-9);
      }
    }
    assert_int_equal(vs_hosted_phase(match), VS_PHASE_PLAY);
    vs_hosted_free(match);
  }
}

// A row for each set of rules: how many, how long; in between the foul is called anew, and the clock stands.
static void a_team_has_the_time_outs_of_its_rules(void **state) {
  (void)state;
  const struct {
    vs_rules rules;
    int number;
    double length_s;
  } row[] = {
      {VS_RULES_PAPER, 0, 0}, {VS_RULES_LEAGUE, 2, 120}, {VS_RULES_SERIE_A_2023, 2, 180}, {VS_RULES_LARC_2026, 2, 180}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_hosted_def def = {.model = model, .referee = vs_referee_def_default(row[k].rules), .pause_s = 1};
    assert_ok(vs_robot_preset_find("firasim", &def.robot, err));
    vs_hosted *match = NULL;
    assert_ok(vs_hosted_new(&def, &match, err));
    vs_hosted_begin(match);
    frames(match, 30, NULL); // half of the pause between call and STOP
    vs_error why = {0};
    for (int n = 1; n <= row[k].number; n++) {
      vs_foul foul[4];
      int team[4];
      assert_ok(vs_hosted_time_out(match, VS_YELLOW, err));
      assert_int_equal(vs_hosted_phase(match), VS_PHASE_TIME_OUT);
      assert_int_equal(vs_hosted_time_out(match, VS_YELLOW, &why), VS_FAIL); // it has one
      assert_int_equal(all_calls(match, (int)(row[k].length_s * 60) - 1, foul, team, 4), 1);
      assert_int_equal(foul[0], VS_FOUL_HALT);
      assert_int_equal(team[0], VS_YELLOW);
      assert_int_equal(vs_hosted_phase(match), VS_PHASE_TIME_OUT);
      assert_int_equal(all_calls(match, 1, foul, team, 4), 1);
      assert_int_equal(foul[0], VS_FOUL_KICKOFF);
      assert_int_equal(team[0], VS_BLUE);
      assert_int_equal(vs_hosted_phase(match), VS_PHASE_CALLED);
      assert_int_equal(vs_hosted_time_outs_taken(match, VS_YELLOW), n);
    }
    assert_int_equal(vs_hosted_time_out(match, VS_YELLOW, &why), VS_FAIL);
    char text[32];
    snprintf(text, sizeof text, "%d by these rules", row[k].number);
    if (!strstr(why.text, text)) fail_msg("'%s' lacks '%s'", why.text, text);
    assert_int_equal(vs_hosted_time_outs_taken(match, VS_BLUE), 0); // the other team's are its own
    assert_near(vs_hosted_game(match)->time_s, 0, 0);
    vs_hosted_free(match);
  }
}

// Asked for in play, by both: the goal comes first, then blue's, which it ends after a second, then yellow's, then the kick-off.
static void a_time_out_waits_for_play_to_stop_and_the_team_may_end_it(void **state) {
  (void)state;
  vs_foul foul[8];
  int team[8];
  vs_error why = {0};
  vs_hosted *match = make(VS_REFEREE_OWN, 0.5, NULL, NULL);
  assert_int_equal(vs_hosted_time_out(match, VS_BLUE, &why), VS_FAIL); // not begun
  vs_hosted_begin(match);
  frames(match, 90, NULL);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_PLAY);
  assert_ok(vs_hosted_time_out(match, VS_YELLOW, err));
  assert_ok(vs_hosted_time_out(match, VS_BLUE, err));
  assert_int_equal(vs_hosted_time_out(match, VS_BLUE, &why), VS_FAIL);
  assert_false(vs_hosted_ready(match, VS_BLUE)); // it has not begun
  frames(match, 30, NULL);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_PLAY);
  // Nobody moves: by the league's rules a free ball after 5 s without motion.
  while (vs_hosted_phase(match) == VS_PHASE_PLAY) frames(match, 1, NULL);
  assert_int_equal(vs_hosted_phase(match), VS_PHASE_TIME_OUT);
  double time_s = vs_hosted_game(match)->time_s;
  assert_int_equal(vs_hosted_call(match)->team, VS_BLUE);
  frames(match, 60, NULL);
  assert_false(vs_hosted_ready(match, VS_YELLOW)); // blue's
  assert_true(vs_hosted_ready(match, VS_BLUE));
  assert_int_equal(all_calls(match, 120 * 60 - 1, foul, team, 8), 1);
  assert_int_equal(foul[0], VS_FOUL_HALT);
  assert_int_equal(team[0], VS_YELLOW);
  assert_int_equal(all_calls(match, 1, foul, team, 8), 1);
  assert_int_equal(foul[0], VS_FOUL_FREE_BALL);
  assert_near(vs_hosted_game(match)->time_s, time_s, 0);
  assert_int_equal(all_calls(match, 60, foul, team, 8), 2);
  assert_int_equal(foul[0], VS_FOUL_STOP);
  assert_int_equal(foul[1], VS_FOUL_GAME_ON);
  vs_hosted_free(match);
  match = make(VS_REFEREE_EXTERNAL, 0.5, NULL, NULL);
  assert_int_equal(vs_hosted_time_out(match, VS_BLUE, &why), VS_FAIL); // not ours to give
  vs_hosted_free(match);
}

static void the_same_commands_give_the_same_match(void **state) {
  (void)state;
  uint64_t hash[2];
  for (int k = 0; k < 2; k++) {
    vs_hosted *match = make(VS_REFEREE_OWN, 0, "emc:", "inf:");
    vs_hosted_begin(match);
    frames(match, 600, NULL);
    assert_true(vs_hosted_game(match)->time_s > 9);
    hash[k] = vs_hosted_hash(match);
    vs_hosted_free(match);
  }
  assert_true(hash[0] == hash[1]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_kick_off_is_called_placed_and_played),
      cmocka_unit_test(a_placement_is_taken_and_a_team_without_one_gets_the_defaults),
      cmocka_unit_test(an_illegal_placement_is_refused_with_the_robot),
      cmocka_unit_test(a_team_that_drove_to_legal_places_stays_there),
      cmocka_unit_test(replacements_are_for_matches_without_our_referee),
      cmocka_unit_test(commands_saturate_and_hold),
      cmocka_unit_test(a_goal_without_our_referee_counts_once),
      cmocka_unit_test(an_external_referee_moves_the_match),
      cmocka_unit_test(idle_robots_are_sent_off_until_half_time_and_play_goes_on),
      cmocka_unit_test(a_false_start_is_a_free_kick_and_the_next_is_put_back),
      cmocka_unit_test(a_team_has_the_time_outs_of_its_rules),
      cmocka_unit_test(a_time_out_waits_for_play_to_stop_and_the_team_may_end_it),
      cmocka_unit_test(the_same_commands_give_the_same_match),
  };
  return cmocka_run_group_tests(tests, open_model, close_model);
}
