// Tests vsss field's go and stop (src/cli/operator.c, src/field/field_loop.c) through the real binary, with a camera and
// a radio in the test's hands and the words in a named pipe.
#include <fcntl.h>
#include <sys/stat.h>

#include "field_venue.h"

static char folder[] = "/tmp/vsss_arm_XXXXXX";
static int words = -1;

static void say(const char *word) { assert_int_equal(write(words, word, strlen(word)), (ssize_t)strlen(word)); }

// Plays on for a second; false if the robot drove meanwhile.
static bool stays_still(venue *v) {
  bool still = true;
  for (int64_t end_us = vs_clock_monotonic_us() + 1000000; vs_clock_monotonic_us() < end_us;) {
    live(v);
    still = still && v->drives.brake;
  }
  return still;
}

static void the_robots_stand_until_they_are_told_to_go(void **state) {
  (void)state;
  char pipe[64], flags[160];
  snprintf(pipe, sizeof pipe, "%s/words", folder);
  assert_int_equal(mkfifo(pipe, 0600), 0);
  words = open(pipe, O_RDWR | O_CLOEXEC);
  assert_true(words >= 0);
  snprintf(flags, sizeof flags, "--policy random: --referee %s", pipe);
  venue *v = open_venue(folder, flags);
  for (int k = 0; k < 20000 && !strstr(read_text(v->log_path), "stand until they are told to go"); k++) live(v);
  assert_true(stays_still(v));
  say("go\n");
  assert_within("go: drives", wait_until(v, true), 300);
  say("stop\n");
  assert_within("stop: brakes", wait_until(v, false), 100);
  assert_true(stays_still(v));
  say("go\n");
  assert_within("go again: drives", wait_until(v, true), 300);
  say("gol\n"); // whatever it meant, nothing may move
  assert_within("an unknown word: brakes", wait_until(v, false), 100);
  assert_true(stays_still(v));
  close_venue(v, 0);
  assert_non_null(strstr(read_text(v->log_path), "'gol' is none of go, stop, halt"));
  close(words);
  unlink(pipe);
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_robots_stand_until_they_are_told_to_go),
  };
  if (!mkdtemp(folder)) return 1;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
