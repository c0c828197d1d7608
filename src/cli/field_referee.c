#include "field_referee.h"

#include <stdio.h>
#include <string.h>

#include "vsss/serve.h"

#define NAME "network"

bool field_referee_is(const char *source) {
  size_t n = strlen(NAME);
  return source && strncmp(source, NAME, n) == 0 && (source[n] == '\0' || source[n] == ':');
}

vs_status field_referee_open(const char *source, bool go, const char *interface, field_referee *r, vs_error *err) {
  vs_ports ports = vs_ports_default();
  *r =
      (field_referee){.net = {.calls = VS_UDP_CLOSED, .places = VS_UDP_CLOSED}, .word = go ? VS_NET_GO : VS_NET_UNSAID};
  if (!field_referee_is(source)) return VS_OK;
  const char *rest = source[strlen(NAME)] ? source + strlen(NAME) + 1 : "";
  vs_status s = *rest ? vs_ports_parse(rest, &ports, err) : VS_OK;
  if (s == VS_OK) s = vs_net_referee_open(ports.referee, 0, interface, &r->net, err);
  r->on = s == VS_OK;
  return s;
}

void field_referee_close(field_referee *r) {
  if (r->on) vs_net_referee_close(&r->net);
}

static void apply(const field_referee *r, vs_field *field) {
  static const vs_field_task tasks[] = {VS_FIELD_STAND, VS_FIELD_PLACE, VS_FIELD_PLAY};
  vs_field_task task = tasks[vs_net_task_of(r->net.state, r->word)];
  vs_field_set_task(field, task == VS_FIELD_PLACE && !r->has_places ? VS_FIELD_STAND : task);
  vs_field_arm(field, vs_net_released(r->net.state, r->word));
}

void field_referee_order(field_referee *r, vs_field *field, vs_order order) {
  r->word = order == VS_ORDER_GO ? VS_NET_GO : VS_NET_STOP;
  if (r->on)
    apply(r, field);
  else
    vs_field_arm(field, order == VS_ORDER_GO);
}

bool field_referee_hear(field_referee *r, vs_field *field, char *text, size_t size) {
  bool news = false;
  while (r->on && vs_net_referee_hear(&r->net)) {
    vs_event event = vs_net_event(&r->net.call, r->net.call.timestamp_s);
    r->has_places = r->net.state == VS_NET_PLACING && event.kind != VS_EVENT_NONE;
    if (!r->has_places) event.kind = VS_EVENT_NONE; // HALT is a state, not what play goes on from
    vs_field_tell(field, &event);
    apply(r, field);
    snprintf(text, size, "referee: %s%s%s: %s", vs_foul_name(r->net.call.foul), r->net.call.team < 0 ? "" : " for ",
             r->net.call.team < 0 ? "" : vs_team_name((vs_team)r->net.call.team), vs_net_state_name(r->net.state));
    news = true;
  }
  return news;
}
