// Tests src/sim/realism.c and deploy/config/realism.ini: reading ranges, refusing wrong ones, drawing an episode.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/paths.h"
#include "vsss/sensor_model.h"

static vs_status load(const char *text, vs_realism *out, vs_error *err) {
  char path[] = "/tmp/vsss_realism_XXXXXX";
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  assert_true(write(fd, text, strlen(text)) == (ssize_t)strlen(text));
  close(fd);
  memset(err, 0, sizeof *err);
  vs_status status = vs_realism_load(path, out, err);
  unlink(path);
  return status;
}

static void default_is_the_papers_noise_only(void **state) {
  (void)state;
  vs_realism r = vs_realism_default();
  assert_true(r.noise);
  assert_near(r.noise_scale.low, 1, 0);
  assert_near(r.noise_scale.high, 1, 0);
  assert_near(r.latency_s.high, 0, 0);
  vs_sim_params drawn = vs_realism_draw(&r, 77), nominal = vs_sim_params_default();
  drawn.push_seed = nominal.push_seed;
  assert_memory_equal(&drawn, &nominal, sizeof drawn);
}

// field.md, Ranges, the rows that it calls most valuable, and two others.
static void shipped_file_has_the_fields_ranges(void **state) {
  (void)state;
  char path[512];
  vs_realism r;
  assert_ok(vs_path_find("deploy/config/realism.ini", path, sizeof path, err));
  assert_ok(vs_realism_load(path, &r, err));
  assert_near(r.latency_s.low, 0.020, 0);
  assert_near(r.latency_s.high, 0.100, 0);
  assert_near(r.wheel_gain.low, 0.95, 0);
  assert_near(r.wheel_gain.high, 1.05, 0);
  assert_near(r.detection_loss.high, 0.05, 0);
  assert_near(r.radio_burst_frames.high, 3, 0);
  assert_near(r.ball_restitution.low, 0.4, 0);
  assert_near(r.robot_mass_scale.high, 1.15, 0);
  // Friction 0.6 to 1.1 of the nominal 0.9.
  assert_near(r.floor_friction_scale.low * 0.9, 0.6, 0.01);
  assert_near(r.floor_friction_scale.high * 0.9, 1.1, 0.01);
  assert_true(r.noise);
}

static void draws_lie_in_the_range_and_differ_by_seed_and_wheel(void **state) {
  (void)state;
  vs_realism r;
  vs_error err;
  assert_int_equal(load("[wheel_gain]\nlow = 0.9\nhigh = 1.1\n[motor_tau_s]\nlow = 0.01\nhigh = 0.05\n", &r, &err),
                   VS_OK);
  double lowest = 2, highest = 0;
  for (uint64_t seed = 0; seed < 200; seed++) {
    vs_sim_params p = vs_realism_draw(&r, seed), again = vs_realism_draw(&r, seed);
    assert_memory_equal(&p, &again, sizeof p);
    double gain = p.wheel_gain[VS_YELLOW][1][0];
    assert_true(gain >= 0.9 && gain <= 1.1 && p.motor_tau_s >= 0.01 && p.motor_tau_s <= 0.05);
    assert_true(gain != p.wheel_gain[VS_YELLOW][1][1]);
    lowest = fmin(lowest, gain);
    highest = fmax(highest, gain);
  }
  assert_true(lowest < 0.91 && highest > 1.09);
}

static void wrong_files_are_refused_with_line_and_reason(void **state) {
  (void)state;
  static const struct {
    const char *text, *says;
  } row[] = {
      {"[latency]\nlow = 0.1\n", ":2: unknown key 'latency.low' (did you mean 'latency_s.low'?)"},
      {"[latency_s]\nlow = soon\n", ":2: latency_s.low = soon: expected a number"},
      {"[latency_s]\nhigh = 3\n", "allowed are 0 to 0.2"},
      {"[latency_s]\nlow = 0.1\nhigh = 0.05\n", "[latency_s] low = 0.1 is above high = 0.05"},
      {"[latency_s]\nlow = 0.1\n", "[latency_s] low = 0.1 is above high = 0"},
      {"noise = loud\n", "expected true or false"},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    vs_realism r;
    vs_error err;
    assert_int_equal(load(row[i].text, &r, &err), VS_USAGE);
    if (!strstr(err.text, row[i].says)) fail_msg("'%s' does not contain '%s'", err.text, row[i].says);
  }
}

