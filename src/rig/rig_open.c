// What a rig is made of, put together and taken apart.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "rig_internal.h"
#include "vsss/calib.h"
#include "vsss/clock.h"

vs_rig_def vs_rig_def_default(const vs_model *model) {
  return (vs_rig_def){.model = model,
                      .team = VS_BLUE,
                      .opponent = "random:",
                      .referee = vs_referee_def_default(VS_RULES_PAPER),
                      .seed = 1,
                      .width_px = 640,
                      .height_px = 480,
                      .camera_height_m = 2.2,
                      .own = VS_MARK_APRIL,
                      .their = VS_MARK_PATCH,
                      .tag_id = {0, 1, 2},
                      .radio_id = {0, 1, 2},
                      .lcm = true};
}

// The own team's delay is real: its radio's and, as on a field, the time it thinks. The other team has none of its own.
static double opponent_latency_s(const vs_rig_def *def) {
  if (def->opponent_at_once) return 0.0;
  return fmin(VS_RIG_LATENCY_S + (double)def->delay_frames / VS_CAMERA_HZ,
              (VS_SENSOR_DELAY_FRAMES - 1.0) / VS_CAMERA_HZ);
}

static vs_status open_match(vs_rig *r, vs_error *err) {
  vs_env_def def = vs_env_def_default(r->def.model);
  def.player[VS_BLUE] = r->def.team == VS_BLUE ? NULL : r->def.opponent;
  def.player[VS_YELLOW] = r->def.team == VS_YELLOW ? NULL : r->def.opponent;
  def.referee = r->def.referee;
  def.own_radio[r->def.team] = true;
  double latency_s = opponent_latency_s(&r->def);
  def.realism.latency_s = (vs_range){latency_s, latency_s};
  vs_status s = vs_env_new(&def, &r->env, err);
  if (s == VS_OK) s = vs_env_reset(r->env, r->def.seed, err);
  if (s == VS_OK) vs_env_truth(r->env, &r->truth);
  return s;
}

static vs_status open_render(vs_rig *r, vs_error *err) {
  vs_render_def def = vs_render_def_default(VS_VIEW_CAMERA);
  vs_mark_picture cap[VS_TEAMS][VS_TEAM_SIZE];
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    int team = i / VS_TEAM_SIZE, index = i % VS_TEAM_SIZE;
    bool own = team == (int)r->def.team;
    vs_mark mark = own ? r->def.own : r->def.their;
    int id = mark == VS_MARK_ARUCO    ? vs_aruco_league_id[team][index]
             : mark == VS_MARK_COLOUR ? vs_plate_default_code((vs_team)team, index)
                                      : r->def.tag_id[index];
    vs_status s = vs_mark_paint(mark, (vs_team)team, id, &cap[team][index], err);
    if (s != VS_OK) return s;
    def.cap[team][index] = (vs_cap){cap[team][index].rgb, cap[team][index].px, cap[team][index].size_m};
  }
  def.width_px = r->def.width_px;
  def.height_px = r->def.height_px;
  def.camera_height_m = r->def.camera_height_m;
  def.white_walls = r->def.white_walls;
  vs_status s = vs_render_new(&def, &r->render, err);
  if (s != VS_OK) return s;
  r->rgb = malloc((size_t)def.width_px * (size_t)def.height_px * 3);
  if (!r->rgb) return vs_fail(err, VS_FAIL, "out of memory");
  if (r->def.optics.exposure_s > 0) {
    size_t bytes = (size_t)def.width_px * (size_t)def.height_px * 3;
    r->moment = malloc(bytes);
    r->exposed = malloc(bytes * sizeof *r->exposed);
    if (!r->moment || !r->exposed) return vs_fail(err, VS_FAIL, "out of memory");
  }
  return vs_optics_open(&r->optics, &r->def.optics, def.width_px, def.height_px, vs_render_pinhole(r->render).focal_px,
                        r->def.seed, err);
}

// The calibration that a perfect measurement of this camera would give.
static vs_status write_calib(vs_rig *r, vs_error *err) {
  vs_pinhole p = vs_render_pinhole(r->render);
  vs_calib calib = vs_calib_overhead(p.width_px, p.height_px, p.height_m, 2.0 * atan(0.5 * p.height_px / p.focal_px));
  snprintf(calib.camera, sizeof calib.camera, "rig");
  calib.k1 = r->def.optics.lens_k1;
  vs_status s = vs_calib_create(r->calib_path, &calib, err);
  if (s == VS_OK) vs_venue_mine(r->calib_path, &r->calib_file);
  return s;
}

static vs_status open_radio(vs_rig *r, vs_error *err) {
  vs_status s = vs_robots_open(&r->robots, r->def.radio_id, &r->def.key, vs_clock_monotonic_us(), err);
  if (s != VS_OK) return s;
  r->robots.delay_frames = r->def.delay_frames;
  if (symlink(vs_pty_path(r->robots.pty), r->radio_path))
    return vs_fail(err, VS_FAIL, "%s: %s", r->radio_path, strerror(errno));
  vs_venue_mine(r->radio_path, &r->radio_file);
  return VS_OK;
}

static vs_status open_bus(vs_rig *r, char *note, size_t note_size, vs_error *err) {
  if (!r->def.lcm) return VS_OK;
  vs_error why = {0};
  vs_status s = vs_bus_open(r->def.lcm_url, &r->bus, &why);
  if (s == VS_OK) return VS_OK;
  if (r->def.lcm_url) return vs_fail(err, s, "%s", why.text);
  if (note && note_size) snprintf(note, note_size, "going on without LCM: %s\n", why.text);
  return VS_OK;
}

vs_status vs_rig_new(const vs_rig_def *def, vs_rig **out, char *note, size_t note_size, vs_error *err) {
  *out = NULL;
  if (note && note_size) *note = '\0';
  vs_rig *r = calloc(1, sizeof *r);
  if (!r) return vs_fail(err, VS_FAIL, "out of memory");
  r->def = *def;
  r->apart_s = VS_RIG_TOUCH_APART_S;
  snprintf(r->camera_path, sizeof r->camera_path, "%s/camera", def->folder);
  snprintf(r->radio_path, sizeof r->radio_path, "%s/radio", def->folder);
  snprintf(r->calib_path, sizeof r->calib_path, "%s/calib.ini", def->folder);
  vs_status s = vs_venue_open(&r->venue, def->folder, r->camera_path, r->radio_path, r->calib_path, err);
  if (s == VS_OK) s = open_match(r, err);
  if (s == VS_OK) s = open_render(r, err);
  if (s == VS_OK) s = vs_frame_server_new(r->camera_path, def->width_px, def->height_px, VS_CAMERA_HZ, &r->camera, err);
  if (s == VS_OK) s = open_radio(r, err);
  if (s == VS_OK) s = write_calib(r, err);
  if (s == VS_OK) s = open_bus(r, note, note_size, err);
  if (s != VS_OK) {
    vs_rig_free(r);
    return s;
  }
  *out = r;
  return VS_OK;
}

void vs_rig_free(vs_rig *r) {
  if (!r) return;
  vs_bus_close(r->bus);
  vs_frame_server_free(r->camera);
  vs_robots_close(&r->robots);
  vs_venue_remove(r->radio_path, &r->radio_file);
  vs_venue_remove(r->calib_path, &r->calib_file);
  vs_venue_close(&r->venue);
  vs_render_free(r->render);
  vs_env_free(r->env);
  vs_optics_close(&r->optics);
  free(r->rgb);
  free(r->moment);
  free(r->exposed);
  free(r);
}
