#include "vsss/guest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/control.h"
#include "vsss/field.h"
#include "vsss/go_to.h"
#include "vsss/referee.h"
#include "vsss/ssl_vision.h"
#include "vsss/udp.h"

#define WAIT_US        100000
#define VISION_GROUP   "224.0.0.1"
#define SIMULATOR      "127.0.0.1"
#define LONGEST_STEP_S 0.5     // the simulator was stopped, or restarted
#define BALL_HOLD_US   3000000 // robots of our own play on so long with a ball that is not seen
#define DELAY_S        0.017   // a frame, from its world to the wheels

struct vs_guest {
  vs_guest_def def;
  vs_control *control;
  vs_udp vision, command;
  vs_sender *sender; // NULL: a simulator's robots
  vs_ssl_world ssl;
  vs_net_referee referee;
  vs_net_word word; // the operator's
  bool has_places;  // the call named a restart that has some
  vs_pose place[VS_TEAM_SIZE];
  vs_go_to go_to;
  vs_safety safety;
  vs_world world;
  vs_game game;
  uint32_t step;
  int64_t ball_us; // when it was seen last
  int64_t unread;  // datagrams that were no world
  vs_guest_stats stats;
};

static vs_status open_brain(vs_guest *g, vs_error *err) {
  vs_player *player = NULL;
  vs_status s = vs_player_open(g->def.policy, &player, err);
  if (s != VS_OK) return s;
  s = vs_control_new(player, &g->control, err);
  if (s != VS_OK) {
    vs_player_close(player);
    return s;
  }
  return vs_control_reset(g->control, g->def.seed, false, err);
}

static vs_status open_vision(vs_guest *g, vs_error *err) {
  const vs_guest_def *def = &g->def;
  if (def->unicast) return vs_udp_listen(def->vision, def->interface, &g->vision, err);
  return vs_udp_join(def->ssl ? VS_SSL_GROUP : VISION_GROUP, def->vision, def->interface, &g->vision, err);
}

vs_status vs_guest_new(const vs_guest_def *def, vs_guest **out, vs_error *err) {
  vs_status s = vs_league_supported(err);
  if (s != VS_OK) return s;
  vs_guest *g = calloc(1, sizeof *g);
  if (!g) return vs_fail(err, VS_FAIL, "out of memory");
  g->def = *def;
  g->vision = g->command = g->referee.calls = g->referee.places = VS_UDP_CLOSED;
  g->word = def->go ? VS_NET_GO : VS_NET_UNSAID;
  g->game.duration_s = def->duration_s;
  g->game.last_event = (vs_event){.kind = VS_EVENT_KICK_OFF, .team = VS_BLUE};
  vs_safety_init(&g->safety, vs_clock_monotonic_us());
  s = open_brain(g, err);
  if (s == VS_OK) s = open_vision(g, err);
  if (s == VS_OK)
    s = vs_net_referee_open(def->referee, def->dry ? 0 : def->placement, def->interface, &g->referee, err);
  if (s == VS_OK && def->radio) s = vs_sender_new(def->radio, &g->sender, err);
  if (s == VS_OK && !def->dry && !def->radio) s = vs_udp_sender(SIMULATOR, def->command, NULL, &g->command, err);
  if (s != VS_OK) {
    vs_guest_free(g);
    return s;
  }
  *out = g;
  return VS_OK;
}

static void send_wheels(vs_guest *g, const vs_wheels wheels[VS_TEAM_SIZE]) {
  double scale = VS_WHEEL_RADIUS_M / g->def.wheel_radius_m;
  uint8_t bytes[VS_LEAGUE_DATAGRAM_MAX];
  vs_fira_packet p = {.commands = VS_TEAM_SIZE};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    p.command[i].team = g->def.team;
    p.command[i].robot = i;
    p.command[i].wheels = (vs_wheels){wheels[i].left_radps * scale, wheels[i].right_radps * scale};
  }
  size_t size = vs_fira_packet_encode(&p, true, bytes, sizeof bytes);
  vs_udp_send(&g->command, bytes, size);
}

void vs_guest_free(vs_guest *g) {
  if (!g) return;
  const vs_wheels still[VS_TEAM_SIZE] = {{0, 0}};
  vs_sender_free(g->sender); // it stops them
  if (g->command.fd >= 0)
    for (int k = 0; k < 3; k++) send_wheels(g, still);
  vs_udp_close(&g->vision);
  vs_udp_close(&g->command);
  vs_net_referee_close(&g->referee);
  vs_control_free(g->control);
  free(g);
}

// Where the referee itself would put us, always legal: told to it, and driven to.
static void choose_places(vs_guest *g) {
  vs_ref_placement p = {.team = g->def.team};
  vs_place_team(VS_3V3, &g->game.last_event, g->def.team, g->place);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    p.given[i] = true;
    p.pose[i] = g->place[i];
  }
  g->go_to = (vs_go_to){.delay_s = DELAY_S};
  if (vs_net_referee_tell(&g->referee, &p)) g->stats.placements++;
}

static void hear_referee(vs_guest *g) {
  while (vs_net_referee_hear(&g->referee)) {
    vs_event event = vs_net_event(&g->referee.call, g->game.time_s);
    if (event.kind != VS_EVENT_NONE) g->game.last_event = event;
    g->has_places = g->referee.state == VS_NET_PLACING && event.kind != VS_EVENT_NONE;
    if (g->has_places) choose_places(g);
    if (g->referee.state == VS_NET_PLAY) vs_control_restart(g->control);
  }
}

