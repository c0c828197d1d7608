// vsss field: play on a real field, or in a rig.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "field_guest.h"
#include "field_overlay.h"
#include "field_publish.h"
#include "field_referee.h"
#include "field_report.h"
#include "operator.h"
#include "vsss/clock.h"
#include "vsss/field_loop.h"
#include "vsss/frame_stream.h"
#include "vsss/sender.h"
#include "world_csv.h"

typedef struct options {
  const char *camera, *radio, *policy, *team, *attack, *calib, *config, *lcm, *stats, *record, *fallback, *referee,
      *wire, *publish, *interface, *overlay;
  const char *own_tags, *their_tags;
  double seconds;
  uint64_t seed;
  int rt;
  bool no_lcm, lcm_remote, go, help;
} options;

static const char about[] =
    "Newest frame -> tags -> poses -> tracked world -> policy -> wheels -> safety -> bytes to the radio, then LCM.\n"
    "The robots stand until they are told to go (keys: " VS_OPERATOR_KEYS ").\n"
    "Ctrl-C stops the robots and prints where the time went. Without --radio it is a dry run.";

static vs_status parse(int argc, char **argv, options *o, vs_error *err) {
  *o = (options){.seed = 1};
  char camera_help[256];
  snprintf(camera_help, sizeof camera_help,
           "%s, firasim:, travesim: (a simulator's world), ssl:[PORT] or vss-vision:PORT (a shared vision)",
           vs_camera_sources());
  const vs_flag flags[] = {
      {"camera", VS_FLAG_TEXT, &o->camera, "SOURCE", camera_help, 0, 0},
      {"radio", VS_FLAG_TEXT, &o->radio, "DEVICE", "serial device of the robots' radio, or firasim:, travesim:", 0, 0},
      {"wire", VS_FLAG_TEXT, &o->wire, "NAME",
       "what the robots speak: vsss, pequi-xbee, sysmic, sysmic-vw, neon, unball; default: field.ini's", 0, 0},
      {"policy", VS_FLAG_TEXT, &o->policy, "URI", "who decides; default: field.ini's", 0, 0},
      {"go", VS_FLAG_SWITCH, &o->go, NULL, "the robots may move at once: for rigs, simulators without a referee, tests",
       0, 0},
      {"referee", VS_FLAG_TEXT, &o->referee, "lcm|network|FILE",
       "says go and stop beside the keys: VSSS_REFEREE, a VSSReferee's calls (network:PORTS), or words in a pipe", 0,
       0},
      {"fallback", VS_FLAG_TEXT, &o->fallback, "URI", "takes over when the policy fails", 0, 0},
      {"team", VS_FLAG_TEXT, &o->team, "TEAM", "ours: blue or yellow", 0, 0},
      {"attack", VS_FLAG_TEXT, &o->attack, "+x|-x", "towards which end of the calibration's frame we play", 0, 0},
      {"calib", VS_FLAG_TEXT, &o->calib, "FILE", "calibration of the camera ('vsss calibrate' makes it)", 0, 0},
      {"own-tags", VS_FLAG_TEXT, &o->own_tags, "KIND",
       "what our robots wear: april, aruco, colour; default: field.ini's", 0, 0},
      {"their-tags", VS_FLAG_TEXT, &o->their_tags, "KIND",
       "what theirs wear: patch, aruco, colour; default: field.ini's", 0, 0},
      {"config", VS_FLAG_TEXT, &o->config, "FILE", "instead of deploy/config/field.ini", 0, 0},
      {"seconds", VS_FLAG_REAL, &o->seconds, "S", "then stop; 0: until Ctrl-C or the recording's end", 0, 86400},
      {"seed", VS_FLAG_SEED, &o->seed, "N", "of a policy that draws", 0, 0},
      {"stats", VS_FLAG_TEXT, &o->stats, "FILE", "write the latencies and counters as JSON at the end", 0, 0},
      {"record", VS_FLAG_TEXT, &o->record, "FILE",
       "a log from which 'vsss replay FILE --check' computes all again; .csv: the tracked world only", 0, 0},
      {"publish", VS_FLAG_TEXT, &o->publish, "firasim:[PORTS]",
       "what is seen, as FIRASim's Environment on 224.0.0.1:10002, for the league's other tools", 0, 0},
      {"interface", VS_FLAG_TEXT, &o->interface, "NAME",
       "network of the hall, such as eth0, for the league's messages; else this machine only", 0, 0},
      {"overlay", VS_FLAG_TEXT, &o->overlay, "FILE.mp4",
       "a video: found, tracked, predicted and commanded drawn into the camera's pictures", 0, 0},
      {"rt", VS_FLAG_INT, &o->rt, "PRIO", "real-time priority, such as 50, and locked memory; 0: none", 0, 99},
      {"lcm", VS_FLAG_TEXT, &o->lcm, "URL", "of the messages", 0, 0},
      {"lcm-remote", VS_FLAG_SWITCH, &o->lcm_remote, NULL, "obey a referee on another machine too", 0, 0},
      {"no-lcm", VS_FLAG_SWITCH, &o->no_lcm, NULL, "publish nothing, hear no referee", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  vs_status s = vs_args_parse(argc, argv,
                              "field --camera SOURCE [--radio DEVICE] [--policy URI] [--team blue|yellow] "
                              "[--attack +x|-x] [--calib FILE] [--config FILE]",
                              about, flags, NULL, &o->help, err);
  if (s == VS_OK && !o->help && !o->camera)
    return vs_fail(err, VS_USAGE, "--camera is missing; give %s", vs_camera_sources());
  return s;
}

// What the flags say goes before what the file says. Blue attacks +x and yellow -x unless told otherwise.
static vs_status fill(const options *o, vs_field_config *config, vs_error *err) {
  vs_status s = vs_field_config_load(o->config, config, err);
  if (s != VS_OK) return s;
  vs_field_def *def = &config->def;
  def->camera = o->camera;
  if (o->radio) def->radio = o->radio;
  if (o->policy) def->policy = o->policy;
  if (o->fallback) def->fallback = o->fallback;
  if (o->wire && vs_wire_find(o->wire, &def->wire, err) != VS_OK) return vs_fail_prefix(err, "--wire");
  if (o->team) s = vs_cli_team("--team", o->team, &def->team, err);
  if (s != VS_OK) return s;
  vs_mark own = def->detector.own, their = def->detector.their;
  if (o->own_tags) s = vs_mark_parse("--own-tags", o->own_tags, false, &own, err);
  if (s == VS_OK && o->their_tags) s = vs_mark_parse("--their-tags", o->their_tags, true, &their, err);
  if (s != VS_OK) return s;
  vs_vision_marks(&def->detector, &def->tracker, own, their);
  const char *attack = o->attack ? o->attack : *config->attack ? config->attack : def->team == VS_BLUE ? "+x" : "-x";
  if (strcmp(attack, "+x") && strcmp(attack, "-x"))
    return vs_fail(err, VS_USAGE, "--attack %s: expected +x or -x", attack);
  def->tracker.attack_plus_x = !strcmp(attack, "+x");
  def->go = o->go;
  def->referee_goes = o->referee && !strcmp(o->referee, "lcm");
  if (def->referee_goes && o->no_lcm) return vs_fail(err, VS_USAGE, "--referee lcm: hears nobody with --no-lcm");
  def->calib = o->calib;
  def->seed = o->seed;
  def->lcm = !o->no_lcm;
  def->lcm_url = o->lcm;
  def->lcm_remote = o->lcm_remote;
  return VS_OK;
}

static void print_setup(const vs_field *field, const vs_field_def *def, bool referee, const char *note) {
  const vs_camera_info *camera = vs_field_camera(field);
  printf("camera  %s  %dx%d", camera->name, camera->width, camera->height);
  if (camera->fps > 0) printf(", %g pictures a second", camera->fps);
  if (camera->exposure_ms > 0) printf(", exposure %.1f ms", camera->exposure_ms);
  printf("\npolicy  %s for %s, attacking %s%s%s\n", def->policy, vs_team_name(def->team),
         def->tracker.attack_plus_x ? "+x" : "-x", def->fallback ? "; when it fails " : "",
         def->fallback ? def->fallback : "");
  if (def->radio)
    printf("radio   %s, %d baud, %s\n", def->radio, def->baud,
           def->wire && def->wire->encode ? def->wire->format
           : def->key.set                 ? "with our team's key"
                                          : "no key: the robots obey anybody on the channel (radio.key)");
  else
    printf("radio   none: a dry run, no robot is driven (--radio DEVICE)\n");
  if (def->radio && def->wire && def->wire->lacks) printf("warning: wire %s: %s\n", def->wire->name, def->wire->lacks);
  if (camera->exposure_ms > 5.0) printf("warning: exposed longer than 5 ms tags blur and robots in motion are lost\n");
  if (!def->go)
    printf("robots  stand until %s; keys: %s\n", referee ? "the network referee's calls" : "they are told to go",
           VS_OPERATOR_KEYS);
  printf("%s", note);
  fflush(stdout);
}

// A record is a log, or where its name says so a table.
static bool is_table(const char *path) {
  size_t length = path ? strlen(path) : 0;
  return length >= 4 && !strcmp(path + length - 4, ".csv");
}

// For the table an object is valid only in the frames it was seen in: in between the tracker predicts.
static void mark_seen(const vs_field *field, const vs_field_def *def, vs_world *world) {
  const vs_tracker *tracker = vs_field_tracker(field);
  vs_team other = def->team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    world->robot[def->team][i].valid = tracker->robot[VS_OWN][i].seen_us == world->time_us;
    world->robot[other][i].valid = tracker->robot[VS_ADVERSARY][i].seen_us == world->time_us;
  }
  world->ball.valid = tracker->ball.seen_us == world->time_us;
}

static int valid_robots(const vs_world *world, vs_team team) {
  int n = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) n += world->robot[team][i].valid;
  return n;
}

