// src/cli/video.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "cli/video.h"

static uint8_t picture[48][64][3];

static int have_ffmpeg(void) { return system("ffmpeg -version >/dev/null 2>&1") == 0; }

static void frames_become_a_video_of_their_number_and_size(void **state) {
  (void)state;
  if (!have_ffmpeg()) skip();
  char path[] = "/tmp/vsss_video_XXXXXX.mp4", command[256], line[64] = "";
  int fd = mkstemps(path, 4);
  assert_true(fd >= 0);
  close(fd);
  vs_video *v;
  assert_ok(vs_video_open(path, 64, 48, 30, &v, err));
  for (int i = 0; i < 12; i++) {
    memset(picture, 20 * i, sizeof picture);
    assert_ok(vs_video_frame(v, &picture[0][0][0], err));
  }
  assert_ok(vs_video_close(v, err));
  snprintf(command, sizeof command,
           "ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv=p=0 %s", path);
  FILE *probe = popen(command, "r");
  assert_non_null(fgets(line, sizeof line, probe));
  pclose(probe);
  unlink(path);
  assert_string_equal(line, "64,48,12\n");
}

static void a_path_that_cannot_be_written_is_an_error_naming_it(void **state) {
  (void)state;
  if (!have_ffmpeg()) skip();
  vs_video *v;
  vs_error err = {0};
  assert_int_equal(vs_video_open("/nonexistent/out.mp4", 64, 48, 30, &v, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nonexistent/out.mp4"));
  assert_non_null(strstr(err.text, "No such file"));
}

static void an_ending_that_is_no_video_is_refused(void **state) {
  (void)state;
  static const char *const names[] = {"x.gif", "x", ".mp4", "mp4", "x.mp4.png"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    vs_video *v;
    vs_error err = {0};
    if (vs_video_open(names[i], 64, 48, 30, &v, &err) != VS_USAGE || !strstr(err.text, ".mp4, .mkv, .mov or .avi"))
      fail_msg("%s: %s", names[i], err.text);
  }
}

static void without_ffmpeg_the_error_says_what_to_install(void **state) {
  (void)state;
  char *path = strdup(getenv("PATH"));
  setenv("PATH", "/nonexistent", 1);
  vs_video *v;
  vs_error err = {0};
  vs_status s = vs_video_open("out.mp4", 64, 48, 30, &v, &err);
  setenv("PATH", path, 1);
  free(path);
  assert_int_equal(s, VS_FAIL);
  assert_null(v);
  assert_string_equal(err.text, "out.mp4: writing a video needs the program ffmpeg; install ffmpeg");
}

static void odd_sizes_are_refused(void **state) {
  (void)state;
  vs_video *v;
  vs_error err = {0};
  assert_int_equal(vs_video_open("out.mp4", 63, 48, 30, &v, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "63 x 48"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_become_a_video_of_their_number_and_size),
      cmocka_unit_test(an_ending_that_is_no_video_is_refused),
      cmocka_unit_test(a_path_that_cannot_be_written_is_an_error_naming_it),
      cmocka_unit_test(without_ffmpeg_the_error_says_what_to_install),
      cmocka_unit_test(odd_sizes_are_refused),
  };
  return cmocka_run_group_tests_name("cli/video", tests, NULL, NULL);
}
