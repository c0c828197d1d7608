// Tests src/league_net/net_referee.c: the table of calls and states, repeats, and what is no call.
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/net_referee.h"

// deploy/docs/network_referee.md, row by row.
static const struct {
  vs_foul foul;
  vs_net_state state;
  vs_net_task unsaid, go, stop; // by the operator's word
  vs_event_kind event;
} table[] = {
    {VS_FOULS, VS_NET_WAITING, VS_NET_STAND, VS_NET_AT_PLAY, VS_NET_STAND, VS_EVENT_NONE}, // none was heard
    {VS_FOUL_GAME_ON, VS_NET_PLAY, VS_NET_AT_PLAY, VS_NET_AT_PLAY, VS_NET_STAND, VS_EVENT_NONE},
    {VS_FOUL_STOP, VS_NET_STOPPED, VS_NET_STAND, VS_NET_STAND, VS_NET_STAND, VS_EVENT_NONE},
    {VS_FOUL_HALT, VS_NET_HALTED, VS_NET_STAND, VS_NET_STAND, VS_NET_STAND, VS_EVENT_HALT},
    {VS_FOUL_KICKOFF, VS_NET_PLACING, VS_NET_TO_PLACES, VS_NET_TO_PLACES, VS_NET_STAND, VS_EVENT_KICK_OFF},
    {VS_FOUL_FREE_BALL, VS_NET_PLACING, VS_NET_TO_PLACES, VS_NET_TO_PLACES, VS_NET_STAND, VS_EVENT_FREE_BALL},
    {VS_FOUL_GOAL_KICK, VS_NET_PLACING, VS_NET_TO_PLACES, VS_NET_TO_PLACES, VS_NET_STAND, VS_EVENT_GOAL_KICK},
    {VS_FOUL_PENALTY_KICK, VS_NET_PLACING, VS_NET_TO_PLACES, VS_NET_TO_PLACES, VS_NET_STAND, VS_EVENT_PENALTY},
    {VS_FOUL_FREE_KICK, VS_NET_PLACING, VS_NET_TO_PLACES, VS_NET_TO_PLACES, VS_NET_STAND, VS_EVENT_FREE_KICK},
};
enum { ROWS = sizeof table / sizeof *table };

static void open_pair(vs_net_referee *team, vs_udp *referee) {
  int port = 21000 + (int)(getpid() % 4000) * 8;
  assert_ok(vs_net_referee_open(port, port + 1, NULL, team, err));
  assert_ok(vs_udp_sender("224.5.23.2", port, NULL, referee, err));
}

static void call(const vs_udp *referee, vs_ref_command c, int times) {
  uint8_t bytes[512];
  size_t size = vs_ref_command_encode(&c, bytes, sizeof bytes);
  while (times-- > 0) assert_true(vs_udp_send(referee, bytes, size));
}

static void each_state_lets_the_robots_do_what_the_table_says(void **state) {
  (void)state;
  for (int k = 0; k < ROWS; k++) {
    assert_int_equal(vs_net_task_of(table[k].state, VS_NET_UNSAID), table[k].unsaid);
    assert_int_equal(vs_net_task_of(table[k].state, VS_NET_GO), table[k].go);
    assert_int_equal(vs_net_task_of(table[k].state, VS_NET_STOP), table[k].stop);
  }
}

// Every call in every state that a call leads to; each of ten datagrams.
static void every_transition_is_made_once_for_ten_datagrams(void **state) {
  (void)state;
  vs_net_referee team;
  vs_udp referee;
  open_pair(&team, &referee);
  assert_int_equal(team.state, VS_NET_WAITING);
  assert_false(vs_net_referee_hear(&team));
  int64_t heard = 0;
  double time_s = 0;
  for (int from = 1; from < ROWS; from++)
    for (int to = 1; to < ROWS; to++) {
      if (from == to) continue;
      const int pair[] = {from, to};
      for (int k = 0; k < 2; k++) {
        vs_foul foul = table[pair[k]].foul;
        bool news = foul != team.call.foul;
        call(&referee, (vs_ref_command){.foul = foul, .team = VS_YELLOW, .quadrant = 2, .timestamp_s = time_s}, 10);
        bool stands_alone = foul == VS_FOUL_GAME_ON || foul == VS_FOUL_STOP || foul == VS_FOUL_HALT;
        assert_int_equal(vs_net_referee_hear(&team), news || !stands_alone);
        assert_false(vs_net_referee_hear(&team));
        heard += news || !stands_alone;
        assert_int_equal(team.state, table[pair[k]].state);
        vs_event event = vs_net_event(&team.call, 7);
        assert_int_equal(event.kind, table[pair[k]].event);
        assert_int_equal(event.team, VS_YELLOW);
        assert_near(event.time_s, 7, 0);
        time_s += 1;
      }
    }
  assert_int_equal(team.heard, heard);
  vs_udp_close(&referee);
  vs_net_referee_close(&team);
}

static void a_corrected_call_is_a_new_one(void **state) {
  (void)state;
  vs_net_referee team;
  vs_udp referee;
  open_pair(&team, &referee);
  vs_ref_command kick = {.foul = VS_FOUL_KICKOFF, .team = VS_BLUE, .timestamp_s = 3, .half = 1};
  call(&referee, kick, 10);
  assert_true(vs_net_referee_hear(&team));
  kick.team = VS_YELLOW; // the same second: the referee meant the other team
  call(&referee, kick, 10);
  assert_true(vs_net_referee_hear(&team));
  assert_int_equal(team.call.team, VS_YELLOW);
  vs_ref_command ball = {.foul = VS_FOUL_FREE_BALL, .team = -1, .quadrant = 1, .timestamp_s = 3, .half = 1};
  call(&referee, ball, 10);
  ball.quadrant = 3;
  call(&referee, ball, 10);
  assert_true(vs_net_referee_hear(&team));
  assert_true(vs_net_referee_hear(&team));
  assert_int_equal(vs_net_event(&team.call, 0).quadrant, 3);
  assert_false(vs_net_referee_hear(&team));
  vs_udp_close(&referee);
  vs_net_referee_close(&team);
}

static void what_is_no_call_is_counted_and_changes_nothing(void **state) {
  (void)state;
  vs_net_referee team;
  vs_udp referee;
  open_pair(&team, &referee);
  call(&referee, (vs_ref_command){.foul = VS_FOUL_GAME_ON, .team = -1}, 1);
  assert_true(vs_net_referee_hear(&team));
  uint8_t bytes[5000];
  memset(bytes, 0xff, sizeof bytes);
  assert_true(vs_udp_send(&referee, bytes, sizeof bytes));
  assert_true(vs_udp_send(&referee, bytes, 9));
  const uint8_t foul_9[] = {0x08, 9}; // field 1, the number of no foul
  assert_true(vs_udp_send(&referee, foul_9, sizeof foul_9));
  assert_false(vs_net_referee_hear(&team));
  assert_int_equal(team.garbage, 3);
  assert_int_equal(team.state, VS_NET_PLAY);
  vs_udp_close(&referee);
  vs_net_referee_close(&team);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_state_lets_the_robots_do_what_the_table_says),
      cmocka_unit_test(every_transition_is_made_once_for_ten_datagrams),
      cmocka_unit_test(a_corrected_call_is_a_new_one),
      cmocka_unit_test(what_is_no_call_is_counted_and_changes_nothing),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
