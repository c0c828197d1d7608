#include "field_publish.h"

#include <string.h>

#include "field_guest.h"

vs_status field_publish_open(const char *where, const char *interface, field_publish *p, vs_error *err) {
  vs_ports ports = vs_ports_default();
  *p = (field_publish){.to = VS_UDP_CLOSED, .claim = VS_UDP_CLOSED};
  if (!where) return VS_OK;
  const char *rest = field_guest_rest(where, &p->dialect);
  if (!rest) return vs_fail(err, VS_USAGE, "--publish %.60s: expected firasim:[PORTS] or travesim:[PORTS]", where);
  vs_status s = vs_league_supported(err);
  if (s == VS_OK && *rest) s = vs_ports_parse(rest, &ports, err);
  p->port = ports.vision;
  if (s == VS_OK) s = vs_udp_claim(VS_VISION_GROUP, p->port, &p->claim, err);
  if (s == VS_OK) s = vs_udp_sender(VS_VISION_GROUP, p->port, interface, &p->to, err);
  if (s == VS_OK) return VS_OK;
  field_publish_close(p);
  vs_fail_prefix(err, "--publish %.60s", where);
  return s;
}

void field_publish_close(field_publish *p) {
  vs_udp_close(&p->to);
  vs_udp_close(&p->claim);
}

void field_publish_world(field_publish *p, const vs_world *world, const vs_game *game) {
  uint8_t bytes[VS_LEAGUE_DATAGRAM_MAX];
  if (p->to.fd < 0) return;
  if (!p->start_us) p->start_us = world->time_us;
  vs_fira_environment e = {.world = *world};
  e.step = (uint32_t)((world->time_us - p->start_us) / (p->dialect == VS_DIALECT_TRAVESIM ? 10000 : 1000));
  memcpy(e.goals, game->score, sizeof e.goals);
  size_t size = vs_fira_environment_encode(&e, bytes, sizeof bytes);
  if (size) vs_udp_send(&p->to, bytes, size); // what nobody takes is nobody's loss
}
