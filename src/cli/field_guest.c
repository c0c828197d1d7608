#include "field_guest.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "vsss/clock.h"
#include "vsss/guest.h"
#include "vsss/robot_preset.h"
#include "vsss/serve.h"
#include "world_csv.h"

static const char *rest_of(const char *source, vs_dialect *dialect) {
  for (int d = VS_DIALECT_FIRASIM; d <= VS_DIALECT_TRAVESIM; d++) {
    const char *name = vs_dialect_name((vs_dialect)d);
    size_t length = strlen(name);
    if (strncmp(source, name, length) != 0 || source[length] != ':') continue;
    *dialect = (vs_dialect)d;
    return source + length + 1;
  }
  return NULL;
}

bool field_guest_is(const char *source) {
  vs_dialect unused;
  return source && rest_of(source, &unused);
}

static vs_status fill(const field_guest *o, vs_guest_def *def, vs_error *err) {
  vs_dialect dialect = VS_DIALECT_FIRASIM, radio = VS_DIALECT_FIRASIM;
  vs_ports ports = vs_ports_default(), radio_ports;
  const vs_robot_preset *robot;
  const char *rest = rest_of(o->camera, &dialect), *radio_rest = o->radio ? rest_of(o->radio, &radio) : "";
  if (!rest)
    return vs_fail(err, VS_USAGE,
                   "--radio %.60s needs --camera firasim: or travesim: (its robots are seen nowhere else)", o->radio);
  if (!radio_rest || (o->radio && radio != dialect))
    return vs_fail(err, VS_USAGE, "--camera %.60s needs --radio %s: (or none: a dry run)", o->camera,
                   vs_dialect_name(dialect));
  vs_status s = *rest ? vs_ports_parse(rest, &ports, err) : VS_OK;
  radio_ports = ports;
  if (s == VS_OK && *radio_rest) {
    radio_ports = vs_ports_default();
    s = vs_ports_parse(radio_rest, &radio_ports, err);
  }
  if (s == VS_OK) s = vs_robot_preset_find(vs_dialect_name(dialect), &robot, err);
  if (s != VS_OK) return s;
  bool travesim = dialect == VS_DIALECT_TRAVESIM;
  *def = (vs_guest_def){.policy = o->policy,
                        .team = o->team,
                        .seed = o->seed,
                        .duration_s = o->duration_s,
                        .wheel_radius_m = robot->wheel_radius_m,
                        .step_s = travesim ? 0.01 : 0.001,
                        .vision = ports.vision,
                        .command = travesim ? radio_ports.team[o->team] : radio_ports.command,
                        .referee = ports.referee,
                        .placement = ports.placer,
                        .dry = !o->radio};
  return VS_OK;
}

static vs_status play(const field_guest *o, vs_guest *guest, vs_world_csv *record, vs_error *err) {
  vs_progress progress;
  vs_progress_start(&progress);
  vs_guest_state before = VS_GUEST_PLAY;
  int64_t start_us = vs_clock_monotonic_us(), seen_us = start_us;
  double spent_s = 0;
  bool told = false;
  vs_status s = VS_OK;
  while (s == VS_OK && !vs_cli_interrupted() && (o->seconds == 0.0 || spent_s < o->seconds)) {
    vs_guest_tick_result tick;
    s = vs_guest_tick(guest, &tick, err);
    int64_t now_us = vs_clock_monotonic_us();
    spent_s = 1e-6 * (double)(now_us - start_us);
    if (s != VS_OK) break;
    if (tick.seen) {
      seen_us = now_us;
      told = false;
      vs_world_csv_write(record, &tick.world, VS_EVENT_NONE);
    }
    if (!told && now_us - seen_us > 5000000) {
      vs_progress_clear(&progress);
      printf("no world for 5 s: is the simulator running, and on these ports?\n");
      fflush(stdout);
      told = true;
    }
    if (!tick.seen) continue;
    const vs_game *game = &tick.game;
    if (tick.state != before) {
      vs_progress_clear(&progress);
      printf("%7.2f s  %s, %s  %d : %d\n", game->time_s, vs_event_name(game->last_event.kind),
             vs_guest_state_name(tick.state), game->score[VS_BLUE], game->score[VS_YELLOW]);
      fflush(stdout);
      before = tick.state;
    }
    char text[120];
    snprintf(text, sizeof text, "%d : %d  %5.1f s  %s  %s", game->score[VS_BLUE], game->score[VS_YELLOW], game->time_s,
             vs_guest_state_name(tick.state), vs_safety_name(tick.safety));
    vs_progress_show(&progress, o->seconds > 0 ? spent_s / o->seconds : game->time_s / game->duration_s, text);
  }
  vs_progress_clear(&progress);
  return s;
}

vs_status field_guest_play(const field_guest *o, vs_error *err) {
  vs_guest_def def;
  vs_guest *guest = NULL;
  vs_world_csv record;
  vs_status s = fill(o, &def, err);
  if (s == VS_OK) s = vs_guest_new(&def, &guest, err);
  if (s != VS_OK) return s;
  s = vs_world_csv_open(o->record, &record, err);
  if (s == VS_OK) {
    printf("world from %s, port %d; %s plays %s; commands to port %d%s\n", o->camera, def.vision, o->policy,
           vs_team_name(o->team), def.command, def.dry ? ": none, a dry run (--radio firasim:)" : "");
    fflush(stdout);
    s = play(o, guest, &record, err);
    vs_error at_close = {0};
    if (vs_world_csv_close(&record, &at_close) != VS_OK && s == VS_OK) s = vs_fail(err, VS_FAIL, "%s", at_close.text);
    const vs_guest_stats *stats = vs_guest_get_stats(guest);
    printf("%" PRId64 " worlds, %" PRId64 " decisions, %" PRId64 " calls of the referee, %" PRId64 " placements\n",
           stats->worlds, stats->decisions, stats->calls, stats->placements);
  }
  vs_guest_free(guest);
  return s;
}
