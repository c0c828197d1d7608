// The shell around a hosted match: sockets, whose turn it is, what is worth telling.
#include "vsss/serve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/word.h"
#include "outbox.h"
#include "vsss/clock.h"
#include "vsss/field.h"
#include "vsss/realtime.h"
#include "vsss/udp.h"

enum { TO_LOOPBACK, TO_NETWORK, WAYS };

// A team that plays over the network.
typedef struct remote {
  bool expected;       // it has no local player
  bool awaited;        // sync: the next frame waits for its answer
  unsigned got, wants; // robots commanded since the last frame, and in the one before
  bool silent;         // reported
} remote;

struct vs_serve {
  vs_serve_def def;
  vs_division division;
  vs_hosted *match;
  vs_udp vision, vision_claim;
  vs_udp command, team[VS_TEAMS], placer, referee_in;
  vs_udp referee_out[WAYS];
  vs_outbox *outbox; // real time; from the first frame on
  remote remote[VS_TEAMS];
  vs_ref_command call; // being repeated
  int repeats;         // left
  bool began;          // sync: nobody is waited for at real time any more
  int64_t due_us, period_us;
  int64_t lead_us;      // real time: a frame is played so much before it is due
  int64_t unsent;       // by this thread
  int64_t log_start_ms; // since 1970, of the first frame
  vs_serve_stats stats;
  char note[200];
  uint8_t bytes[VS_LEAGUE_RECEIVE_MAX];
};

static const char *const dialect_names[] = {"firasim", "travesim", NULL};

vs_status vs_dialect_parse(const char *name, vs_dialect *out, vs_error *err) {
  int dialect;
  vs_status s = vs_word_parse("dialect", name, dialect_names, &dialect, err);
  if (s == VS_OK) *out = (vs_dialect)dialect;
  return s;
}

const char *vs_dialect_name(vs_dialect dialect) { return dialect_names[dialect]; }
int vs_dialect_hz(vs_dialect dialect) { return dialect == VS_DIALECT_TRAVESIM ? 100 : 60; }

vs_serve_def vs_serve_def_default(void) {
  return (vs_serve_def){.match = {.referee = vs_referee_def_default(VS_RULES_LEAGUE), .pause_s = 8, .seed = 1},
                        .ports = vs_ports_default(),
                        .answer_s = 1};
}

// --- open and close ---------------------------------------------------------------------------------------------------

static vs_status open_referee(vs_serve *s, vs_error *err) {
  const vs_serve_def *d = &s->def;
  if (d->match.mode == VS_REFEREE_EXTERNAL)
    return vs_udp_join(VS_REFEREE_GROUP, d->ports.referee, d->interface, &s->referee_in, err);
  if (d->match.mode == VS_REFEREE_NONE) return VS_OK;
  vs_status status = vs_udp_join(VS_REFEREE_GROUP, d->ports.placer, d->interface, &s->placer, err);
  // Clients on this machine hear loopback whatever interface they joined on: the placer's membership opens it.
  if (status == VS_OK)
    status = vs_udp_sender(VS_REFEREE_GROUP, d->ports.referee, NULL, &s->referee_out[TO_LOOPBACK], err);
  if (status == VS_OK && d->interface)
    status = vs_udp_sender(VS_REFEREE_GROUP, d->ports.referee, d->interface, &s->referee_out[TO_NETWORK], err);
  return status;
}

static vs_status open_sockets(vs_serve *s, vs_error *err) {
  const vs_serve_def *d = &s->def;
  vs_status status = vs_udp_listen(d->ports.command, d->interface, &s->command, err);
  for (int t = 0; t < VS_TEAMS && status == VS_OK && d->dialect == VS_DIALECT_TRAVESIM; t++)
    status = vs_udp_listen(d->ports.team[t], d->interface, &s->team[t], err);
  if (status == VS_OK) status = vs_udp_claim(VS_VISION_GROUP, d->ports.vision, &s->vision_claim, err);
  if (status == VS_OK) status = vs_udp_sender(VS_VISION_GROUP, d->ports.vision, d->interface, &s->vision, err);
  return status == VS_OK ? open_referee(s, err) : status;
}

vs_status vs_serve_new(const vs_serve_def *def, vs_serve **out, vs_error *err) {
  vs_status status = vs_league_supported(err);
  if (status != VS_OK) return status;
  vs_serve *s = calloc(1, sizeof *s);
  if (!s) return vs_fail(err, VS_FAIL, "out of memory");
  vs_udp *all[] = {&s->vision, &s->vision_claim, &s->command,        &s->team[0],       &s->team[1],
                   &s->placer, &s->referee_in,   &s->referee_out[0], &s->referee_out[1]};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) *all[i] = VS_UDP_CLOSED;
  s->def = *def;
  s->division = vs_model_division(def->match.model);
  s->period_us = 1000000 / vs_model_frame_hz(def->match.model);
  for (int t = 0; t < VS_TEAMS; t++) s->remote[t].expected = !def->match.player[t];
  status = vs_hosted_new(&def->match, &s->match, err);
  if (status == VS_OK) status = open_sockets(s, err);
  if (status != VS_OK) {
    vs_serve_free(s);
    return status;
  }
  *out = s;
  return VS_OK;
}

