#include "serve_replay.h"

#include <inttypes.h>
#include <stdio.h>

#include "cli.h"
#include "vsss/clock.h"
#include "vsss/league_log.h"
#include "vsss/udp.h"

#define LOOK_UP_US 50000 // whether the program ends

static void sleep_until(int64_t due_us) {
  for (int64_t now_us = vs_clock_monotonic_us(); now_us < due_us && !vs_cli_interrupted();
       now_us = vs_clock_monotonic_us())
    vs_clock_sleep_until_us(due_us < now_us + LOOK_UP_US ? due_us : now_us + LOOK_UP_US);
}

static vs_status send_all(vs_league_log *log, const vs_udp to[2], vs_error *err) {
  int64_t sent[2] = {0}, first_ms = 0, start_us = vs_clock_monotonic_us(), last_ms = 0;
  vs_league_entry e;
  bool end = false;
  vs_status s = VS_OK;
  while (s == VS_OK && !vs_cli_interrupted()) {
    s = vs_league_log_next(log, &e, &end, err);
    if (s != VS_OK || end) break;
    if (sent[0] + sent[1] == 0) first_ms = e.time_ms;
    last_ms = e.time_ms;
    sleep_until(start_us + 1000 * (e.time_ms - first_ms));
    vs_udp_send(&to[e.kind], e.data, e.size);
    sent[e.kind]++;
  }
  printf("%" PRId64 " worlds and %" PRId64 " calls of the referee sent again, %.1f s\n", sent[VS_LEAGUE_VISION],
         sent[VS_LEAGUE_REFEREE], 1e-3 * (double)(last_ms - first_ms));
  return s;
}

vs_status serve_replay(const char *path, const vs_ports *ports, const char *interface, vs_error *err) {
  vs_league_log *log = NULL;
  vs_udp claim = VS_UDP_CLOSED, to[2] = {VS_UDP_CLOSED, VS_UDP_CLOSED};
  vs_status s = vs_league_log_open(path, &log, err);
  if (s == VS_OK) s = vs_udp_claim(VS_VISION_GROUP, ports->vision, &claim, err);
  if (s == VS_OK) s = vs_udp_sender(VS_VISION_GROUP, ports->vision, interface, &to[VS_LEAGUE_VISION], err);
  if (s == VS_OK) s = vs_udp_sender(VS_REFEREE_GROUP, ports->referee, interface, &to[VS_LEAGUE_REFEREE], err);
  if (s == VS_OK) s = send_all(log, to, err);
  vs_udp_close(&to[0]);
  vs_udp_close(&to[1]);
  vs_udp_close(&claim);
  vs_league_log_close(log, NULL);
  return s;
}
