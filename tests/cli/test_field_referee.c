// Tests src/cli/field_referee.c and the tasks of src/field/orders.c through the real binary: a VSSReferee's calls move a
// team with a camera and a radio, which are in the test's hands. The robots in the picture never move, so that one that
// drives to its place never gets there.
#include "field_venue.h"
#include "test_folder.h"
#include "vsss/league_messages.h"
#include "vsss/udp.h"

static vs_udp referee;
static int offset;

static void call(vs_foul foul, int team, double timestamp_s) {
  const vs_ref_command c = {.foul = foul, .team = team, .timestamp_s = timestamp_s, .half = 1};
  uint8_t bytes[512];
  size_t size = vs_ref_command_encode(&c, bytes, sizeof bytes);
  for (int k = 0; k < 10; k++) assert_true(vs_udp_send(&referee, bytes, size));
}

// Plays on for half a second; false if the robot drove meanwhile.
static bool stays_still(venue *v) {
  bool still = true;
  for (int64_t end_us = vs_clock_monotonic_us() + 500000; vs_clock_monotonic_us() < end_us;) {
    live(v);
    still = still && v->drives.brake;
  }
  return still;
}

// deploy/docs/network_referee.md with a camera: a transition a row.
static const struct {
  vs_foul foul;
  int team;
  bool drives;
} rows[] = {
    {VS_FOUL_HALT, -1, false},          {VS_FOUL_KICKOFF, VS_BLUE, true}, // to its place
    {VS_FOUL_STOP, -1, false},          {VS_FOUL_GAME_ON, -1, true},      {VS_FOUL_STOP, -1, false},
    {VS_FOUL_FREE_KICK, VS_BLUE, true}, {VS_FOUL_STOP, -1, false},        {VS_FOUL_PENALTY_KICK, VS_BLUE, true},
    {VS_FOUL_HALT, -1, false},          {VS_FOUL_GAME_ON, -1, true},      {VS_FOUL_STOP, -1, false},
};

static void calls_move_a_team_with_a_camera(void **state) {
  (void)state;
  char flags[256], record[64], text[160];
  snprintf(record, sizeof record, "%s/record", folder);
  snprintf(flags, sizeof flags, "--policy random: --referee network:+%d --record %s", offset, record);
  assert_ok(vs_udp_sender("224.5.23.2", 10003 + offset, NULL, &referee, err));
  venue *v = open_venue(folder, flags);
  for (int k = 0; k < 20000 && !strstr(read_text(v->log_path), "network referee's calls"); k++) live(v);
  assert_true(stays_still(v)); // no call, no go
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    call(rows[k].foul, rows[k].team, (double)k);
    snprintf(text, sizeof text, "row %zu, %s: %s", k, vs_foul_name(rows[k].foul), rows[k].drives ? "drives" : "brakes");
    assert_within(text, wait_until(v, rows[k].drives), 300);
    if (!rows[k].drives && !stays_still(v)) fail_msg("%s, but drove", text);
  }
  close_venue(v, 0);
  assert_non_null(strstr(read_text(v->log_path), "referee: kick-off for blue: placing"));
  vs_udp_close(&referee);
  // The record knows what was called: all is computed again, the drive to the places too.
  vsss_run run;
  snprintf(text, sizeof text, "replay %s --check", record);
  vsss(&run, text);
  if (run.status != 0) fail_msg("%d: %s%s", run.status, run.out, run.err);
}

static void a_wrong_port_is_refused(void **state) {
  (void)state;
  assert_refused("field --camera rig:/nowhere --referee network:x=1", 2, "x=1");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 60;
  vs_camera_register(vs_frame_stream_camera());
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(calls_move_a_team_with_a_camera),
      cmocka_unit_test(a_wrong_port_is_refused),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