void vs_serve_free(vs_serve *s) {
  if (!s) return;
  vs_outbox_free(s->outbox);
  vs_udp *all[] = {&s->vision, &s->vision_claim, &s->command,        &s->team[0],       &s->team[1],
                   &s->placer, &s->referee_in,   &s->referee_out[0], &s->referee_out[1]};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) vs_udp_close(all[i]);
  vs_hosted_free(s->match);
  free(s);
}

// --- what comes -------------------------------------------------------------------------------------------------------

static void hear_team(vs_serve *s, vs_team team) {
  remote *r = &s->remote[team];
  if (!s->stats.team[team].heard) snprintf(s->note, sizeof s->note, "%s is here", vs_team_name(team));
  if (r->silent) snprintf(s->note, sizeof s->note, "%s is heard again", vs_team_name(team));
  s->stats.team[team].heard = true;
  r->silent = false;
  r->awaited = true;
}

static bool saturates(const vs_serve *s, vs_wheels wheels) {
  vs_wheels ours = vs_robot_preset_wheels(s->def.match.robot, wheels);
  return fabs(ours.left_radps) > VS_WHEEL_LIMIT_RADPS || fabs(ours.right_radps) > VS_WHEEL_LIMIT_RADPS;
}

// only: the team whose port it came to; -1: any.
static void take_commands(vs_serve *s, const vs_fira_packet *p, int only) {
  bool counted[VS_TEAMS] = {false};
  for (int k = 0; k < p->commands; k++) {
    vs_team team = p->command[k].team;
    if ((only >= 0 && (int)team != only) ||
        !vs_hosted_command(s->match, team, p->command[k].robot, p->command[k].wheels)) {
      s->stats.foreign++;
      continue;
    }
    vs_team_traffic *traffic = &s->stats.team[team];
    traffic->commands++;
    traffic->packets += counted[team] ? 0 : 1;
    traffic->saturated += saturates(s, p->command[k].wheels) ? 1 : 0;
    counted[team] = true;
    hear_team(s, team);
    s->remote[team].got |= 1u << p->command[k].robot;
  }
}

enum { CAN_COMMAND = 1, CAN_REPLACE = 2 };

static void read_packets(vs_serve *s, const vs_udp *from, int can, int only) {
  size_t size;
  vs_fira_packet p;
  bool degrees = s->def.dialect == VS_DIALECT_FIRASIM;
  while (vs_udp_receive(from, s->bytes, sizeof s->bytes, &size)) {
    if (size > sizeof s->bytes || vs_fira_packet_decode(s->bytes, size, degrees, &p, NULL) != VS_OK) {
      s->stats.garbage++;
      continue;
    }
    vs_fira_packet_fit(&p, s->division);
    s->stats.dropped += p.dropped;
    if (can & CAN_COMMAND)
      take_commands(s, &p, only);
    else
      s->stats.foreign += p.commands;
    if (!(can & CAN_REPLACE))
      s->stats.refused_replacements += p.robots + (p.places_ball ? 1 : 0);
    else if (!vs_hosted_replace(s->match, &p))
      s->stats.refused_replacements += p.robots + (p.places_ball ? 1 : 0);
  }
}

static void read_placements(vs_serve *s) {
  size_t size;
  vs_ref_placement p;
  vs_error why = {0};
  while (vs_udp_receive(&s->placer, s->bytes, sizeof s->bytes, &size)) {
    if (size > sizeof s->bytes || vs_ref_placement_decode(s->bytes, size, &p, &why) != VS_OK) {
      s->stats.garbage++;
      continue;
    }
    if (!s->remote[p.team].expected) continue;
    if (!s->stats.team[p.team].heard) hear_team(s, p.team);
    if (vs_hosted_place(s->match, &p, &why) == VS_OK) {
      s->stats.team[p.team].placements++;
    } else {
      s->stats.team[p.team].illegal_placements++;
      snprintf(s->note, sizeof s->note, "%s placed illegally: %.120s", vs_team_name(p.team), why.text);
    }
  }
}

