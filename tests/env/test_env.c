// src/env/env.c
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "planar_model.h"
#include "vsss/env.h"
#include "vsss/geom.h"

static vs_env *new_env(const char *blue, const char *yellow) {
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = blue;
  def.player[VS_YELLOW] = yellow;
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  return env;
}

static void play_frames(vs_env *env, int frames) {
  for (int i = 0; i < frames && !vs_env_over(env); i++) assert_ok(vs_env_frame(env, NULL, err));
}

static uint64_t hash_of(vs_env *env, uint64_t seed, int frames) {
  assert_ok(vs_env_reset(env, seed, err));
  play_frames(env, frames);
  return vs_env_hash(env);
}

static void put_ball(vs_env *env, double x_m, double y_m) {
  vs_world world;
  vs_env_truth(env, &world);
  world.ball.x_m = x_m;
  world.ball.y_m = y_m;
  vs_sim_place(vs_env_sim(env), &world);
}

// On both drives: what one match leaves behind must not reach the next.
static void same_seed_gives_the_same_match_and_another_seed_another(void **state) {
  (void)state;
  vs_model *planar = model;
  for (int drive = VS_DRIVE_CONTACT; drive <= VS_DRIVE_PLANAR; drive++) {
    vs_model_def def = vs_model_def_default((vs_drive)drive);
    assert_ok(vs_model_load(&def, &model, err));
    vs_env *env = new_env("emc:", "random:"), *other = new_env("emc:", "random:");
    uint64_t first = hash_of(env, 7, 150), again = hash_of(env, 7, 150);
    assert_int_equal(first, again);
    assert_int_equal(first, hash_of(other, 7, 150));
    assert_int_not_equal(first, hash_of(env, 8, 150));
    vs_env_free(env);
    vs_env_free(other);
    vs_model_free(model);
  }
  model = planar;
}

// Two random players of one match draw from streams of their own.
static void both_teams_players_have_seeds_of_their_own(void **state) {
  (void)state;
  vs_env *env = new_env("random:", "random:");
  for (uint64_t seed = 0; seed < 20; seed++) {
    assert_ok(vs_env_reset(env, seed, err));
    play_frames(env, 1);
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
    vs_env_wheels(env, wheels);
    assert_true(memcmp(wheels[VS_BLUE], wheels[VS_YELLOW], sizeof wheels[VS_BLUE]) != 0);
  }
  vs_env_free(env);
}

// League rules, halves of one second: after the whistle the ball is back in the middle, at rest.
static void half_time_puts_everything_back(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = def.player[VS_YELLOW] = "zero:";
  def.referee = vs_referee_def_default(VS_RULES_LEAGUE);
  def.referee.duration_s = 2;
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 1, err));
  put_ball(env, 0.3, 0.2);
  vs_event event = {.kind = VS_EVENT_NONE};
  while (event.kind != VS_EVENT_HALF_TIME) {
    assert_false(vs_env_over(env));
    assert_ok(vs_env_frame(env, &event, err));
  }
  vs_world world;
  vs_env_truth(env, &world);
  assert_near(world.ball.x_m, 0.0, 1e-9);
  assert_near(world.ball.y_m, 0.0, 1e-9);
  vs_env_free(env);
}

