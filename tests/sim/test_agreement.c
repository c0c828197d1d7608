// Tests src/sim/drive.c against the contact drive: a second of each trace in tests/data/drive_traces.txt on both drives.
// make bench prints the table (tests/bench/bench_sim.c).
#include "sim/arena.h"
#include "sim/traces.h"

static trace traces[TRACE_MOST];
static int count;

static void load_traces(void) {
  vs_error err = {0};
  if (!count) count = traces_load(traces, &err);
  if (count < 0) fail_msg("%s", err.text);
}

static void medians_are_within_15_mm_5_degrees_and_30_mm_of_the_ball(void **state) {
  (void)state;
  static trace_run run[2];
  static trace_errors all;
  load_traces();
  for (int i = 0; i < count; i++) {
    if (traces[i].kind == TRACE_MELEE) continue;
    for (int drive = 0; drive < 2; drive++) assert_ok(trace_play(arena_sim[drive], &traces[i], &run[drive], err));
    trace_add_errors(&all, &traces[i], &run[VS_DRIVE_CONTACT], &run[VS_DRIVE_PLANAR]);
  }
  assert_true(all.robots > 60 && all.balls > 8);
  assert_true(trace_quantile(all.position_m, all.robots, 0.5) < 0.015);
  assert_true(trace_quantile(all.heading_rad, all.robots, 0.5) < 5 * VS_PI / 180);
  assert_true(trace_quantile(all.ball_m, all.balls, 0.5) < 0.030);
}

static void traces_cover_every_kind(void **state) {
  (void)state;
  load_traces();
  int seen[TRACE_KINDS] = {0};
  for (int i = 0; i < count; i++) seen[traces[i].kind]++;
  for (int k = 0; k < TRACE_KINDS; k++) assert_true(seen[k] >= 6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(medians_are_within_15_mm_5_degrees_and_30_mm_of_the_ball),
      cmocka_unit_test(traces_cover_every_kind),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
