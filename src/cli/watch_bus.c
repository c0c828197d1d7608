// A match on LCM. Truth, measured state and commands go out every frame, events and decisions as they happen.
#include <stdio.h>
#include <stdlib.h>

#include "vsss/bus.h"
#include "vsss/clock.h"
#include "watch.h"

typedef struct bus_watch {
  vs_bus *bus;
  const char *uri[VS_TEAMS];
  int32_t seq[VS_CHANNELS];
  int64_t start_us, capture_us; // since the epoch: when this match began, and its present moment in simulated time
  int64_t sent, lost;
  vs_message message; // scratch
} bus_watch;

// A message that cannot be sent is counted, and the match goes on.
static void send(bus_watch *w, vs_channel channel) {
  w->message.channel = channel;
  w->message.utime_us = 0;
  w->message.utime_capture_us = w->capture_us;
  w->message.seq = w->seq[channel]++;
  w->sent++;
  w->lost += vs_bus_publish(w->bus, &w->message, NULL) != VS_OK;
}

static void send_worlds(bus_watch *w, const vs_env *env) {
  vs_msg_world *m = &w->message.as.world;
  m->game = *vs_env_game(env);
  m->asks_team = -1;
  vs_env_truth(env, &m->world);
  send(w, VS_CH_TRUTH);
  vs_env_measured(env, &m->world);
  send(w, VS_CH_STATE);
}

static void send_commands(bus_watch *w, const vs_env *env) {
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
  vs_world measured;
  vs_env_wheels(env, wheels);
  vs_env_measured(env, &measured);
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_msg_cmd *m = &w->message.as.cmd;
    m->team = (vs_team)t;
    m->division = measured.division;
    for (int i = 0; i < VS_TEAM_MOST; i++) m->wheels[i] = wheels[t][i];
    m->stop = false;
    m->state_seq = (int64_t)measured.seq - 1; // decided on the frame before
    snprintf(m->source, sizeof m->source, "%s", w->uri[t]);
    send(w, VS_CH_CMD);
  }
}

static void send_decisions(bus_watch *w, vs_env *env) {
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_control *control = vs_env_control(env, (vs_team)t);
    const vs_player *player = vs_control_player(control);
    if (!player || vs_player_kind(player) != VS_SEES_OBSERVATION || !vs_env_decided(env, (vs_team)t)) continue;
    if (!vs_control_observer(control)->filled) continue; // a restart in this very frame has emptied it
    vs_msg_policy *m = &w->message.as.policy;
    m->team = (vs_team)t;
    m->contract_hash = vs_contract_hash();
    vs_observer_write(vs_control_observer(control), &m->observation[0][0]);
    const float *action = vs_control_action(control);
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      for (int k = 0; k < VS_ACTION_SIZE; k++) m->action[i][k] = action[i * VS_ACTION_SIZE + k];
    snprintf(m->player, sizeof m->player, "%s", w->uri[t]);
    send(w, VS_CH_POLICY);
  }
}

static void send_event(bus_watch *w, const vs_env *env, const vs_event *event) {
  const vs_game *game = vs_env_game(env);
  vs_msg_referee *m = &w->message.as.referee;
  m->event = *event;
  m->duration_s = game->duration_s;
  for (int t = 0; t < VS_TEAMS; t++) m->score[t] = game->score[t];
  send(w, VS_CH_REFEREE);
}

static vs_status frame(void *state, const vs_watch_view *view, vs_error *err) {
  (void)err;
  bus_watch *w = state;
  vs_world truth;
  vs_env_truth(view->env, &truth);
  if (truth.time_us == 0) w->start_us = vs_clock_wall_us();
  w->capture_us = w->start_us + truth.time_us;
  send_worlds(w, view->env);
  if (truth.time_us > 0) {
    send_commands(w, view->env);
    send_decisions(w, view->env);
  }
  if (view->event->kind != VS_EVENT_NONE) send_event(w, view->env, view->event);
  return VS_OK;
}

static vs_status close_bus(void *state, vs_error *err) {
  (void)err;
  bus_watch *w = state;
  if (w->lost)
    fprintf(stderr, "vsss sim: %lld of %lld messages could not be sent over %s\n", (long long)w->lost,
            (long long)w->sent, vs_bus_url(w->bus));
  vs_bus_close(w->bus);
  free(w);
  return VS_OK;
}

vs_status vs_watch_bus(const char *url, const char *const uri[VS_TEAMS], vs_watcher *out, vs_error *err) {
  bus_watch *w = calloc(1, sizeof *w);
  if (!w) return vs_fail(err, VS_FAIL, "out of memory for LCM messages");
  vs_status s = vs_bus_open(url, &w->bus, err);
  if (s != VS_OK) {
    free(w);
    return s;
  }
  for (int t = 0; t < VS_TEAMS; t++) w->uri[t] = uri[t];
  *out = (vs_watcher){w, frame, close_bus};
  return VS_OK;
}
