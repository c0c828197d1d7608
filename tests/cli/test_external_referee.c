// Tests src/cli/cmd_serve.c with --referee external and src/cli/field_guest.c, moved by a VSSReferee in a process of its own
// (tests/serve/vss_referee.py).
#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/league_messages.h"

static int offset;

// One server, our team as a guest, the referee: blue is the server's own player, yellow comes over the network.
static void a_real_referee_moves_both_sides(void **state) {
  (void)state;
  char text[512], output[128], self[4096], command[8192], said[2048];
  snprintf(text, sizeof text, "serve --referee external --blue emc: --ports +%d --drive planar --json", offset);
  snprintf(output, sizeof output, "%s/serve", folder);
  pid_t server = vsss_start(output, text);
  snprintf(text, sizeof text, "field --camera firasim:+%d --radio firasim:+%d --team yellow --policy emc:", offset,
           offset);
  snprintf(output, sizeof output, "%s/guest", folder);
  pid_t guest = vsss_start(output, text);
  for (int k = 0; k < 600 && !strstr(folder_file("guest"), "GAME ON"); k++) usleep(50000);
  vsss_sources(self, sizeof self);
  snprintf(command, sizeof command, "python3 '%s/tests/serve/vss_referee.py' %d 2>&1", self, offset);
  FILE *referee = popen(command, "r");
  said[fread(said, 1, sizeof said - 1, referee)] = '\0';
  int result = pclose(referee);
  int of_guest = vsss_finish(guest, SIGINT), of_server = vsss_finish(server, SIGINT);
  if (result != 0) fail_msg("%s\nguest: %s", said, folder_file("guest"));
  assert_int_equal(of_guest, 0);
  assert_int_equal(of_server, 0);
  // 17 calls, each of ten datagrams; 6 of them ask for places.
  if (!strstr(folder_file("guest"), "17 calls of the referee, 6 placements")) fail_msg("%s", folder_file("guest"));
  if (!strstr(folder_file("serve"), "\"garbage\": 0")) fail_msg("%s", folder_file("serve"));
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 70;
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_real_referee_moves_both_sides)};
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
