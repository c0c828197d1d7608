#include "vsss/net_referee.h"

#define REFEREE_GROUP "224.5.23.2"

const char *vs_net_state_name(vs_net_state state) {
  static const char *const name[VS_NET_STATES] = {"waiting", "play", "placing", "stopped", "halted"};
  return name[state];
}

vs_net_state vs_net_next(vs_foul foul) {
  switch (foul) {
  case VS_FOUL_GAME_ON: return VS_NET_PLAY;
  case VS_FOUL_STOP: return VS_NET_STOPPED;
  case VS_FOUL_HALT: return VS_NET_HALTED;
  default: return VS_NET_PLACING;
  }
}

bool vs_net_released(vs_net_state state, vs_net_word word) {
  return word == VS_NET_GO || (word == VS_NET_UNSAID && state != VS_NET_WAITING);
}

vs_net_task vs_net_task_of(vs_net_state state, vs_net_word word) {
  if (word == VS_NET_STOP) return VS_NET_STAND;
  switch (state) {
  case VS_NET_WAITING: return word == VS_NET_GO ? VS_NET_AT_PLAY : VS_NET_STAND;
  case VS_NET_PLAY: return VS_NET_AT_PLAY;
  case VS_NET_PLACING: return VS_NET_TO_PLACES;
  default: return VS_NET_STAND;
  }
}

vs_event vs_net_event(const vs_ref_command *call, double time_s) {
  vs_event event = {.team = call->team == VS_YELLOW ? VS_YELLOW : VS_BLUE, .time_s = time_s};
  switch (call->foul) {
  case VS_FOUL_KICKOFF: event.kind = VS_EVENT_KICK_OFF; break;
  case VS_FOUL_PENALTY_KICK: event.kind = VS_EVENT_PENALTY; break;
  case VS_FOUL_FREE_KICK: event.kind = VS_EVENT_FREE_KICK; break;
  case VS_FOUL_GOAL_KICK:
    event.kind = VS_EVENT_GOAL_KICK;
    event.quadrant = call->quadrant;
    break;
  case VS_FOUL_FREE_BALL:
    event.kind = VS_EVENT_FREE_BALL;
    event.quadrant = call->quadrant;
    break;
  case VS_FOUL_HALT: event.kind = VS_EVENT_HALT; break;
  default: event.kind = VS_EVENT_NONE;
  }
  return event;
}

vs_status vs_net_referee_open(int port, int placement_port, const char *interface, vs_net_referee *out, vs_error *err) {
  *out = (vs_net_referee){.calls = VS_UDP_CLOSED, .places = VS_UDP_CLOSED, .call = {.foul = VS_FOULS}};
  vs_status s = vs_league_supported(err);
  if (s == VS_OK) s = vs_udp_join(REFEREE_GROUP, port, interface, &out->calls, err);
  if (s == VS_OK && placement_port) s = vs_udp_sender(REFEREE_GROUP, placement_port, interface, &out->places, err);
  if (s != VS_OK) vs_net_referee_close(out);
  return s;
}

void vs_net_referee_close(vs_net_referee *r) {
  vs_udp_close(&r->calls);
  vs_udp_close(&r->places);
}

bool vs_net_referee_hear(vs_net_referee *r) {
  uint8_t bytes[VS_LEAGUE_RECEIVE_MAX];
  size_t size;
  vs_ref_command call;
  while (vs_udp_receive(&r->calls, bytes, sizeof bytes, &size)) {
    if (size > sizeof bytes || vs_ref_command_decode(bytes, size, &call, NULL) != VS_OK) {
      r->garbage++;
      continue;
    }
    if (vs_ref_command_repeats(&r->call, &call)) continue;
    r->call = call;
    r->state = vs_net_next(call.foul);
    r->heard++;
    return true;
  }
  return false;
}

bool vs_net_referee_tell(const vs_net_referee *r, const vs_ref_placement *placement) {
  uint8_t bytes[VS_LEAGUE_DATAGRAM_MAX];
  if (r->places.fd < 0) return false;
  size_t size = vs_ref_placement_encode(placement, bytes, sizeof bytes);
  return vs_udp_send(&r->places, bytes, size);
}
