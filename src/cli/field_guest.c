#include "field_guest.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "field_publish.h"
#include "operator.h"
#include "vsss/clock.h"
#include "vsss/guest.h"
#include "vsss/number.h"
#include "vsss/robot_preset.h"
#include "vsss/serve.h"
#include "vsss/ssl_vision.h"
#include "world_csv.h"

const char *field_guest_rest(const char *source, vs_dialect *dialect) {
  for (int d = VS_DIALECT_FIRASIM; d <= VS_DIALECT_TRAVESIM; d++) {
    const char *name = vs_dialect_name((vs_dialect)d);
    size_t length = strlen(name);
    if (strncmp(source, name, length) != 0 || source[length] != ':') continue;
    *dialect = (vs_dialect)d;
    return source + length + 1;
  }
  return NULL;
}

static const char *shared_rest(const char *source, bool *unicast) {
  static const char *const name[] = {"ssl:", "vss-vision:"};
  for (int k = 0; source && k < 2; k++) {
    *unicast = k == 1;
    if (strncmp(source, name[k], strlen(name[k])) == 0) return source + strlen(name[k]);
  }
  return NULL;
}

bool field_guest_is(const char *source) {
  vs_dialect unused;
  bool unicast;
  return source && (field_guest_rest(source, &unused) || shared_rest(source, &unicast));
}

// Nothing: the port that is usual; +N: that and N, as for the simulators; else the port itself.
static bool shared_port(const char *rest, bool unicast, int *out) {
  int number = 0;
  if (*rest && !vs_parse_whole(rest + (*rest == '+'), &number)) return false;
  bool from_usual = !*rest || *rest == '+';
  if (number < 0 || number > 65535 || (from_usual && unicast)) return false;
  *out = from_usual ? VS_SSL_PORT + number : number;
  return *out >= 1024 && *out <= 65535;
}

// A shared vision: its port, and to whom the commands go.
static vs_status fill_shared(const field_guest *o, const char *rest, bool unicast, vs_guest_def *def, vs_error *err) {
  vs_dialect dialect = VS_DIALECT_FIRASIM;
  vs_ports ports = vs_ports_default();
  const char *simulator = o->radio ? field_guest_rest(o->radio, &dialect) : NULL;
  int port;
  if (!shared_port(rest, unicast, &port))
    return vs_fail(err, VS_USAGE, "--camera %.60s: expected %s, 1024 to 65535", o->camera,
                   unicast ? "vss-vision:PORT" : "ssl:, ssl:PORT or ssl:+N");
  vs_status s = simulator && *simulator ? vs_ports_parse(simulator, &ports, err) : VS_OK;
  const vs_robot_preset *robot;
  if (s == VS_OK) s = vs_robot_preset_find(vs_dialect_name(dialect), &robot, err);
  if (s != VS_OK) return s;
  *def = (vs_guest_def){.wheel_radius_m = robot->wheel_radius_m,
                        .ssl = true,
                        .unicast = unicast,
                        .vision = port,
                        .command = dialect == VS_DIALECT_TRAVESIM ? ports.team[o->team] : ports.command,
                        .referee = ports.referee,
                        .placement = ports.placer,
                        .radio = simulator || !o->radio ? NULL : o->sender};
  return VS_OK;
}

static vs_status fill_simulator(const field_guest *o, vs_guest_def *def, vs_error *err) {
  vs_dialect dialect = VS_DIALECT_FIRASIM, radio = VS_DIALECT_FIRASIM;
  vs_ports ports = vs_ports_default(), radio_ports;
  const vs_robot_preset *robot;
  const char *rest = field_guest_rest(o->camera, &dialect),
             *radio_rest = o->radio ? field_guest_rest(o->radio, &radio) : "";
  if (!rest)
    return vs_fail(err, VS_USAGE,
                   "--radio %.60s needs --camera firasim:, travesim: or ssl: (its robots are seen nowhere else)",
                   o->radio);
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
  *def = (vs_guest_def){.wheel_radius_m = robot->wheel_radius_m,
                        .step_s = travesim ? 0.01 : 0.001,
                        .vision = ports.vision,
                        .command = travesim ? radio_ports.team[o->team] : radio_ports.command,
                        .referee = ports.referee,
                        .placement = ports.placer};
  return VS_OK;
}

static vs_status fill(const field_guest *o, vs_guest_def *def, vs_error *err) {
  bool unicast;
  const char *shared = shared_rest(o->camera, &unicast);
  vs_status s = shared ? fill_shared(o, shared, unicast, def, err) : fill_simulator(o, def, err);
  def->policy = o->policy;
  def->team = o->team;
  def->seed = o->seed;
  def->duration_s = o->duration_s;
  def->go = o->go;
  def->interface = o->interface;
  def->dry = !o->radio;
  return s;
}

typedef struct watch {
  vs_progress progress;
  vs_net_state before;
  int64_t start_us, seen_us;
  bool told; // that no world comes
} watch;

static double spent_s(const watch *w) { return 1e-6 * (double)(vs_clock_monotonic_us() - w->start_us); }

static void tell(watch *w, const char *text) {
  vs_progress_clear(&w->progress);
  printf("%s\n", text);
  fflush(stdout);
}