// Everybody stands still: by LARC's rules all but the keepers are sent off after 20 s. They stand beside the field, teams
// see them parked and lost, and a snapshot of then goes on bit for bit; at half time they are back.
static void robots_that_are_sent_off_wait_beside_the_field_until_half_time(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = def.player[VS_YELLOW] = "zero:";
  def.referee = vs_referee_def_default(VS_RULES_LARC_2026);
  def.referee.duration_s = 60;
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 1, err));
  vs_event event = {.kind = VS_EVENT_NONE};
  vs_world truth, seen;
  int sent_off = 0;
  for (int k = 0; k < 22 * VS_CAMERA_HZ; k++) {
    put_ball(env, k % 200 < 100 ? 0.02 : -0.02, 0.05); // no stalemate
    assert_ok(vs_env_frame(env, &event, err));
    sent_off += event.kind == VS_EVENT_SENT_OFF;
    if (event.kind == VS_EVENT_SENT_OFF) vs_env_truth(env, &truth);
  }
  assert_true(sent_off >= 1);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 1; i < VS_TEAM_SIZE; i++) {
      vs_pose beside = vs_world_beside(VS_3V3, (vs_team)t, i), parked = vs_world_parked(VS_3V3, (vs_team)t, i);
      assert_near(truth.robot[t][i].pose.x_m, beside.x_m, 1e-9);
      assert_near(truth.robot[t][i].pose.y_m, beside.y_m, 1e-9);
      vs_env_measured(env, &seen);
      assert_false(seen.robot[t][i].valid);
      assert_near(seen.robot[t][i].pose.y_m, parked.y_m, 0);
    }
  vs_env_truth(env, &truth); // still there two seconds later, at rest: walls do not push
  assert_near(truth.robot[VS_BLUE][1].pose.y_m, 0.95, 1e-3);
  assert_true(seen.robot[VS_BLUE][0].valid && seen.robot[VS_YELLOW][0].valid);
  void *snapshot = aligned_alloc(64, vs_env_state_size(env));
  vs_env_save(env, snapshot);
  play_frames(env, 100);
  uint64_t expected = vs_env_hash(env);
  assert_ok(vs_env_restore(env, snapshot, err));
  play_frames(env, 100);
  assert_int_equal(vs_env_hash(env), expected);
  free(snapshot);
  for (event.kind = VS_EVENT_NONE; event.kind != VS_EVENT_HALF_TIME;) assert_ok(vs_env_frame(env, &event, err));
  vs_env_truth(env, &truth);
  assert_near(truth.robot[VS_BLUE][1].pose.y_m, 0, 1e-9);
  vs_env_free(env);
}

// A player that writes down when it was called.
static struct {
  int calls;
  double first_dt_s, later_dt_s, time_s;
} probe;

static vs_status probe_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)state, (void)seed, (void)options, (void)err;
  memset(&probe, 0, sizeof probe);
  return VS_OK;
}

static void probe_step(void *state, const vs_world *world, const vs_game *game, double dt_s,
                       vs_wheels out[VS_TEAM_SIZE]) {
  (void)state, (void)world;
  if (probe.calls++ == 0)
    probe.first_dt_s = dt_s;
  else
    probe.later_dt_s = dt_s;
  probe.time_s = game->time_s;
  for (int i = 0; i < VS_TEAM_SIZE; i++) out[i] = (vs_wheels){0, 0};
}

static const vsss_player_api probe_api[2] = {
    {.version = VSSS_PLAYER_VERSION,
     .name = "probe",
     .rate_hz = 30,
     .state_size = 1,
     .init = probe_init,
     .step = probe_step},
    {.version = VSSS_PLAYER_VERSION,
     .name = "probe",
     .rate_hz = 10,
     .state_size = 1,
     .init = probe_init,
     .step = probe_step},
};

static vs_status open_probe(const char *rest, vs_player_given *out, vs_error *err) {
  (void)err;
  out->api = &probe_api[!strcmp(rest, "10")];
  return VS_OK;
}

// Two seconds are 60 frames: 60 calls at 30 Hz and 20 at 10 Hz, the last on frame 59 and frame 57.
static void players_are_called_at_their_own_rate_with_its_dt(void **state) {
  (void)state;
  vs_player_register("probe:", "for this test", open_probe);
  const struct {
    const char *uri;
    int calls;
    double dt_s, last_s;
  } row[] = {{"probe:30", 60, 1 / 30.0, 59 / 30.0}, {"probe:10", 20, 0.1, 57 / 30.0}};
  for (int i = 0; i < 2; i++) {
    vs_env *env = new_env("zero:", row[i].uri);
    play_frames(env, 60);
    assert_int_equal(probe.calls, row[i].calls);
    assert_near(probe.first_dt_s, row[i].dt_s, 1e-9);
    assert_near(probe.later_dt_s, row[i].dt_s, 1e-9);
    assert_near(probe.time_s, row[i].last_s, 1e-9);
    vs_env_free(env);
  }
}

