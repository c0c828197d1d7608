// src/cli/cmd_doctor.c through the real binary, with a camera and a radio in the test's hands.
#include "cli/field_venue.h"
#include "test_folder.h"
#include "vsss/calib.h"
#include "vsss/paths.h"

// What doctor says while the venue lives, and its status.
static const char *examine(venue *v, const char *flags, int *status) {
  char arguments[600];
  snprintf(arguments, sizeof arguments, "doctor %s", flags);
  pid_t doctor = vsss_start(v->log_path, arguments);
  int ended = 0;
  for (int i = 0; i < 60000 && waitpid(doctor, &ended, WNOHANG) != doctor; i++) live(v);
  *status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  return read_text(v->log_path);
}

static void assert_says(const char *said, const char *text) {
  if (!strstr(said, text)) fail_msg("no '%s' in: %s", text, said);
}

static void what_is_there_is_ok_and_what_is_not_gets_a_fix(void **state) {
  (void)state;
  static venue v;
  char calib_path[96], small_path[96], flags[500];
  snprintf(v.camera_path, sizeof v.camera_path, "%s/camera", folder);
  snprintf(v.radio_path, sizeof v.radio_path, "%s/radio", folder);
  snprintf(v.log_path, sizeof v.log_path, "%s/log", folder);
  snprintf(calib_path, sizeof calib_path, "%s/right.ini", folder);
  snprintf(small_path, sizeof small_path, "%s/small.ini", folder);
  vs_calib calib = vs_calib_overhead(PICTURE_W, PICTURE_H, 2.2, 0.6), small = vs_calib_overhead(320, 240, 2.2, 0.6);
  assert_ok(vs_calib_save(calib_path, &calib, err));
  assert_ok(vs_calib_save(small_path, &small, err));
  v.rng = vs_rng_make(1, 0);
  paint_tagged_picture(v.picture);
  vs_firmware_init(&v.robot, 1, venue_ms());
  plug_camera(&v);
  plug_radio(&v);
  int status = -1;
  snprintf(flags, sizeof flags, "--camera rig:%s --radio %s --calib %s", v.camera_path, v.radio_path, calib_path);
  const char *said = examine(&v, flags, &status);
  assert_says(said, "ok    config ");
  assert_says(said, "ok    camera       rig, 640x480, 30 pictures a second");
  assert_says(said, "3 marks, 1 balls");
  assert_says(said, "ok    radio ");
  assert_says(said, "note  key          none");
  assert_null(strstr(said, "FIX   camera"));
  assert_null(strstr(said, "FIX   radio"));
  assert_null(strstr(said, "FIX   calibration"));

  snprintf(flags, sizeof flags, "--camera rig:%s --radio %s/none --calib %s", v.camera_path, folder, small_path);
  said = examine(&v, flags, &status);
  assert_int_equal(status, 1);
  assert_says(said, "FIX   radio ");
  assert_says(said, "is the radio plugged in?");
  assert_says(said, "FIX   calibration ");
  assert_says(said, "320 x 240, this camera gives 640 x 480");

  unplug_camera(&v);
  snprintf(flags, sizeof flags, "--json --camera rig:%s --radio %s", v.camera_path, v.radio_path);
  said = examine(&v, flags, &status);
  assert_int_equal(status, 1);
  assert_int_equal(said[0], '[');
  assert_says(said, "{\"check\": \"camera\", \"verdict\": \"fix\", \"text\": \"rig:");
  assert_says(said, "{\"check\": \"radio\", \"verdict\": \"ok\"");
  unplug_radio(&v);
}

static void a_wrong_configuration_and_policy_are_named(void **state) {
  (void)state;
  static vsss_run run;
  char path[96], arguments[160];
  snprintf(path, sizeof path, "%s/field.ini", folder);
  FILE *f = fopen(path, "w");
  fprintf(f, "[field]\npolicy = onnx:%s/none.onnx\n", folder);
  fclose(f);
  snprintf(arguments, sizeof arguments, "doctor --config %s", path);
  vsss(&run, arguments);
  assert_int_equal(run.status, 1);
  assert_says(run.out, "FIX   policy ");
  assert_says(run.out, "FIX   camera ");
  f = fopen(path, "w");
  fprintf(f, "[radio]\nkey = 12\n");
  fclose(f);
  vsss(&run, arguments);
  assert_int_equal(run.status, 1);
  assert_says(run.out, "FIX   config ");
  assert_says(run.out, "expected 32 hexadecimal digits");
}

// The venues that come with the program are read without a complaint.
static void the_example_venues_are_right(void **state) {
  (void)state;
  static const char *const names[] = {"field.ini", "venue-larc2026.ini", "venue-plates.ini"};
  static vsss_run run;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char relative[64], path[512], arguments[600], said[600];
    snprintf(relative, sizeof relative, "deploy/config/%s", names[i]);
    assert_ok(vs_path_find(relative, path, sizeof path, err));
    snprintf(arguments, sizeof arguments, "doctor --config '%s'", path);
    snprintf(said, sizeof said, "ok    config       %s", path);
    vsss(&run, arguments);
    assert_says(run.out, said);
  }
}

// What the units start is a command with flags that it has: its help is asked for with them.
static void the_systemd_units_start_what_there_is(void **state) {
  (void)state;
  static const char *const names[] = {"field", "bridge"};
  static vsss_run run;
  for (int i = 0; i < 2; i++) {
    char relative[64], path[512], arguments[2000], usage[32];
    snprintf(relative, sizeof relative, "deploy/systemd/vsss-%s.service", names[i]);
    assert_ok(vs_path_find(relative, path, sizeof path, err));
    const char *start = strstr(read_text(path), "exec vsss ");
    assert_non_null(start);
    start += strlen("exec vsss ");
    size_t length = strcspn(start, "'\n"), used = 0;
    for (size_t k = 0; k < length && used + 16 < sizeof arguments; k++) { // $$ and %% stand for one of them
      arguments[used++] = start[k];
      if ((start[k] == '$' || start[k] == '%') && start[k + 1] == start[k]) k++;
    }
    snprintf(arguments + used, sizeof arguments - used, " --help");
    setenv("VSSS_CAMERA", "/dev/video0", 1);
    setenv("VSSS_RADIO", "/dev/ttyUSB0", 1);
    setenv("VSSS_TEAM", "blue", 1);
    vsss(&run, arguments);
    snprintf(usage, sizeof usage, "usage: vsss %s", names[i]);
    if (run.status != 0 || !strstr(run.out, usage)) fail_msg("vsss %s: %d %s", arguments, run.status, run.err);
  }
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_there_is_ok_and_what_is_not_gets_a_fix),
      cmocka_unit_test(a_wrong_configuration_and_policy_are_named),
      cmocka_unit_test(the_example_venues_are_right),
      cmocka_unit_test(the_systemd_units_start_what_there_is),
  };
  return cmocka_run_group_tests_name("cli/doctor", tests, make_folder, remove_folder);
}
