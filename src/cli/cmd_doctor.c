// vsss doctor: is everything that a match needs there and right? One line each: ok, or what is wrong and how to mend it.
#include <glob.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "json_text.h"
#include "vsss/bus.h"
#include "vsss/calib_watch.h"
#include "vsss/clock.h"
#include "vsss/contract.h"
#include "vsss/frame_stream.h"
#include "vsss/policy.h"
#include "vsss/realtime.h"

#define PICTURE_MS  3000 // a camera's first picture
#define PRIORITY    50
#define EXPOSURE_MS 5.0 // exposure above which tags blur (field.md, Tags)

typedef struct doctor {
  const char *camera, *radio, *calib;
  vs_field_config config;
  bool json;
  int wrong, told;
  vs_frame frame; // the newest picture; seq and all
  bool seen;
  vs_camera *eye;
  char rig_calib[300];
} doctor;

// verdict: 'o' ok, 'f' to be mended, 'n' worth knowing.
static void tell(doctor *d, char verdict, const char *what, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
static void tell(doctor *d, char verdict, const char *what, const char *format, ...) {
  char text[700];
  va_list list;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  d->wrong += verdict == 'f';
  if (d->json) {
    printf("%s\n  {\"check\": \"%s\", \"verdict\": \"%s\", \"text\": ", d->told++ ? "," : "", what,
           verdict == 'o'   ? "ok"
           : verdict == 'f' ? "fix"
                            : "note");
    vs_json_put(stdout, text);
    printf("}");
  } else {
    printf("%-5s %-12s %s\n", verdict == 'o' ? "ok" : verdict == 'f' ? "FIX" : "note", what, text);
  }
  fflush(stdout);
}

static void check_camera(doctor *d) {
  vs_error why = {0};
  if (!d->camera) {
    glob_t found;
    bool any = glob("/dev/video*", 0, NULL, &found) == 0;
    tell(d, 'f', "camera",
         any ? "none was named; try --camera %s" : "there is no /dev/video*: plug it in, then --camera %s",
         any ? found.gl_pathv[0] : "/dev/video0");
    globfree(&found);
    return;
  }
  vs_status s = vs_camera_open(d->camera, &d->config.def.camera_def, &d->eye, &why);
  vs_camera_got got = VS_CAMERA_TIMEOUT;
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * PICTURE_MS;
  while (s == VS_OK && got == VS_CAMERA_TIMEOUT && vs_clock_monotonic_us() < until_us)
    s = vs_camera_read(d->eye, 200, &d->frame, &got, &why);
  if (s != VS_OK) {
    tell(d, 'f', "camera", "%s", why.text);
    return;
  }
  d->seen = got == VS_CAMERA_FRAME;
  const vs_camera_info *info = vs_camera_about(d->eye);
  if (!d->seen) {
    tell(d, 'f', "camera", "%s gave no picture in %d s; is another program using it?", d->camera, PICTURE_MS / 1000);
    return;
  }
  tell(d, 'o', "camera", "%s, %dx%d, %g pictures a second%s%s", info->name, info->width, info->height, info->fps,
       *info->note ? "; " : "", info->note);
  if (info->fps > 0 && info->fps < VS_CAMERA_HZ)
    tell(d, 'f', "rate", "%g pictures a second, the policy needs %d; ask for a smaller picture (width_px, height_px)",
         info->fps, VS_CAMERA_HZ);
  if (info->exposure_ms > EXPOSURE_MS)
    tell(d, 'f', "exposure", "%.1f ms: above %.0f ms the marks of moving robots blur; more light, exposure_ms = 4",
         info->exposure_ms, EXPOSURE_MS);
  else if (info->exposure_ms > 0)
    tell(d, 'o', "exposure", "%.1f ms", info->exposure_ms);
  else if (!strncmp(d->camera, "/dev/", 5))
    tell(d, 'n', "exposure", "the camera does not say; where it is automatic, marks blur when the light is low");
}

static void check_calib(doctor *d) {
  vs_error why = {0};
  vs_calib calib;
  const char *path = d->calib                                                           ? d->calib
                     : vs_field_rig_calib(d->camera, d->rig_calib, sizeof d->rig_calib) ? d->rig_calib
                                                                                        : NULL;
  if (!path) {
    tell(d, 'f', "calibration", "none was named: --calib FILE; 'vsss calibrate' makes it");
    return;
  }
  vs_status s = vs_calib_load(path, &calib, &why);
  if (s == VS_OK && d->seen) s = vs_calib_check_size(&calib, path, d->frame.width, d->frame.height, &why);
  if (s != VS_OK) {
    tell(d, 'f', "calibration", "%s", why.text);
    return;
  }
  d->config.def.detector.px_per_m = vs_calib_px_per_m(&calib, d->config.def.tracker.tag_height_m);
  vs_calib_watch *watch = NULL;
  if (!d->seen || vs_calib_watch_new(&calib, &watch, &why) != VS_OK) {
    tell(d, 'n', "calibration", "%s can be read; without a picture it is not checked", path);
    return;
  }
  vs_calib_watch_result is = vs_calib_watch_check(watch, &d->frame);
  vs_calib_watch_free(watch);
  if (!is.sure)
    tell(d, 'n', "calibration", "%s: neither lines nor walls stand out in the picture, so it is not checked", path);
  else if (is.error_mm >= VS_CALIB_WATCH_WARN_MM)
    tell(d, 'f', "calibration", "%s: the field's %s are up to %.0f mm off: the camera has moved; calibrate anew", path,
         is.lines ? "lines" : "walls", is.error_mm);
  else
    tell(d, 'o', "calibration", "%s: the field's %s are within %.0f mm", path, is.lines ? "lines" : "walls",
         is.error_mm);
}

static void check_sight(doctor *d) {
  if (!d->seen) return;
  vs_error why = {0};
  vs_detector *detector = NULL;
  static vs_detections seen;
  vs_field_def *def = &d->config.def;
  def->detector.adversary = def->team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  vs_status s = vs_detector_new(&def->detector, &detector, &why);
  if (s == VS_OK) s = vs_detect(detector, &d->frame, &seen, &why);
  vs_detector_free(detector);
  if (s != VS_OK) {
    tell(d, 'f', "picture", "%s", why.text);
    return;
  }
  tell(d, seen.balls && seen.tags ? 'o' : 'n', "picture", "%d marks, %d balls, %d patches of the other team%s",
       seen.tags, seen.balls, seen.adversaries,
       seen.balls && seen.tags ? "" : "; with robots and ball on the field 'vsss detect --draw' shows what is missing");
}

static void check_radio(doctor *d) {
  const char *device = d->radio ? d->radio : d->config.def.radio;
  vs_error why = {0};
  vs_serial *serial = NULL;
  if (!device) {
    tell(d, 'f', "radio", "none was named: --radio /dev/ttyUSB0, or device in [radio] of %s", d->config.path);
    return;
  }
  if (vs_serial_open(device, d->config.def.baud, &serial, &why) != VS_OK) {
    tell(d, 'f', "radio", "%s", why.text);
    return;
  }
  vs_serial_close(serial);
  tell(d, 'o', "radio", "%s can be opened, %d baud", device, d->config.def.baud);
  if (d->config.def.key.set)
    tell(d, 'o', "key", "of team %d: the robots that have it obey nobody else", d->config.def.key.team);
  else
    tell(d, 'n', "key", "none: anybody on the channel can drive the robots (radio.key)");
}

static void heard(const vs_message *m, void *user) {
  if (!strcmp(m->as.radio.device, "doctor")) *(bool *)user = true;
}

// A message to ourselves, on a channel that moves nobody.
static void check_lcm(doctor *d) {
  vs_error why = {0};
  vs_bus *bus = NULL;
  bool came = false;
  vs_message m = {.channel = VS_CH_RADIO, .as.radio.device = "doctor"};
  vs_status s = vs_bus_open(NULL, &bus, &why);
  if (s == VS_OK) s = vs_bus_subscribe_near(bus, VS_CH_RADIO, heard, &came, &why);
  for (int i = 0; i < 10 && s == VS_OK && !came; i++) {
    s = vs_bus_publish(bus, &m, &why);
    if (s == VS_OK) s = vs_bus_handle(bus, 50, NULL, &why);
  }
  if (s != VS_OK)
    tell(d, 'f', "lcm", "%s", why.text);
  else if (!came)
    tell(d, 'f', "lcm", "%s: what is sent does not come back; does a firewall drop multicast on this machine?",
         vs_bus_url(bus));
  else
    tell(d, 'o', "lcm", "%s: a message came back", vs_bus_url(bus));
  vs_bus_close(bus);
}

static void check_policy(doctor *d) {
  vs_error why = {0};
  vs_player *player = NULL;
  const char *version = vs_onnxruntime_version(), *uri = d->config.def.policy;
  if (version)
    tell(d, 'o', "onnx", "ONNX Runtime %s", version);
  else
    tell(d, 'f', "onnx", "no ONNX Runtime: run 'sh deploy/setup.sh'");
  vs_status s = vs_player_open(uri, &player, &why);
  if (s == VS_OK) s = vs_player_reset(player, 1, &why);
  if (s == VS_OK && vs_player_kind(player) == VS_SEES_OBSERVATION) {
    static float obs[VS_TEAM_SIZE * VS_OBS_SIZE];
    float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
    s = vs_player_act(player, obs, VS_TEAM_SIZE, action, &why);
  }
  if (s == VS_OK)
    tell(d, 'o', "policy", "%s answers; contract %s", uri, vs_contract_hash_hex());
  else
    tell(d, 'f', "policy", "%s", why.text);
  vs_player_close(player);
}

static void check_realtime(doctor *d) {
  vs_error why = {0};
  if (vs_realtime_try(PRIORITY, &why) == VS_OK)
    tell(d, 'o', "realtime", "priority %d and locked memory are allowed: --rt %d", PRIORITY, PRIORITY);
  else
    tell(d, 'n', "realtime", "%s", why.text);
}

int cmd_doctor(int argc, char **argv) {
  static doctor d;
  const char *path = NULL;
  bool help;
  const vs_flag flags[] = {{"camera", VS_FLAG_TEXT, &d.camera, "SOURCE", "as 'vsss field' will get it", 0, 0},
                           {"radio", VS_FLAG_TEXT, &d.radio, "DEVICE", "default: field.ini's", 0, 0},
                           {"calib", VS_FLAG_TEXT, &d.calib, "FILE", "calibration of the camera", 0, 0},
                           {"config", VS_FLAG_TEXT, &path, "FILE", "instead of deploy/config/field.ini", 0, 0},
                           {"json", VS_FLAG_SWITCH, &d.json, NULL, "one JSON array; verdicts ok, note, fix", 0, 0},
                           {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_error err = {0};
  vs_camera_register(vs_frame_stream_camera());
  vs_status s =
      vs_args_parse(argc, argv, "doctor [--camera SOURCE] [--radio DEVICE] [--calib FILE] [--config FILE]",
                    "Looks at camera, calibration, radio, LCM, policy and rights as 'vsss field' needs them. One line\n"
                    "each: ok, note (worth knowing), or FIX with what to do. Status 1 where there is something to fix.",
                    flags, NULL, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s != VS_OK) return vs_cli_error("doctor", &err);
  if (d.json) printf("[");
  if (vs_field_config_load(path, &d.config, &err) == VS_OK)
    tell(&d, 'o', "config", "%s", d.config.path);
  else
    tell(&d, 'f', "config", "%s", err.text);
  check_camera(&d);
  check_calib(&d);
  check_sight(&d);
  vs_camera_close(d.eye);
  check_radio(&d);
  check_lcm(&d);
  check_policy(&d);
  check_realtime(&d);
  if (d.json)
    printf("\n]\n");
  else if (d.wrong)
    printf("%d thing%s to fix\n", d.wrong, d.wrong > 1 ? "s" : "");
  return d.wrong ? 1 : 0;
}