static void a_step_is_three_frames_and_observes_what_it_measured(void **state) {
  (void)state;
  vs_env *env = new_env(NULL, "random:");
  assert_ok(vs_env_reset(env, 3, err));
  static float observation[VS_TEAM_SIZE * VS_OBS_SIZE];
  const float forward[6] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
  vs_env_result result;
  for (int i = 1; i <= 5; i++) {
    assert_ok(vs_env_set_action(env, VS_BLUE, forward, err));
    assert_ok(vs_env_step(env, &result, err));
    assert_near(vs_env_game(env)->time_s, 0.1 * i, 1e-9);
    for (int team = 0; team < VS_TEAMS; team++) {
      vs_env_observation(env, (vs_team)team, observation);
      vs_world measured, view;
      vs_env_measured(env, &measured);
      vs_world_for_team(&measured, (vs_team)team, &view);
      for (int robot = 0; robot < VS_TEAM_SIZE; robot++) {
        const float *newest = observation + robot * VS_OBS_SIZE + (VS_OBS_STACK - 1) * VS_OBS_FRAME;
        assert_near(newest[VS_OBS_OWN_XY], view.robot[VS_OWN][robot].pose.x_m / VS_OBS_SCALE_X_M, 1e-6);
        assert_near(newest[VS_OBS_BALL_XY], view.ball.x_m / VS_OBS_SCALE_X_M, 1e-6);
        assert_near(newest[VS_OBS_OWN_ACTION], vs_control_action(vs_env_control(env, (vs_team)team))[2 * robot], 1e-7);
      }
    }
  }
  float mean[6];
  vs_env_mean_action(env, VS_BLUE, mean);
  for (int k = 0; k < 6; k++) assert_near(mean[k], 0.5, 1e-7);
  vs_env_free(env);
}

static void a_goal_replaces_the_reward_and_restarts_play(void **state) {
  (void)state;
  vs_env *env = new_env("zero:", "zero:");
  assert_ok(vs_env_reset(env, 1, err));
  vs_env_result result;
  assert_ok(vs_env_step(env, &result, err));
  assert_true(result.terms[VS_BLUE][0][VS_REWARD_DISTANCE] < 0);
  put_ball(env, 0.80, 0.0); // behind blue's target line, 0.75 + 0.02135
  assert_ok(vs_env_step(env, &result, err));
  assert_int_equal(result.event.kind, VS_EVENT_GOAL);
  assert_int_equal(result.event.team, VS_BLUE);
  assert_false(result.over);
  assert_int_equal(vs_env_game(env)->score[VS_BLUE], 1);
  assert_near(vs_env_game(env)->time_s, 4 / 30.0, 1e-9); // the step ended with its first frame
  // 1 + (T - t)/T at t = 4/30 s of 120 s: 1.998889.
  for (int robot = 0; robot < VS_TEAM_SIZE; robot++) {
    assert_near(result.terms[VS_BLUE][robot][VS_REWARD_GOAL], 1.998889, 1e-5);
    assert_near(result.terms[VS_YELLOW][robot][VS_REWARD_GOAL], -1.998889, 1e-5);
    assert_near(result.terms[VS_BLUE][robot][VS_REWARD_SPEED], 0, 0);
    assert_near(result.terms[VS_BLUE][robot][VS_REWARD_DISTANCE], 0, 0);
  }
  vs_world truth, judged;
  vs_env_truth(env, &truth);
  vs_env_judged(env, &judged);
  assert_near(truth.ball.x_m, 0, 1e-9);
  assert_true(judged.ball.x_m > 0.77);
  // The first frame after the kick-off is a decision: the next step has its full three frames.
  assert_ok(vs_env_step(env, &result, err));
  assert_near(vs_env_game(env)->time_s, 7 / 30.0, 1e-9);
  // The ball rests in the centre: the jump of the placement earned nothing.
  assert_near(result.terms[VS_BLUE][0][VS_REWARD_PROGRESS], 0, 1e-3);
  vs_env_free(env);
}