static void read_referee(vs_serve *s) {
  size_t size;
  vs_ref_command call;
  while (vs_udp_receive(&s->referee_in, s->bytes, sizeof s->bytes, &size)) {
    if (size > sizeof s->bytes || vs_ref_command_decode(s->bytes, size, &call, NULL) != VS_OK)
      s->stats.garbage++;
    else
      vs_hosted_hear(s->match, &call);
  }
}

static void listen_now(vs_serve *s) {
  if (s->def.dialect == VS_DIALECT_TRAVESIM) {
    read_packets(s, &s->command, CAN_REPLACE, -1);
    for (int t = 0; t < VS_TEAMS; t++) read_packets(s, &s->team[t], CAN_COMMAND, t);
  } else {
    read_packets(s, &s->command, CAN_COMMAND | CAN_REPLACE, -1);
  }
  read_placements(s);
  read_referee(s);
}

// --- whose turn it is -------------------------------------------------------------------------------------------------

// Some clients send a datagram for each robot: all that it commanded last time make an answer.
static bool answered(const remote *r) { return !r->awaited || (r->got && (r->got & r->wants) == r->wants); }
static bool began_to_answer(const remote *r) { return !r->awaited || r->got; }
#define REST_OF_ANSWER_US 3000
#define LOOK_UP_US        50000 // whether the program ends

static void wait_until(const vs_serve *s, int64_t until_us) {
  const vs_udp *all[] = {&s->command, &s->team[0], &s->team[1], &s->placer, &s->referee_in};
  vs_udp_wait(all, 5, until_us);
}

// A frame is played a little before it is due and sent when it is: the longest that one took of late from when it should have
// begun, and half as much again. Commands that come meanwhile act a frame later.
static void learn_lead(vs_serve *s, int64_t took_us) {
  int64_t wanted_us = took_us + took_us / 2, most_us = s->period_us * 3 / 4;
  if (wanted_us > most_us) wanted_us = most_us;
  s->lead_us = wanted_us > s->lead_us ? wanted_us : s->lead_us - (s->lead_us - wanted_us) / 64;
}

static void listen_in_real_time(vs_serve *s) {
  int64_t now_us = vs_clock_monotonic_us();
  if (s->due_us == 0) vs_realtime_fine_timers();
  if (s->due_us == 0 || now_us - s->due_us > 10 * s->period_us) s->due_us = now_us; // stopped and continued
  for (int64_t until_us = s->due_us - s->lead_us; now_us < until_us; now_us = vs_clock_monotonic_us()) {
    wait_until(s, until_us);
    listen_now(s);
  }
  listen_now(s);
}

static void listen_for_answers(vs_serve *s) {
  bool play = vs_hosted_phase(s->match) == VS_PHASE_PLAY;
  double patience_s = play ? s->def.answer_s : fmin(s->def.answer_s, 0.1);
  int64_t until_us = vs_clock_monotonic_us() + (int64_t)(1e6 * patience_s);
  bool rest = false;
  listen_now(s);
  while (!answered(&s->remote[VS_BLUE]) || !answered(&s->remote[VS_YELLOW])) {
    int64_t now_us = vs_clock_monotonic_us();
    if (!rest && began_to_answer(&s->remote[VS_BLUE]) && began_to_answer(&s->remote[VS_YELLOW])) {
      rest = true;
      until_us = now_us + REST_OF_ANSWER_US;
    }
    if (now_us >= until_us || (s->def.ends && s->def.ends())) break;
    wait_until(s, until_us < now_us + LOOK_UP_US ? until_us : now_us + LOOK_UP_US);
    listen_now(s);
  }
  for (int t = 0; t < VS_TEAMS; t++) {
    remote *r = &s->remote[t];
    if (!answered(r)) r->awaited = r->got != 0;
    if (r->got) r->wants = r->got;
    r->got = 0;
  }
}

static void watch_silence(vs_serve *s) {
  if (vs_hosted_phase(s->match) != VS_PHASE_PLAY || s->def.match.mode == VS_REFEREE_NONE) return;
  for (int t = 0; t < VS_TEAMS; t++) {
    remote *r = &s->remote[t];
    if (!r->expected || vs_hosted_silence_s(s->match, (vs_team)t) <= VS_SILENCE_REPORT_S) continue;
    s->stats.team[t].silent_s += 1e-6 * (double)s->period_us;
    if (r->silent) continue;
    r->silent = true;
    s->stats.team[t].silences++;
    snprintf(s->note, sizeof s->note, "%s is silent: its last commands are held", vs_team_name((vs_team)t));
  }
}

// --- what goes out ----------------------------------------------------------------------------------------------------

static void send_on(vs_serve *s, const vs_udp *to, size_t size) {
  if (!vs_udp_send(to, s->bytes, size)) s->unsent++;
}

