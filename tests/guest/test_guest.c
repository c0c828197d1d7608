// Tests src/guest/guest.c: what each call of the network referee does to the team.
#include <string.h>

#include "assert_near.h"
#include "vsss/clock.h"
#include "vsss/field.h"
#include "vsss/guest.h"
#include "vsss/udp.h"

#include <stdio.h>
#include <unistd.h>

static int base;

// A transition a row.
static const struct {
  vs_ref_command call;
  vs_net_state state;
  vs_event_kind event; // NONE: the last one stays
  bool drives, places; // places: says where it wants to stand, and drives there
} rows[] = {
    {{VS_FOUL_KICKOFF, VS_YELLOW, 0, 1, 1}, VS_NET_PLACING, VS_EVENT_KICK_OFF, true, true},
    {{VS_FOUL_STOP, VS_YELLOW, 0, 1, 1}, VS_NET_STOPPED, VS_EVENT_NONE, false, false},
    {{VS_FOUL_GAME_ON, -1, 0, 1, 1}, VS_NET_PLAY, VS_EVENT_NONE, true, false},
    {{VS_FOUL_FREE_BALL, -1, 3, 2, 1}, VS_NET_PLACING, VS_EVENT_FREE_BALL, true, true},
    {{VS_FOUL_GAME_ON, -1, 0, 3, 1}, VS_NET_PLAY, VS_EVENT_NONE, true, false},
    {{VS_FOUL_PENALTY_KICK, VS_BLUE, 0, 4, 1}, VS_NET_PLACING, VS_EVENT_PENALTY, true, true},
    {{VS_FOUL_STOP, VS_BLUE, 0, 4, 1}, VS_NET_STOPPED, VS_EVENT_NONE, false, false},
    {{VS_FOUL_GOAL_KICK, VS_YELLOW, 4, 5, 1}, VS_NET_PLACING, VS_EVENT_GOAL_KICK, true, true},
    {{VS_FOUL_GAME_ON, -1, 0, 6, 2}, VS_NET_PLAY, VS_EVENT_NONE, true, false},
    {{VS_FOUL_HALT, -1, 0, 7, 2}, VS_NET_HALTED, VS_EVENT_HALT, false, false},
    {{VS_FOUL_FREE_KICK, VS_BLUE, 0, 8, 2}, VS_NET_PLACING, VS_EVENT_FREE_KICK, true, true},
};

static vs_guest *open_guest(vs_team team, vs_udp *vision, vs_udp *referee, vs_udp *commands, vs_udp *placements) {
  const vs_guest_def def = {.policy = "emc:",
                            .team = team,
                            .seed = 1,
                            .duration_s = 100,
                            .wheel_radius_m = 0.02,
                            .step_s = 0.001,
                            .vision = base,
                            .command = base + 1,
                            .referee = base + 2,
                            .placement = base + 3};
  vs_guest *guest = NULL;
  assert_ok(vs_guest_new(&def, &guest, err));
  assert_ok(vs_udp_sender("224.0.0.1", base, NULL, vision, err));
  assert_ok(vs_udp_sender("224.5.23.2", base + 2, NULL, referee, err));
  assert_ok(vs_udp_listen(base + 1, NULL, commands, err));
  assert_ok(vs_udp_join("224.5.23.2", base + 3, NULL, placements, err));
  return guest;
}

static void send_world(const vs_udp *vision, uint32_t step, double ball_x_m) {
  vs_fira_environment e = {.step = step, .goals = {3, 1}};
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      e.world.robot[t][i] = (vs_robot){.pose = {t ? 0.3 : -0.3, 0.3 * (i - 1), 0}, .valid = true};
  e.world.ball = (vs_ball){.x_m = ball_x_m, .y_m = 0.12, .z_m = VS_BALL_RADIUS_M, .valid = true};
  uint8_t bytes[512];
  assert_true(vs_udp_send(vision, bytes, vs_fira_environment_encode(&e, bytes, sizeof bytes)));
}

// Worlds until the guest has answered one; the fastest wheel of the answer.
static double answer(vs_guest *guest, const vs_udp *vision, const vs_udp *commands, uint32_t *step, vs_team team,
                     vs_guest_tick_result *tick) {
  double fastest = -1;
  for (int k = 0; k < 20; k++) { // several decisions, so that a team that plays drives
    send_world(vision, *step += 16, 0.1);
    assert_ok(vs_guest_tick(guest, tick, err));
    if (!tick->seen) continue;
    uint8_t bytes[512];
    size_t size;
    vs_fira_packet p;
    while (vs_udp_receive(commands, bytes, sizeof bytes, &size)) {
      assert_ok(vs_fira_packet_decode(bytes, size, true, &p, err));
      assert_int_equal(p.commands, VS_TEAM_SIZE);
      if (fastest < 0) fastest = 0;
      for (int i = 0; i < p.commands; i++) {
        assert_int_equal(p.command[i].team, team);
        fastest = fmax(fastest, fmax(fabs(p.command[i].wheels.left_radps), fabs(p.command[i].wheels.right_radps)));
      }
    }
  }
  if (fastest < 0) fail_msg("no command came");
  return fastest;
}