static void two_defenders_and_the_ball_in_their_area_are_a_foul_of_theirs(void **state) {
  (void)state;
  vs_env *env = new_env("zero:", "zero:");
  assert_ok(vs_env_reset(env, 1, err));
  vs_world world;
  vs_env_truth(env, &world);
  world.robot[VS_YELLOW][0].pose = (vs_pose){0.68, 0.15, 0};
  world.robot[VS_YELLOW][1].pose = (vs_pose){0.68, -0.15, 0};
  world.ball.x_m = 0.68;
  world.ball.y_m = 0.0;
  vs_sim_place(vs_env_sim(env), &world);
  vs_env_result result;
  assert_ok(vs_env_step(env, &result, err));
  assert_int_equal(result.event.kind, VS_EVENT_PENALTY);
  assert_int_equal(result.event.team, VS_BLUE); // takes it
  assert_near(result.terms[VS_YELLOW][0][VS_REWARD_FOUL], -1, 1e-12);
  assert_near(result.terms[VS_BLUE][0][VS_REWARD_FOUL], 0, 1e-12);
  vs_env_truth(env, &world);
  assert_near(world.ball.x_m, 0.375, 1e-6);
  vs_env_free(env);
}

static void the_clock_and_the_first_goal_end_an_episode_differently(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.referee = vs_referee_def_training();
  def.referee.duration_s = 1.0;
  vs_env *env;
  vs_env_result result;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 5, err));
  for (int i = 0; i < 10; i++) {
    assert_false(vs_env_over(env));
    assert_ok(vs_env_step(env, &result, err));
  }
  assert_true(result.over);
  assert_true(result.time_limit);
  vs_error err = {0};
  assert_int_equal(vs_env_step(env, &result, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "over"));

  assert_ok(vs_env_reset(env, 6, err));
  put_ball(env, -0.80, 0.0);
  assert_ok(vs_env_step(env, &result, err));
  assert_true(result.over);
  assert_false(result.time_limit);
  assert_int_equal(vs_env_game(env)->score[VS_YELLOW], 1);
  vs_env_free(env);
}

// 0.1 s of latency are three frames.
static void a_team_with_a_radio_of_its_own_acts_at_once(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.realism.latency_s = (vs_range){0.1, 0.1};
  def.own_radio[VS_YELLOW] = true;
  vs_env *env;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 3, err));
  const float ahead[VS_TEAM_SIZE * VS_ACTION_SIZE] = {1, 1, 1, 1, 1, 1};
  vs_world start, now;
  vs_env_truth(env, &start);
  for (int t = 0; t < VS_TEAMS; t++) assert_ok(vs_env_set_action(env, (vs_team)t, ahead, err));
  int moved_after[VS_TEAMS] = {0};
  for (int frame = 1; frame <= 6; frame++) {
    play_frames(env, 1);
    vs_env_truth(env, &now);
    for (int t = 0; t < VS_TEAMS; t++) {
      const vs_pose *a = &start.robot[t][0].pose, *b = &now.robot[t][0].pose;
      if (!moved_after[t] && hypot(b->x_m - a->x_m, b->y_m - a->y_m) > 5e-4) moved_after[t] = frame;
    }
  }
  assert_int_equal(moved_after[VS_YELLOW], 1);
  assert_int_equal(moved_after[VS_BLUE], 4);
  vs_env_free(env);
}