// Stamped by the match's clock: a match in --sync is watched at its own pace.
static void log_sent(vs_serve *s, vs_league_kind kind, size_t size) {
  if (!s->def.log) return;
  if (s->log_start_ms == 0) s->log_start_ms = vs_clock_wall_us() / 1000;
  vs_league_log_put(s->def.log, s->log_start_ms + vs_hosted_world(s->match)->time_us / 1000, kind, s->bytes, size);
}

static size_t write_world(vs_serve *s) {
  const vs_game *game = vs_hosted_game(s->match);
  vs_fira_environment e = {.world = *vs_hosted_world(s->match)};
  int64_t tick_us = s->def.dialect == VS_DIALECT_TRAVESIM ? 10000 : 1000;
  e.step = (uint32_t)(e.world.time_us / tick_us);
  memcpy(e.goals, game->score, sizeof e.goals);
  size_t most = s->division == VS_3V3 ? VS_LEAGUE_DATAGRAM_MAX : VS_LEAGUE_DATAGRAM_5V5_MAX;
  size_t size = vs_fira_environment_encode(&e, s->bytes, most);
  log_sent(s, VS_LEAGUE_VISION, size);
  return size;
}

static void send_world_now(vs_serve *s) {
  vs_outbox_flush(s->outbox);
  send_on(s, &s->vision, write_world(s));
}

static vs_status send_world_when_due(vs_serve *s, vs_error *err) {
  // As late as this: with the priority that the thread has by now.
  vs_status status = s->outbox ? VS_OK : vs_outbox_new(&s->vision, &s->outbox, err);
  if (status == VS_OK) vs_outbox_put(s->outbox, s->bytes, write_world(s), s->due_us);
  return status;
}

static void send_call(vs_serve *s, int times) {
  size_t size = vs_ref_command_encode(&s->call, s->bytes, sizeof s->bytes);
  for (; times > 0; times--, s->repeats--) {
    send_on(s, &s->referee_out[TO_LOOPBACK], size);
    log_sent(s, VS_LEAGUE_REFEREE, size);
    if (s->referee_out[TO_NETWORK].fd >= 0) send_on(s, &s->referee_out[TO_NETWORK], size);
  }
}

// Each call goes out once at once, the rest of its repeats with the following frames or before the next call.
static void send_calls(vs_serve *s, const vs_hosted_said *said) {
  for (int k = 0; k < said->calls; k++) {
    send_call(s, s->repeats);
    s->call = said->call[k];
    s->repeats = VS_REFEREE_REPEATS;
    send_call(s, 1);
  }
  if (said->calls == 0 && s->repeats > 0) send_call(s, 1);
  if (vs_hosted_phase(s->match) == VS_PHASE_OVER) send_call(s, s->repeats);
}

vs_status vs_serve_frame(vs_serve *s, vs_hosted_said *said, char *note, size_t note_size, vs_error *err) {
  s->note[0] = '\0';
  bool at_once = s->def.sync && vs_hosted_phase(s->match) != VS_PHASE_WAIT && (s->began || vs_serve_everybody_here(s));
  if (at_once)
    listen_for_answers(s);
  else
    listen_in_real_time(s);
  if (vs_hosted_phase(s->match) == VS_PHASE_WAIT && vs_serve_everybody_here(s)) vs_hosted_begin(s->match);
  // Open play has no beginning: it starts to hurry when its teams are here.
  if (vs_hosted_phase(s->match) != VS_PHASE_WAIT && s->def.match.mode == VS_REFEREE_OWN) s->began = true;
  watch_silence(s);
  vs_status status = vs_hosted_frame(s->match, said, err);
  if (status != VS_OK) return status;
  // The call first: who has seen this world has then heard of it.
  if (s->def.match.mode == VS_REFEREE_OWN) send_calls(s, said);
  if (at_once) {
    send_world_now(s);
  } else {
    learn_lead(s, vs_clock_monotonic_us() - (s->due_us - s->lead_us));
    status = send_world_when_due(s, err);
    if (status != VS_OK) return status;
  }
  s->due_us += s->period_us;
  s->stats.frames++;
  if (note) snprintf(note, note_size, "%s", s->note);
  return VS_OK;
}

vs_hosted *vs_serve_match(vs_serve *s) { return s->match; }
const vs_serve_stats *vs_serve_get_stats(vs_serve *s) {
  vs_histogram late = {0};
  int64_t unsent = 0;
  if (s->outbox) vs_outbox_told(s->outbox, &late, &unsent);
  if (!s->def.sync) s->stats.late = late;
  s->stats.unsent = s->unsent + unsent;
  return &s->stats;
}

bool vs_serve_everybody_here(const vs_serve *s) {
  for (int t = 0; t < VS_TEAMS; t++)
    if (s->remote[t].expected && !s->stats.team[t].heard) return false;
  return true;
}
