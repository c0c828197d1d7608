// deploy/firmware/esp32/robot.c and deploy/firmware/esp32/base.c: compiled as they are, with the SDK's headers replaced by
// tests/firmware/sdk, and run.
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/paths.h"

static void build_and_run(const char *what) {
  char path[PATH_MAX], root[PATH_MAX], out[] = "/tmp/vsss_esp32_XXXXXX", command[3 * PATH_MAX];
  assert_ok(vs_path_find("deploy/firmware/esp32/config.h", path, sizeof path, err));
  assert_non_null(realpath(path, root));
  *strstr(root, "/deploy/firmware") = '\0';
  int fd = mkstemp(out);
  assert_true(fd >= 0);
  close(fd);
  snprintf(
      command, sizeof command,
      "cd '%s' && ${CC:-cc} -std=gnu11 -O1 -Wall -Wextra -Werror -Wno-unused-function -Itests/firmware/sdk -Iinclude "
      "-o %s tests/firmware/run_%s.c deploy/firmware/esp32/%s.c deploy/firmware/firmware.c src/comms/radio_codec.c "
      "src/comms/siphash.c -lm && %s >&2",
      root, out, what, what, out);
  int status = system(command);
  unlink(out);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail_msg("%s: status %d", what, status);
}

static void the_robot_drives_brakes_and_reports(void **state) {
  (void)state;
  build_and_run("robot");
}

static void the_base_carries_frames_both_ways(void **state) {
  (void)state;
  build_and_run("base");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_robot_drives_brakes_and_reports),
      cmocka_unit_test(the_base_carries_frames_both_ways),
  };
  return cmocka_run_group_tests_name("comms/esp32", tests, NULL, NULL);
}