void vs_guest_arm(vs_guest *g, bool go) {
  if (go && g->word != VS_NET_GO) vs_control_restart(g->control);
  g->word = go ? VS_NET_GO : VS_NET_STOP;
}

static bool see_ssl(vs_guest *g) {
  uint8_t bytes[VS_LEAGUE_RECEIVE_MAX];
  size_t size;
  vs_ssl_frame frame;
  bool seen = false;
  while (vs_udp_receive(&g->vision, bytes, sizeof bytes, &size)) {
    if (size > sizeof bytes || vs_ssl_decode(bytes, size, &frame, NULL) != VS_OK) {
      g->unread++;
      continue;
    }
    if (!frame.detection) continue;
    vs_ssl_world_see(&g->ssl, &frame, vs_clock_monotonic_us(), &g->world);
    seen = true;
  }
  return seen;
}

// The newest world that waits. What it leaves out keeps its place and is not valid.
static bool see_environment(vs_guest *g, uint32_t *step) {
  uint8_t bytes[VS_LEAGUE_RECEIVE_MAX];
  size_t size;
  vs_fira_environment e;
  bool seen = false;
  while (vs_udp_receive(&g->vision, bytes, sizeof bytes, &size)) {
    if (size > sizeof bytes || vs_fira_environment_decode(bytes, size, &e, NULL) != VS_OK) {
      g->unread++;
      continue;
    }
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++) {
        g->world.robot[t][i].valid = e.world.robot[t][i].valid;
        if (e.world.robot[t][i].valid) g->world.robot[t][i] = e.world.robot[t][i];
      }
    g->world.ball.valid = e.world.ball.valid;
    if (e.world.ball.valid) g->world.ball = e.world.ball;
    memcpy(g->game.score, e.goals, sizeof g->game.score);
    g->world.division = e.world.division;
    *step = e.step;
    seen = true;
  }
  return seen;
}

// A new world, with the time since the one before.
static bool see(vs_guest *g, double *dt_s) {
  int64_t before_us = g->world.time_us;
  if (g->def.ssl) {
    if (!see_ssl(g)) return false;
    g->world.time_us = g->ssl.time_us;
    *dt_s = 1e-6 * (double)(g->world.time_us - before_us);
    if (*dt_s > LONGEST_STEP_S) *dt_s = 0; // the first
  } else {
    uint32_t step = 0;
    if (!see_environment(g, &step)) return false;
    g->world.time_us = vs_clock_monotonic_us();
    *dt_s = (double)(step - g->step) * g->def.step_s;
    if (g->stats.worlds == 0 || !(*dt_s > 0 && *dt_s < LONGEST_STEP_S)) *dt_s = g->def.step_s;
    g->step = step;
  }
  g->stats.worlds++;
  g->world.seq++;
  if (g->world.ball.valid) g->ball_us = g->world.time_us;
  return true;
}

vs_status vs_guest_tick(vs_guest *g, vs_guest_tick_result *out, vs_error *err) {
  const vs_udp *sources[] = {&g->vision};
  double dt_s;
  memset(out, 0, sizeof *out);
  vs_udp_wait(sources, 1, vs_clock_monotonic_us() + WAIT_US);
  bool seen = see(g, &dt_s);
  hear_referee(g);
  if (!seen) return VS_OK;
  if (g->world.division != VS_3V3)
    return vs_fail(err, VS_USAGE, "the simulator plays %s, and our team has three robots: start it for 3v3",
                   vs_pitch_of(g->world.division)->name);
  vs_net_task task = vs_net_task_of(g->referee.state, g->word);
  bool plays = task == VS_NET_AT_PLAY, places = task == VS_NET_TO_PLACES && g->has_places, decided = false;
  if (plays) g->game.time_s = fmin(g->game.time_s + dt_s, g->game.duration_s);
  if (plays) {
    vs_status s = vs_control_step(g->control, g->def.team, &g->world, &g->game, dt_s, out->wheels, &decided, err);
    if (s != VS_OK) return s;
  }
  if (places) vs_go_to_step(&g->go_to, &g->world, g->def.team, g->place, out->wheels);
  g->stats.decisions += decided ? 1 : 0;
  vs_safety_input in = {.now_us = vs_clock_monotonic_us(),
                        .armed = vs_net_released(g->referee.state, g->word),
                        .referee = plays || places ? VS_EVENT_NONE : VS_EVENT_HALT,
                        .team = g->def.team,
                        .world = &g->world,
                        .no_ball = g->sender && !places && g->world.time_us - g->ball_us > BALL_HOLD_US,
                        .command_us = g->world.time_us};
  memcpy(in.wheels, out->wheels, sizeof in.wheels);
  out->safety = vs_safety_step(&g->safety, &in, out->wheels);
  bool stop = out->safety != VS_SAFETY_RUNNING;
  if (g->sender) vs_sender_command(g->sender, out->wheels, stop, g->world.time_us, decided || places || stop);
  if (g->command.fd >= 0) send_wheels(g, out->wheels);
  out->seen = true;
  out->world = g->world;
  out->game = g->game;
  out->state = g->referee.state;
  return VS_OK;
}

const vs_guest_stats *vs_guest_get_stats(vs_guest *g) {
  g->stats.calls = g->referee.heard;
  g->stats.garbage = g->unread + g->referee.garbage;
  return &g->stats;
}
