// One question, one answer: VSSS_STATE with asks_team set, then VSSS_CMD of that team with state_seq equal to the
// state's seq. The match waits for the answer, so that a slow machine plays the same match; a question or answer that
// the network lost is asked again. For one match at a time.
#include "player_lcm.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/bus.h"
#include "vsss/clock.h"

#define ASK_AGAIN_US 50000

typedef struct remote {
  vs_bus *bus;
  vs_team team;
  int timeout_ms;
  int far; // answers of another machine count too
  uint32_t seq;
  bool answered;
  vs_wheels answer[VS_TEAM_SIZE];
  char failure[256];
} remote;

static void on_command(const vs_message *m, void *user) {
  remote *r = user;
  if (m->as.cmd.team != r->team || m->as.cmd.state_seq != (int32_t)r->seq) return;
  memcpy(r->answer, m->as.cmd.wheels, sizeof r->answer);
  r->answered = true;
}

// "yellow", "yellow?timeout_ms=500&url=udpm://...": url takes all that follows it.
static vs_status parse(const char *text, remote *r, const char **url, vs_error *err) {
  size_t name = strcspn(text, "?");
  if (name == 4 && !strncmp(text, "blue", 4))
    r->team = VS_BLUE;
  else if (name == 6 && !strncmp(text, "yellow", 6))
    r->team = VS_YELLOW;
  else
    return vs_fail(err, VS_USAGE, "lcm:%.60s: expected the team it plays, lcm:blue or lcm:yellow", text);
  r->timeout_ms = 2000;
  *url = vs_bus_default_url();
  const char *at = text + name + (text[name] == '?');
  while (*at) {
    int used = 0;
    if (!strncmp(at, "url=", 4)) {
      *url = at + 4;
      return VS_OK;
    }
    bool known =
        sscanf(at, "timeout_ms=%d%n", &r->timeout_ms, &used) == 1 || sscanf(at, "remote=%d%n", &r->far, &used) == 1;
    if (!known || (at[used] && at[used] != '&') || r->timeout_ms < 1 || r->timeout_ms > 600000 || r->far >> 1)
      return vs_fail(err, VS_USAGE,
                     "lcm: option '%.80s': allowed are timeout_ms=1 to 600000, remote=1 (the player is on another "
                     "machine), then url=URL",
                     at);
    at += used + (at[used] == '&');
  }
  return VS_OK;
}

static remote *remote_of(const void *state) { return *(remote *const *)state; }

static void end(void *state) {
  remote *r = remote_of(state);
  if (r) vs_bus_close(r->bus);
  free(r);
  *(remote **)state = NULL;
}

static vs_status start(void *state, uint64_t seed, const char *options, vs_error *err) {
  remote *r = calloc(1, sizeof *r);
  if (!r) return vs_fail(err, VS_FAIL, "out of memory");
  *(remote **)state = r;
  const char *url = NULL;
  vs_status s = parse(options, r, &url, err);
  if (s == VS_OK && strncmp(url, "udpm://", 7) != 0)
    s = vs_fail(err, VS_USAGE, "lcm: url %.100s: only udpm:// reaches another process", url);
  if (s == VS_OK) s = vs_bus_open(url, &r->bus, err);
  if (s == VS_OK)
    s = r->far ? vs_bus_subscribe(r->bus, VS_CH_CMD, false, on_command, r, err)
               : vs_bus_subscribe_near(r->bus, VS_CH_CMD, on_command, r, err);
  // Numbers that answers to an earlier match do not have.
  r->seq = (uint32_t)(vs_clock_monotonic_us() ^ (int64_t)seed) & 0x3fffffff;
  if (s != VS_OK) end(state);
  return s;
}

static void step(void *state, const vs_world *view, const vs_game *game, double dt_s, vs_wheels out[VS_TEAM_SIZE]) {
  (void)dt_s;
  remote *r = remote_of(state);
  vs_message m = {.channel = VS_CH_STATE, .utime_capture_us = vs_clock_wall_us()};
  // Back from the team's view to the absolute frame of the wire: turning is its own inverse.
  vs_world_for_team(view, r->team, &m.as.world.world);
  vs_game_for_team(game, r->team, &m.as.world.game);
  m.as.world.world.seq = ++r->seq;
  m.as.world.asks_team = r->team;
  r->answered = false;
  r->failure[0] = '\0';
  int64_t start_us = vs_clock_monotonic_us(), ask_us = start_us, now_us = start_us;
  vs_error err = {0};
  vs_status s = VS_OK;
  while (s == VS_OK && !r->answered && now_us - start_us <= 1000LL * r->timeout_ms) {
    if (now_us >= ask_us) {
      s = vs_bus_publish(r->bus, &m, &err);
      ask_us = now_us + ASK_AGAIN_US;
    }
    if (s == VS_OK) s = vs_bus_handle(r->bus, 10, NULL, &err);
    now_us = vs_clock_monotonic_us();
  }
  memset(out, 0, VS_TEAM_SIZE * sizeof *out);
  if (s != VS_OK)
    snprintf(r->failure, sizeof r->failure, "%s", err.text);
  else if (!r->answered)
    snprintf(r->failure, sizeof r->failure,
             "no answer within %d ms on %.80s; is the player running, and does its VSSS_CMD carry team %d and the "
             "state's seq?",
             r->timeout_ms, vs_bus_url(r->bus), r->team);
  else
    memcpy(out, r->answer, sizeof r->answer);
}

static const char *failure(const void *state) {
  const remote *r = remote_of(state);
  return r->failure[0] ? r->failure : NULL;
}

static const vsss_player_api api = {
    .version = VSSS_PLAYER_VERSION,
    .name = "LCM",
    .rate_hz = VS_CAMERA_HZ,
    .state_size = 0,
    .init = start,
    .step = step,
    .free = end,
};

vs_status player_lcm_open(const char *rest, vs_player_given *out, vs_error *err) {
  (void)err; // a wrong rest is the init's to refuse
  *out = (vs_player_given){.api = &api, .options = rest, .failure = failure};
  return VS_OK;
}