// Blue never sees ball and opponents: what it observes is their places of unseen.h. What is measured, and the match, go on.
static void what_a_team_never_sees_is_told_as_never_seen_through_snapshots_too(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_YELLOW] = "random:";
  def.realism.never_seen_share = 1;
  vs_env *env, *other;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_new(&def, &other, err));
  assert_ok(vs_env_reset(env, 11, err));
  play_frames(env, 60);
  void *snapshot = aligned_alloc(64, vs_env_state_size(env));
  vs_env_save(env, snapshot);
  assert_ok(vs_env_restore(other, snapshot, err)); // which was never reset
  play_frames(env, 60);
  play_frames(other, 60);
  assert_int_equal(vs_env_hash(env), vs_env_hash(other));
  for (int k = 0; k < 2; k++) {
    static float observation[VS_TEAM_SIZE * VS_OBS_SIZE];
    vs_world measured;
    vs_env_measured(k ? other : env, &measured);
    assert_true(measured.ball.valid);
    vs_env_observation(k ? other : env, VS_BLUE, observation);
    const float *newest = observation + (VS_OBS_STACK - 1) * VS_OBS_FRAME;
    vs_pose own = measured.robot[VS_BLUE][0].pose;
    assert_near(newest[VS_OBS_OWN_XY], own.x_m / VS_OBS_SCALE_X_M, 1e-6); // own robots are seen
    assert_near(newest[VS_OBS_BALL_XY], 0, 0);
    assert_near(newest[VS_OBS_BALL_XY + 1], 0, 0);
  }
  free(snapshot);
  vs_env_free(env);
  vs_env_free(other);
}

static void a_snapshot_continues_bit_identically_here_and_elsewhere(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = "emc:";
  def.player[VS_YELLOW] = "random:";
  def.realism.latency_s = (vs_range){0.05, 0.05};
  def.realism.detection_loss = (vs_range){0.05, 0.05};
  def.realism.floor_friction_scale = (vs_range){0.7, 1.3};
  vs_env *env, *other;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_new(&def, &other, err));
  assert_ok(vs_env_reset(env, 11, err));
  assert_ok(vs_env_reset(other, 99, err));
  play_frames(env, 100);
  play_frames(other, 30);
  void *snapshot = aligned_alloc(64, vs_env_state_size(env));
  vs_env_save(env, snapshot);
  play_frames(env, 100);
  uint64_t expected = vs_env_hash(env);
  assert_ok(vs_env_restore(env, snapshot, err));
  play_frames(env, 100);
  assert_int_equal(vs_env_hash(env), expected);
  assert_ok(vs_env_restore(other, snapshot, err));
  play_frames(other, 100);
  assert_int_equal(vs_env_hash(other), expected);
  free(snapshot);
  vs_env_free(env);
  vs_env_free(other);
}

static void a_player_is_exchanged_at_the_next_reset(void **state) {
  (void)state;
  vs_env *env = new_env("zero:", "zero:"), *plain = new_env("random:", "zero:");
  assert_ok(vs_env_reset(env, 4, err));
  assert_ok(vs_env_set_player(env, VS_BLUE, "random:", err));
  uint64_t still = vs_env_hash(env);
  play_frames(env, 30);
  assert_string_equal(vs_player_uri(vs_control_player(vs_env_control(env, VS_BLUE))), "zero:");
  assert_int_not_equal(vs_env_hash(env), still);
  assert_int_equal(hash_of(env, 4, 60), hash_of(plain, 4, 60));
  vs_error err = {0};
  assert_int_equal(vs_env_set_player(env, VS_BLUE, "nobody:", &err), VS_USAGE);
  vs_env_free(env);
  vs_env_free(plain);
}

static void failures_name_seed_time_and_team(void **state) {
  (void)state;
  vs_env *env = new_env(NULL, "zero:");
  assert_ok(vs_env_reset(env, 42, err));
  play_frames(env, 15);
  const float action[6] = {0, 0, 0, NAN, 0, 0};
  vs_error err = {0};
  assert_int_equal(vs_env_set_action(env, VS_BLUE, action, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "seed 42 at 0.50 s"));
  assert_non_null(strstr(err.text, "blue"));

  ((mjData *)vs_sim_mjdata(vs_env_sim(env)))->qpos[0] = NAN;
  assert_int_equal(vs_env_frame(env, NULL, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "seed 42 at 0.50 s"));
  vs_env_free(env);

  vs_env_def def = vs_env_def_default(model);
  def.player[VS_YELLOW] = "nobody:";
  assert_int_equal(vs_env_new(&def, &env, &err), VS_USAGE);
}

