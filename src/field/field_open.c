#include "field_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/isolate.h"

vs_field_def vs_field_def_default(void) {
  return (vs_field_def){.policy = "onnx:models/policy/field.onnx", // holds its own where commands take time
                        .team = VS_BLUE,
                        .seed = 1,
                        .duration_s = 120,
                        .baud = VS_SERIAL_BAUD,
                        .radio_id = {0, 1, 2},
                        .camera_height_m = 2.2,
                        .latency_s = 0.05,
                        .ball_hold_s = 3,
                        .camera_def = vs_camera_def_default(),
                        .detector = vs_detector_def_default(),
                        .tracker = vs_track_def_default(),
                        .lcm = true,
                        .image_hz = 1};
}

static void add_note(char *note, size_t size, const char *text) {
  size_t used = note && size ? strlen(note) : 0;
  if (note && used + 1 < size) snprintf(note + used, size - used, "%s\n", text);
}

// Without a file: a lens straight above the middle that just sees the goals and the side walls (0.90 m and 0.68 m out).
static vs_status get_calib(vs_field *f, char *note, size_t note_size, vs_error *err) {
  const vs_camera_info *info = &f->eyes.info;
  if (f->def.calib) {
    vs_status s = vs_calib_load(f->def.calib, &f->calib, err);
    return s == VS_OK ? vs_calib_check_size(&f->calib, f->def.calib, info->width, info->height, err) : s;
  }
  double half_m = fmax(0.68, 0.90 * info->height / info->width);
  f->calib =
      vs_calib_overhead(info->width, info->height, f->def.camera_height_m, 2.0 * atan(half_m / f->def.camera_height_m));
  char text[200];
  snprintf(text, sizeof text, "no --calib: assuming a camera %.2f m above the middle that shows just the field",
           f->def.camera_height_m);
  add_note(note, note_size, text);
  return VS_OK;
}

static vs_status open_eyes(vs_field *f, char *note, size_t note_size, vs_error *err) {
  const vs_field_rerun *again = f->def.rerun;
  vs_status s = again ? VS_OK : vs_eyes_open(&f->eyes, f->def.camera, &f->def.camera_def, err);
  if (s != VS_OK) return s;
  if (again) f->eyes.info = (vs_camera_info){.width = again->width_px, .height = again->height_px};
  const vs_camera_info *info = &f->eyes.info;
  if (*info->note) add_note(note, note_size, info->note);
  s = get_calib(f, note, note_size, err);
  if (s != VS_OK) return s;
  if (f->def.calib && !again && (s = vs_moved_open(&f->moved, &f->calib, err)) != VS_OK) return s;
  f->def.detector.adversary = f->def.team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  f->def.detector.px_per_m = vs_calib_px_per_m(&f->calib, f->def.tracker.tag_height_m);
  f->def.tracker.team = f->def.team;
  vs_track_init(&f->tracker, &f->def.tracker);
  return again ? VS_OK : vs_detector_new(&f->def.detector, &f->detector, err);
}

static vs_status open_brain(vs_field *f, const char *uri, vs_control **control, vs_error *err) {
  vs_player *player;
  vs_status s = f->def.rerun ? vs_player_open_rerun(uri, &player, err)
                             : vs_player_open_isolated(uri, VS_FIELD_PATIENCE_MS, &player, err);
  if (s != VS_OK) return s;
  s = vs_control_new(player, control, err);
  if (s != VS_OK) {
    vs_player_close(player);
    return s;
  }
  s = vs_control_set_latency(*control, f->def.latency_s, err);
  return s == VS_OK ? vs_control_reset(*control, f->def.seed, false, err) : s;
}

vs_status vs_field_new(const vs_field_def *def, vs_field **out, char *note, size_t note_size, vs_error *err) {
  *out = NULL;
  if (note && note_size) *note = '\0';
  vs_field *f = calloc(1, sizeof *f);
  if (!f) return vs_fail(err, VS_FAIL, "out of memory");
  f->def = *def;
  f->game.duration_s = def->duration_s;
  f->came_us = def->rerun ? def->rerun->start_us : vs_clock_monotonic_us();
  f->armed = def->go;
  vs_safety_init(&f->safety, f->came_us);
  // Before anything starts a thread: the players' processes are forked from here.
  vs_status s = open_brain(f, def->policy, &f->control[0], err);
  if (s == VS_OK && def->fallback) s = open_brain(f, def->fallback, &f->control[1], err);
  f->stats.latency_s = def->latency_s;
  if (s == VS_OK && !def->latency_fixed) s = vs_latency_meter_new(def->team, &f->meter, err);
  vs_sender_def radio = {.device = def->radio, .baud = def->baud, .key = def->key, .wire = def->wire};
  memcpy(radio.id, def->radio_id, sizeof radio.id);
  if (s == VS_OK && !def->rerun) s = vs_sender_new(&radio, &f->sender, err);
  if (s == VS_OK) s = open_eyes(f, note, note_size, err);
  if (s == VS_OK) s = vs_tap_open(&f->tap, &f->def, &f->calib, note, note_size, err);
  const vs_field_rerun start = {f->eyes.info.width, f->eyes.info.height, f->safety.since_us};
  if (s == VS_OK && def->record) s = vs_record_open(&f->record, &f->def, &start, err);
  f->tap.record = f->record.bus;
  if (s != VS_OK) {
    vs_field_free(f);
    return s;
  }
  *out = f;
  return VS_OK;
}

void vs_field_free(vs_field *f) {
  if (!f) return;
  vs_sender_free(f->sender); // the robots stop first
  vs_tap_close(&f->tap);
  vs_record_close(&f->record);
  vs_detector_free(f->detector);
  for (int i = 0; i < 2; i++) vs_control_free(f->control[i]);
  vs_latency_meter_free(f->meter);
  vs_moved_close(&f->moved);
  vs_eyes_close(&f->eyes);
  free(f);
}