static void show_progress(vs_progress *progress, const vs_field_def *def, double share,
                          const vs_field_tick_result *tick) {
  vs_team other = def->team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  char text[240], latency[32] = "";
  if (tick->got == VS_CAMERA_FRAME) snprintf(latency, sizeof latency, "%5.1f ms", 1e-3 * (double)tick->age_us);
  if (tick->silent_us > 500000)
    snprintf(latency, sizeof latency, "NO PICTURE for %.1f s", 1e-6 * (double)tick->silent_us);
  snprintf(text, sizeof text, "sees own %d, other %d, ball %d  camera to radio %s%s%s",
           valid_robots(&tick->world, def->team), valid_robots(&tick->world, other), tick->world.ball.valid, latency,
           tick->stop ? "  STOP: " : "", tick->stop ? vs_safety_reason(tick->safety) : "");
  vs_progress_show(progress, share, text);
}

// What happened, with the second it happened in.
static void tell(vs_progress *progress, double at_s, const char *said) {
  vs_progress_clear(progress);
  printf("%8.2f s  %s\n", at_s, said);
  fflush(stdout);
}

// Who gives orders, and who is shown the world.
typedef struct outside {
  vs_operator keys;
  field_referee referee;
  field_publish publish;
  field_overlay *overlay; // NULL: none
} outside;