// 4,000 training episodes: shares of the starts within 3 deviations (open play 0.35: 1,400 +- 91, penalties and free
// balls 0.1: 400 +- 57, the rest kick-offs), either team as often, and the still ball's clock over its whole range.
static void training_episodes_begin_as_their_shares_say(void **state) {
  (void)state;
  enum { EPISODES = 4000 };
  vs_env_def def = vs_env_def_default(model);
  def.referee = vs_referee_def_training();
  def.episode = (vs_episode_def){.open_play = 0.35,
                                 .penalty = 0.1,
                                 .free_ball = 0.1,
                                 .still_low_s = 2,
                                 .still_high_s = 10,
                                 .either_kicks_off = true};
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  int open = 0, penalty[VS_TEAMS] = {0}, free_ball = 0, kick_off = 0, rolling = 0;
  for (int i = 0; i < EPISODES; i++) {
    vs_world w;
    assert_ok(vs_env_reset(env, (uint64_t)i, err));
    vs_env_truth(env, &w);
    double x_m = w.ball.x_m, y_m = w.ball.y_m;
    if (w.ball.vx_mps != 0) rolling++;
    if (x_m == 0 && y_m == 0)
      kick_off++;
    else if (fabs(x_m) == 0.375 && y_m == 0)
      penalty[x_m < 0]++;
    else if (fabs(x_m) == 0.375 && fabs(y_m) == 0.4)
      free_ball++;
    else
      open++;
  }
  assert_in_range(open, 1400 - 91, 1400 + 91);
  assert_in_range(penalty[0] + penalty[1], 400 - 57, 400 + 57);
  assert_in_range(penalty[0], 150, 250);
  assert_in_range(free_ball, 400 - 57, 400 + 57);
  assert_int_equal(open + penalty[0] + penalty[1] + free_ball + kick_off, EPISODES);
  assert_in_range(rolling, open * 6 / 10, open * 7 / 10 + 40); // a third lies at a wall
  vs_env_free(env);
}

// The ball of a kick-off that nobody touches: free balls after the drawn time, between its limits, never the same.
static void the_still_balls_clock_is_drawn_for_each_episode(void **state) {
  (void)state;
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = def.player[VS_YELLOW] = "zero:";
  def.episode = (vs_episode_def){.still_low_s = 2, .still_high_s = 4};
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  double least_s = 10, most_s = 0;
  for (int i = 0; i < 40; i++) {
    vs_event event = {0};
    assert_ok(vs_env_reset(env, (uint64_t)i, err));
    while (event.kind != VS_EVENT_FREE_BALL) assert_ok(vs_env_frame(env, &event, err));
    least_s = fmin(least_s, event.time_s);
    most_s = fmax(most_s, event.time_s);
  }
  assert_true(least_s >= 1.96 && least_s < 2.5);
  assert_true(most_s > 3.5 && most_s <= 4.04);
  vs_env_free(env);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(both_teams_players_have_seeds_of_their_own),
      cmocka_unit_test(half_time_puts_everything_back),
      cmocka_unit_test(robots_that_are_sent_off_wait_beside_the_field_until_half_time),
      cmocka_unit_test(same_seed_gives_the_same_match_and_another_seed_another),
      cmocka_unit_test(players_are_called_at_their_own_rate_with_its_dt),
      cmocka_unit_test(a_step_is_three_frames_and_observes_what_it_measured),
      cmocka_unit_test(a_goal_replaces_the_reward_and_restarts_play),
      cmocka_unit_test(two_defenders_and_the_ball_in_their_area_are_a_foul_of_theirs),
      cmocka_unit_test(the_clock_and_the_first_goal_end_an_episode_differently),
      cmocka_unit_test(a_team_with_a_radio_of_its_own_acts_at_once),
      cmocka_unit_test(what_a_team_never_sees_is_told_as_never_seen_through_snapshots_too),
      cmocka_unit_test(a_snapshot_continues_bit_identically_here_and_elsewhere),
      cmocka_unit_test(a_player_is_exchanged_at_the_next_reset),
      cmocka_unit_test(failures_name_seed_time_and_team),
      cmocka_unit_test(training_episodes_begin_as_their_shares_say),
      cmocka_unit_test(the_still_balls_clock_is_drawn_for_each_episode),
  };
  return cmocka_run_group_tests_name("env/env", tests, load_model, free_model);
}
