// Tests src/cli/field_guest.c: our team plays in the league's server over the network, in both dialects.
#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/league_messages.h"

static int offset;

// The guest starts first and waits for the simulator; both teams of the match come over the network.
static void our_team_plays_and_scores_as_a_guest(void **state) {
  (void)state;
  const char *dialect[] = {"firasim", "travesim"};
  for (int d = 0; d < 2; d++) {
    char text[512];
    snprintf(text, sizeof text, "field --camera %s:+%d --radio %s:+%d --team yellow --policy emc: --record '%s/csv'",
             dialect[d], offset + 10 * d, dialect[d], offset + 10 * d, folder);
    char output[128];
    snprintf(output, sizeof output, "%s/guest", folder);
    pid_t guest = vsss_start(output, text);
    vsss_run run;
    snprintf(text, sizeof text,
             "serve --dialect %s --ports +%d --blue zero: --sync --answer 30 --drive planar --pause 0.5 --seconds 240 "
             "--json",
             dialect[d], offset + 10 * d);
    vsss(&run, text);
    int status = vsss_finish(guest, SIGINT);
    if (run.status != 0 || !strstr(run.out, "\"complete\": true") || !strstr(run.out, "\"illegal_placements\": 0"))
      fail_msg("%d: %s%s", run.status, run.out, run.err);
    int blue = -1, yellow = -1;
    const char *score = strstr(run.out, "\"score\": ");
    assert_non_null(score);
    assert_int_equal(sscanf(score, "\"score\": [%d, %d]", &blue, &yellow), 2);
    if (yellow < 1 || blue > yellow) fail_msg("%s", run.out);
    assert_int_equal(status, 0);
    char path[128];
    snprintf(path, sizeof path, "%s/csv", folder);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    int lines = 0;
    for (int c; (c = getc(f)) != EOF;) lines += c == '\n';
    fclose(f);
    assert_true(lines > 1000);
  }
}

static void ends_that_do_not_fit_are_refused(void **state) {
  (void)state;
  assert_refused("field --camera firasim: --radio /dev/ttyUSB0", 2, "--radio firasim:");
  assert_refused("field --camera firasim: --radio travesim:", 2, "--radio firasim:");
  assert_refused("field --camera 0.png --radio firasim:", 2, "--camera firasim:");
  assert_refused("field --camera firasim:x=1", 2, "x=1");
  assert_refused("field --camera firasim: --policy nobody:", 2, "nobody:");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 90;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(our_team_plays_and_scores_as_a_guest),
      cmocka_unit_test(ends_that_do_not_fit_are_refused),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
