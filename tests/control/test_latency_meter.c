// src/control/latency_meter.c, on the simulator, which says how late commands act.
#include <math.h>

#include "assert_near.h"
#include "vsss/env.h"
#include "vsss/latency_meter.h"

typedef struct answers {
  double first_s, last_s; // NAN: none
  double first_after_s;
  int count;
} answers;

// Blue plays for so long with this latency; a kick-off now and then as the referee says.
static answers measure(const char *player, double latency_s, double jitter_s, double seconds) {
  vs_model_def model_def = vs_model_def_default(VS_DRIVE_CONTACT);
  vs_model *model;
  vs_env *env;
  vs_latency_meter *meter;
  assert_ok(vs_model_load(&model_def, &model, err));
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = player;
  def.player[VS_YELLOW] = "inf:";
  def.realism.latency_s = (vs_range){latency_s, latency_s};
  def.realism.latency_jitter_s = (vs_range){jitter_s, jitter_s};
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 5, err));
  assert_ok(vs_latency_meter_new(VS_BLUE, &meter, err));
  answers a = {NAN, NAN, NAN, 0};
  for (int frame = 0; frame < (int)(seconds * VS_CAMERA_HZ) && !vs_env_over(env); frame++) {
    vs_world seen;
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
    double answer_s;
    vs_env_measured(env, &seen);
    if (vs_latency_meter_see(meter, &seen, &answer_s)) {
      if (a.count++ == 0) {
        a.first_s = answer_s;
        a.first_after_s = (double)frame / VS_CAMERA_HZ;
      }
      a.last_s = answer_s;
    }
    assert_ok(vs_env_frame(env, NULL, err));
    vs_env_wheels(env, wheels);
    vs_latency_meter_sent(meter, seen.time_us, wheels[VS_BLUE]);
  }
  print_message("%-8s %3.0f ms: first %5.1f after %4.1f s, last %5.1f ms of %d\n", player, 1e3 * latency_s,
                1e3 * a.first_s, a.first_after_s, 1e3 * a.last_s, a.count);
  vs_latency_meter_free(meter);
  vs_env_free(env);
  vs_model_free(model);
  return a;
}

static void the_latency_of_robots_at_play_is_found(void **state) {
  (void)state;
  static const struct {
    const char *player;
    double latency_s;
  } match[] = {{"emc:", 0}, {"emc:", 0.0333}, {"inf:", 0.0333}, {"inf:", 0.067}, {"random:", 0.1}, {"emc:", 0.15}};
  for (size_t i = 0; i < sizeof match / sizeof *match; i++) {
    answers a = measure(match[i].player, match[i].latency_s, 0, 30);
    assert_true(a.count > 0);
    assert_true(a.first_after_s < 15);
    assert_near(a.first_s, match[i].latency_s, 0.020);
    assert_near(a.last_s, match[i].latency_s, 0.012);
  }
}

static void jitter_of_a_third_of_a_frame_does_no_harm(void **state) {
  (void)state;
  assert_near(measure("emc:", 0.067, 0.01, 30).last_s, 0.067, 0.012);
}

static void robots_that_stand_tell_nothing(void **state) {
  (void)state;
  assert_int_equal(measure("zero:", 0.067, 0, 20).count, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_latency_of_robots_at_play_is_found),
      cmocka_unit_test(jitter_of_a_third_of_a_frame_does_no_harm),
      cmocka_unit_test(robots_that_stand_tell_nothing),
  };
  return cmocka_run_group_tests_name("control/latency_meter", tests, NULL, NULL);
}