// False: the operator ends play.
static bool obey(vs_operator *operator_, vs_guest *guest, watch *w) {
  char unknown[24], text[96];
  vs_order order = vs_operator_poll(operator_, unknown);
  if (order == VS_ORDER_NONE) return true;
  vs_guest_arm(guest, order == VS_ORDER_GO);
  if (*unknown)
    snprintf(text, sizeof text, "referee: '%s' is none of go, stop, halt; stopped", unknown);
  else
    snprintf(text, sizeof text, "%8.2f s  %s", spent_s(w), order == VS_ORDER_GO ? "go" : "stop");
  if (order != VS_ORDER_QUIT) tell(w, text);
  return order != VS_ORDER_QUIT;
}

static void watch_silence(watch *w, bool seen) {
  int64_t now_us = vs_clock_monotonic_us();
  if (seen) {
    w->seen_us = now_us;
    w->told = false;
  } else if (!w->told && now_us - w->seen_us > 5000000) {
    tell(w, "no world for 5 s: is the simulator running, and on these ports?");
    w->told = true;
  }
}

static void show(const field_guest *o, watch *w, const vs_guest_tick_result *tick) {
  const vs_game *game = &tick->game;
  char text[120];
  if (tick->state != w->before) {
    snprintf(text, sizeof text, "%7.2f s  %s, %s  %d : %d", game->time_s, vs_event_name(game->last_event.kind),
             vs_net_state_name(tick->state), game->score[VS_BLUE], game->score[VS_YELLOW]);
    tell(w, text);
    w->before = tick->state;
  }
  snprintf(text, sizeof text, "%d : %d  %5.1f s  %s  %s", game->score[VS_BLUE], game->score[VS_YELLOW], game->time_s,
           vs_net_state_name(tick->state), vs_safety_name(tick->safety));
  vs_progress_show(&w->progress, o->seconds > 0 ? spent_s(w) / o->seconds : game->time_s / game->duration_s, text);
}

typedef struct sinks {
  vs_world_csv record;
  field_publish publish;
} sinks;

static vs_status play(const field_guest *o, vs_guest *guest, vs_operator *operator_, sinks *to, vs_error *err) {
  watch w = {.before = VS_NET_WAITING, .start_us = vs_clock_monotonic_us()};
  w.seen_us = w.start_us;
  vs_progress_start(&w.progress);
  vs_status s = VS_OK;
  while (!vs_cli_interrupted() && (o->seconds == 0.0 || spent_s(&w) < o->seconds)) {
    vs_guest_tick_result tick;
    if (!obey(operator_, guest, &w)) break;
    s = vs_guest_tick(guest, &tick, err);
    if (s != VS_OK) break;
    watch_silence(&w, tick.seen);
    if (!tick.seen) continue;
    vs_world_csv_write(&to->record, &tick.world, VS_EVENT_NONE);
    field_publish_world(&to->publish, &tick.world, &tick.game);
    show(o, &w, &tick);
  }
  vs_progress_clear(&w.progress);
  return s;
}

// Its own world would come back to it.
static vs_status open_publish(const field_guest *o, const vs_guest_def *def, field_publish *publish, vs_error *err) {
  vs_status s = field_publish_open(o->publish, o->interface, publish, err);
  if (s != VS_OK || !o->publish || publish->port != def->vision) return s;
  field_publish_close(publish);
  return vs_fail(err, VS_USAGE, "--publish %.60s: port %d is the simulator's world; take another (firasim:+10)",
                 o->publish, def->vision);
}

static vs_status play_recorded(const field_guest *o, const vs_guest_def *def, vs_guest *guest, vs_error *err) {
  sinks to;
  vs_operator operator_;
  vs_error at_close = {0};
  vs_status s = open_publish(o, def, &to.publish, err);
  if (s != VS_OK) return s;
  s = vs_operator_open(o->words, &operator_, err);
  if (s == VS_OK) s = vs_world_csv_open(o->record, &to.record, err);
  if (s == VS_OK) {
    s = play(o, guest, &operator_, &to, err);
    if (vs_world_csv_close(&to.record, &at_close) != VS_OK && s == VS_OK)
      s = vs_fail(err, VS_FAIL, "%s", at_close.text);
  }
  vs_operator_close(&operator_);
  field_publish_close(&to.publish);
  return s;
}

static void print_setup(const field_guest *o, const vs_guest_def *def) {
  printf("world from %s, port %d; %s plays %s; ", o->camera, def->vision, o->policy, vs_team_name(o->team));
  if (def->radio)
    printf("commands to %s\n", o->radio);
  else
    printf("commands to port %d%s\n", def->command, def->dry ? ": none, a dry run (--radio firasim:)" : "");
  printf("the robots %s; keys: %s\n",
         def->go ? "play, and stand when the network referee says so" : "stand until the network referee's GAME ON",
         VS_OPERATOR_KEYS);
  fflush(stdout);
}

vs_status field_guest_play(const field_guest *o, vs_error *err) {
  vs_guest_def def = {0};
  vs_guest *guest = NULL;
  vs_status s = fill(o, &def, err);
  if (s == VS_OK) s = vs_guest_new(&def, &guest, err);
  if (s != VS_OK) return s;
  print_setup(o, &def);
  s = play_recorded(o, &def, guest, err);
  const vs_guest_stats *stats = vs_guest_get_stats(guest);
  printf("%" PRId64 " worlds, %" PRId64 " decisions, %" PRId64 " calls of the referee, %" PRId64 " placements\n",
         stats->worlds, stats->decisions, stats->calls, stats->placements);
  vs_guest_free(guest);
  return s;
}