// The network's ends first, so that a wrong flag is told before a camera is opened.
static vs_status open_outside(const options *o, outside *with, vs_error *err) {
  *with = (outside){.keys = {-1, -1, "", 0}};
  vs_status s = field_publish_open(o->publish, o->interface, &with->publish, err);
  if (s == VS_OK) s = field_referee_open(o->referee, o->go, o->interface, &with->referee, err);
  bool words = o->referee && strcmp(o->referee, "lcm") && !with->referee.on;
  return s == VS_OK ? vs_operator_open(words ? o->referee : NULL, &with->keys, err) : s;
}

static void close_outside(outside *with) {
  vs_operator_close(&with->keys);
  field_referee_close(&with->referee);
  field_publish_close(&with->publish);
}

// False: the operator ends play.
static bool obey(outside *with, vs_field *field, vs_progress *progress, double at_s) {
  char unknown[24], text[96];
  if (field_referee_hear(&with->referee, field, text, sizeof text)) tell(progress, at_s, text);
  vs_order order = vs_operator_poll(&with->keys, unknown);
  if (order == VS_ORDER_NONE) return true;
  field_referee_order(&with->referee, field, order);
  if (*unknown) {
    snprintf(text, sizeof text, "referee: '%s' is none of go, stop, halt; stopped", unknown);
    tell(progress, at_s, text);
  } else if (order != VS_ORDER_QUIT) {
    tell(progress, at_s, order == VS_ORDER_GO ? "go" : "stop");
  }
  return order != VS_ORDER_QUIT;
}

static vs_status run(const options *o, const vs_field_def *def, outside *with, vs_field *field, vs_error *err) {
  vs_world_csv record;
  vs_status s = vs_world_csv_open(is_table(o->record) ? o->record : NULL, &record, err);
  if (s != VS_OK) return s;
  vs_progress progress;
  vs_progress_start(&progress);
  int64_t start_us = vs_clock_monotonic_us();
  double spent_s = 0;
  while (!vs_cli_interrupted() && (o->seconds == 0.0 || spent_s < o->seconds)) {
    vs_field_tick_result tick;
    if (!obey(with, field, &progress, spent_s)) break;
    s = vs_field_tick(field, &tick, err);
    if (s != VS_OK || tick.got == VS_CAMERA_END) break;
    spent_s = 1e-6 * (double)(vs_clock_monotonic_us() - start_us);
    if (tick.said) tell(&progress, spent_s, tick.said);
    if (with->overlay) field_overlay_show(with->overlay, field, &tick);
    show_progress(&progress, def, o->seconds > 0 ? spent_s / o->seconds : -1, &tick);
    if (tick.got != VS_CAMERA_FRAME) continue;
    field_publish_world(&with->publish, &tick.world, vs_field_game(field));
    mark_seen(field, def, &tick.world);
    vs_world_csv_write(&record, &tick.world, VS_EVENT_NONE);
  }
  vs_progress_clear(&progress);
  vs_error at_close = {0};
  if (vs_world_csv_close(&record, &at_close) != VS_OK && s == VS_OK) return vs_fail(err, VS_FAIL, "%s", at_close.text);
  return s;
}