// A quarter of 4,000 episodes ideal: 1,000 +- 82 (3 deviations); an ideal one has the nominal robot and no delay.
static void the_ideal_share_of_the_episodes_has_only_the_papers_noise(void **state) {
  (void)state;
  vs_realism r;
  vs_error err;
  assert_int_equal(load("ideal_share = 0.25\n[latency_s]\nlow = 0.05\nhigh = 0.1\n[motor_tau_s]\nlow = 0.01\nhigh = "
                        "0.05\n",
                        &r, &err),
                   VS_OK);
  int ideal = 0;
  for (uint64_t seed = 0; seed < 4000; seed++) {
    vs_sensors sensors;
    vs_sensors_reset(&sensors, &r, seed);
    assert_true((sensors.latency_s == 0) == (sensors.params.motor_tau_s == 0));
    ideal += sensors.latency_s == 0;
  }
  assert_in_range(ideal, 1000 - 82, 1000 + 82);
  assert_int_equal(load("ideal_share = 1.5\n", &r, &err), VS_USAGE);
}

// A fifth of 4,000 episodes, for each of both teams' five opponents and ball: 800 +- 76 (3 deviations). Own robots are seen.
static void what_a_team_never_sees_is_drawn_for_each_object(void **state) {
  (void)state;
  vs_realism r;
  vs_error err;
  int count[VS_TEAMS][VS_SENSOR_OBJECTS] = {{0}}, ideal = 0;
  assert_int_equal(load("never_seen_share = 0.2\n", &r, &err), VS_OK);
  for (uint64_t seed = 0; seed < 4000; seed++) {
    bool never[VS_TEAMS][VS_SENSOR_OBJECTS];
    vs_sensors_never(&r, seed, never);
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_SENSOR_OBJECTS; i++) count[t][i] += never[t][i];
  }
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_SENSOR_OBJECTS; i++) {
      bool own = i / VS_TEAM_MOST == t && i < VS_TEAMS * VS_TEAM_MOST;
      assert_in_range(count[t][i], own ? 0 : 800 - 76, own ? 0 : 800 + 76);
    }
  assert_int_equal(load("never_seen_share = 1\nideal_share = 0.25\n", &r, &err), VS_OK);
  for (uint64_t seed = 0; seed < 4000; seed++) {
    bool never[VS_TEAMS][VS_SENSOR_OBJECTS];
    vs_sensors_never(&r, seed, never);
    ideal += !never[VS_BLUE][VS_SENSOR_OBJECTS - 1];
  }
  assert_in_range(ideal, 1000 - 82, 1000 + 82);
  assert_int_equal(load("never_seen_share = -0.1\n", &r, &err), VS_USAGE);
}

static void the_training_file_is_read_and_delays_up_to_110_ms(void **state) {
  (void)state;
  char path[512];
  vs_realism r;
  assert_ok(vs_path_find("deploy/config/training.ini", path, sizeof path, err));
  assert_ok(vs_realism_load(path, &r, err));
  assert_near(r.ideal_share, 0.3, 0);
  assert_near(r.latency_s.low, 0, 0);
  assert_near(r.latency_s.high, 0.11, 0);
}

static void the_file_of_the_delay_table_is_two_camera_frames_and_nothing_else(void **state) {
  (void)state;
  char path[512];
  vs_realism r, noise = {0};
  assert_ok(vs_path_find("deploy/config/delay67.ini", path, sizeof path, err));
  assert_ok(vs_realism_load(path, &r, err));
  assert_ok(load("noise = true\n", &noise, err));
  assert_near(r.latency_s.low, 0.067, 0);
  assert_near(r.latency_s.high, 0.067, 0);
  r.latency_s = noise.latency_s;
  assert_memory_equal(&r, &noise, sizeof r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(default_is_the_papers_noise_only),
      cmocka_unit_test(shipped_file_has_the_fields_ranges),
      cmocka_unit_test(draws_lie_in_the_range_and_differ_by_seed_and_wheel),
      cmocka_unit_test(the_ideal_share_of_the_episodes_has_only_the_papers_noise),
      cmocka_unit_test(what_a_team_never_sees_is_drawn_for_each_object),
      cmocka_unit_test(the_training_file_is_read_and_delays_up_to_110_ms),
      cmocka_unit_test(the_file_of_the_delay_table_is_two_camera_frames_and_nothing_else),
      cmocka_unit_test(wrong_files_are_refused_with_line_and_reason),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