static void each_call_moves_the_team_through_the_table(void **state) {
  (void)state;
  for (int team = 0; team < VS_TEAMS; team++) {
    vs_udp vision, referee, commands, placements;
    vs_guest *guest = open_guest((vs_team)team, &vision, &referee, &commands, &placements);
    vs_guest_tick_result tick;
    uint32_t step = 100;
    assert_near(answer(guest, &vision, &commands, &step, (vs_team)team, &tick), 0, 0); // nobody said go
    assert_int_equal(tick.state, VS_NET_WAITING);
    assert_int_equal(tick.safety, VS_SAFETY_UNARMED);
    assert_int_equal(tick.game.score[VS_BLUE], 3);
    vs_event_kind last = VS_EVENT_KICK_OFF;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
      uint8_t bytes[512];
      size_t size = vs_ref_command_encode(&rows[k].call, bytes, sizeof bytes);
      for (int repeat = 0; repeat < 10; repeat++) vs_udp_send(&referee, bytes, size);
      double fastest = 0;
      // The frame in which the call is heard may still have been decided on before.
      send_world(&vision, step += 16, 0.1);
      assert_ok(vs_guest_tick(guest, &tick, err));
      while (vs_udp_receive(&commands, bytes, sizeof bytes, &size)) {
      }
      fastest = answer(guest, &vision, &commands, &step, (vs_team)team, &tick);
      if (tick.state != rows[k].state)
        fail_msg("row %zu: %s, expected %s", k, vs_net_state_name(tick.state), vs_net_state_name(rows[k].state));
      if (rows[k].event != VS_EVENT_NONE) last = rows[k].event;
      assert_int_equal(tick.game.last_event.kind, last);
      if (rows[k].drives ? !(fastest > 1) : fastest != 0) fail_msg("row %zu drives at %g rad/s", k, fastest);
      int placed = 0;
      vs_ref_placement p;
      while (vs_udp_receive(&placements, bytes, sizeof bytes, &size)) {
        assert_ok(vs_ref_placement_decode(bytes, size, &p, err));
        assert_int_equal(p.team, team);
        placed++;
      }
      assert_int_equal(placed, rows[k].places ? 1 : 0);
    }
    vs_guest_free(guest);
    vs_udp_close(&vision);
    vs_udp_close(&referee);
    vs_udp_close(&commands);
    vs_udp_close(&placements);
  }
}

// Without a call the operator's go plays. A call then goes before it, but his stop goes before every call.
static void the_operator_plays_without_a_referee_and_stops_with_one(void **state) {
  (void)state;
  vs_udp vision, referee, commands, placements;
  vs_guest *guest = open_guest(VS_BLUE, &vision, &referee, &commands, &placements);
  vs_guest_tick_result tick;
  uint32_t step = 100;
  const vs_ref_command halt = {.foul = VS_FOUL_HALT, .team = -1}, game_on = {.foul = VS_FOUL_GAME_ON, .team = -1};
  const struct {
    int go; // -1: not said
    const vs_ref_command *call;
    bool drives;
  } said[] = {{1, NULL, true},      {0, NULL, false}, {1, NULL, true},    {-1, &halt, false},    {1, NULL, false},
              {-1, &game_on, true}, {0, NULL, false}, {-1, &halt, false}, {-1, &game_on, false}, {1, NULL, true}};
  for (size_t k = 0; k < sizeof said / sizeof *said; k++) {
    uint8_t bytes[512];
    size_t size = said[k].call ? vs_ref_command_encode(said[k].call, bytes, sizeof bytes) : 0;
    if (size) vs_udp_send(&referee, bytes, size);
    if (said[k].go >= 0) vs_guest_arm(guest, said[k].go);
    send_world(&vision, step += 16, 0.1); // answered as before where it was on its way
    assert_ok(vs_guest_tick(guest, &tick, err));
    while (vs_udp_receive(&commands, bytes, sizeof bytes, &size)) {
    }
    double fastest = answer(guest, &vision, &commands, &step, VS_BLUE, &tick);
    if (said[k].drives ? !(fastest > 1) : fastest != 0) fail_msg("row %zu drives at %g rad/s", k, fastest);
  }
  assert_int_equal(vs_guest_get_stats(guest)->calls, 4);
  vs_guest_free(guest);
  vs_udp_close(&vision);
  vs_udp_close(&referee);
  vs_udp_close(&commands);
  vs_udp_close(&placements);
}

int main(void) {
  base = 21000 + (int)(getpid() % 4000) * 8;
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_call_moves_the_team_through_the_table),
                                     cmocka_unit_test(the_operator_plays_without_a_referee_and_stops_with_one)};
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