static vs_status end_overlay(field_overlay *overlay, const char *path, vs_error *err) {
  int64_t left_out = 0;
  vs_status s = field_overlay_close(overlay, &left_out, err);
  if (s == VS_OK && overlay) printf("%s: %lld pictures left out\n", path, (long long)left_out);
  return s;
}

int cmd_field(int argc, char **argv) {
  options o;
  vs_error err = {0};
  static vs_field_config config;
  static vs_field_stats stats;
  vs_field *field = NULL;
  outside with;
  char note[1200] = "", rig_calib[300];
  vs_camera_register(vs_frame_stream_camera());
  vs_status s = parse(argc, argv, &o, &err);
  if (s == VS_OK && o.help) return 0;
  if (s == VS_OK) s = fill(&o, &config, &err);
  if (s != VS_OK) return vs_cli_error("field", &err);
  if (field_guest_is(o.camera) || field_guest_is(o.radio)) {
    const vs_field_def *def = &config.def;
    vs_cli_catch_interrupts();
    vs_cli_before_the_end(vs_sender_last_stop);
    vs_sender_stop_at_crash();
    if (o.rt) vs_cli_realtime(o.rt);
    vs_sender_def sender = {.device = o.radio, .baud = def->baud, .key = def->key, .wire = def->wire};
    memcpy(sender.id, def->radio_id, sizeof sender.id);
    const field_guest guest = {.sender = &sender,
                               .camera = o.camera,
                               .radio = o.radio,
                               .policy = def->policy,
                               .team = def->team,
                               .seed = def->seed,
                               .duration_s = def->duration_s,
                               .seconds = o.seconds,
                               .record = o.record,
                               .go = o.go,
                               .interface = o.interface,
                               .publish = o.publish,
                               .words = field_referee_is(o.referee) ? NULL : o.referee}; // that one is always heard
    s = o.overlay ? vs_fail(&err, VS_USAGE, "--overlay %s: a simulator sends no pictures", o.overlay)
        : o.referee && !strcmp(o.referee, "lcm")
            ? vs_fail(&err, VS_USAGE, "--referee lcm: in a simulator the network referee is obeyed without a flag")
            : field_guest_play(&guest, &err);
    return s == VS_OK ? 0 : vs_cli_error("field", &err);
  }
  config.def.record = is_table(o.record) ? NULL : o.record;
  if (!o.calib && vs_field_rig_calib(o.camera, rig_calib, sizeof rig_calib)) config.def.calib = rig_calib;
  vs_cli_catch_interrupts();
  vs_cli_before_the_end(vs_sender_last_stop);
  vs_sender_stop_at_crash();
  if (o.rt) vs_cli_realtime(o.rt);
  s = open_outside(&o, &with, &err);
  if (s == VS_OK) s = vs_field_new(&config.def, &field, note, sizeof note, &err);
  if (s == VS_OK && o.overlay) s = field_overlay_open(o.overlay, field, &config.def, &with.overlay, &err);
  if (s != VS_OK) {
    vs_field_free(field);
    close_outside(&with);
    return vs_cli_error("field", &err);
  }
  print_setup(field, &config.def, with.referee.on, note);
  s = run(&o, &config.def, &with, field, &err);
  close_outside(&with);
  vs_field_get_stats(field, &stats);
  vs_field_free(field); // stops the robots
  vs_field_report_print(&stats);
  vs_error at_close = {0};
  if (end_overlay(with.overlay, o.overlay, &at_close) != VS_OK && s == VS_OK) {
    err = at_close;
    s = VS_FAIL;
  }
  if (stats.lost_record && s == VS_OK)
    s = vs_fail(&err, VS_FAIL, "%s: %lld turns are missing; is the disk full?", o.record, (long long)stats.lost_record);
  if (o.stats && s == VS_OK) s = vs_field_report_json(o.stats, &stats, &err);
  return s == VS_OK ? 0 : vs_cli_error("field", &err);
}
