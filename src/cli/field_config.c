#include "field_config.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "vsss/config.h"
#include "vsss/control.h"
#include "vsss/frame_stream.h"
#include "vsss/paths.h"
#include "vsss/vision_config.h"

enum { ROWS = 120, OWN_ROWS = 18 };

// text NULL: what the file at path holds.
static vs_status load(const char *path, const char *text, vs_field_config *c, vs_error *err) {
  vs_field_def *d = &c->def;
  vs_config_key rows[ROWS] = {
      {"field.policy", VS_CONFIG_TEXT, c->policy, sizeof c->policy, 0, 0, "who decides: a player URI"},
      {"field.fallback", VS_CONFIG_TEXT, c->fallback, sizeof c->fallback, 0, 0, "takes over when that fails"},
      {"field.team", VS_CONFIG_TEXT, c->team, sizeof c->team, 0, 0, "blue or yellow"},
      {"field.attack", VS_CONFIG_TEXT, c->attack, sizeof c->attack, 0, 0, "+x or -x; empty: blue +x, yellow -x"},
      {"field.duration_s", VS_CONFIG_REAL, &d->duration_s, 0, 1, 86400, "of a match, until a referee says otherwise"},
      {"field.camera_height_m", VS_CONFIG_REAL, &d->camera_height_m, 0, 1, 5, "where there is no calibration"},
      {"field.latency_s", VS_CONFIG_REAL, &d->latency_s, 0, 0, VS_CONTROL_LATENCY_MAX_S, "mid-exposure to wheel"},
      {"field.latency_fixed", VS_CONFIG_BOOL, &d->latency_fixed, 0, 0, 0, "else the robots' motion tells it"},
      {"field.ball_hold_s", VS_CONFIG_REAL, &d->ball_hold_s, 0, 0, 60, "a ball lost for longer stops; 0: never"},
      {"radio.device", VS_CONFIG_TEXT, c->radio, sizeof c->radio, 0, 0, "serial device; empty: a dry run"},
      {"radio.baud", VS_CONFIG_INT, &d->baud, 0, 1200, 4000000, "of the serial device"},
      {"radio.robot0_id", VS_CONFIG_INT, &c->radio_id[0], 0, 0, 255, "number on the air of robot 0"},
      {"radio.robot1_id", VS_CONFIG_INT, &c->radio_id[1], 0, 0, 255, "of robot 1"},
      {"radio.robot2_id", VS_CONFIG_INT, &c->radio_id[2], 0, 0, 255, "of robot 2"},
      {"radio.wire", VS_CONFIG_TEXT, c->wire, sizeof c->wire, 0, 0, "what the robots speak"},
      {"radio.team_id", VS_CONFIG_INT, &c->team_id, 0, 0, 255, "the team's number on the air, with a key"},
      {"radio.key", VS_CONFIG_TEXT, c->key, sizeof c->key, 0, 0,
       "32 hexadecimal digits; empty: frames without a check"},
      {"lcm.image_hz", VS_CONFIG_REAL, &d->image_hz, 0, 0, 5, "pictures a second on VSSS_IMAGE; 0: none"},
  };
  int n = vs_vision_schema(&d->detector, &d->tracker, &d->camera_def, &c->vision, rows + OWN_ROWS, ROWS - OWN_ROWS - 1);
  rows[OWN_ROWS + n].name = NULL;
  vs_status s = text ? vs_config_parse(path, text, rows, err) : vs_config_load(path, rows, err);
  if (s == VS_OK && vs_vision_take(&c->vision, &d->detector, &d->tracker, err) != VS_OK)
    return vs_fail_prefix(err, "%s", path);
  return s;
}

static vs_status take(const char *path, const char *text, vs_field_config *c, vs_error *err) {
  memset(c, 0, sizeof *c);
  vs_field_def *d = &c->def;
  *d = vs_field_def_default();
  for (int i = 0; i < VS_TEAM_SIZE; i++) c->radio_id[i] = d->radio_id[i];
  vs_status s = load(path, text, c, err);
  if (s != VS_OK) return s;
  if (*c->policy) d->policy = c->policy;
  if (*c->fallback) d->fallback = c->fallback;
  if (*c->radio) d->radio = c->radio;
  for (int i = 0; i < VS_TEAM_SIZE; i++) d->radio_id[i] = (uint8_t)c->radio_id[i];
  if (*c->wire && vs_wire_find(c->wire, &d->wire, err) != VS_OK) return vs_fail_prefix(err, "%s: radio", path);
  if (*c->key && !vs_radio_key_parse(c->team_id, c->key, &d->key))
    return vs_fail(err, VS_USAGE,
                   "%s: radio.key has %zu characters; expected 32 hexadecimal digits, such as those of "
                   "'openssl rand -hex 16'",
                   path, strlen(c->key));
  if (*c->team && vs_cli_team("field.team =", c->team, &d->team, err) != VS_OK) return vs_fail_prefix(err, "%s", path);
  return VS_OK;
}

vs_status vs_field_config_load(const char *path, vs_field_config *c, vs_error *err) {
  char found[512];
  vs_status s = VS_OK;
  if (!path) s = vs_path_find("deploy/config/field.ini", found, sizeof found, err);
  if (s != VS_OK) return s;
  s = take(path ? path : found, NULL, c, err);
  snprintf(c->path, sizeof c->path, "%s", path ? path : found);
  c->def.config_file = c->path;
  return s;
}

vs_status vs_field_config_parse(const char *name, const char *text, vs_field_config *c, vs_error *err) {
  return take(name, text, c, err);
}

bool vs_field_rig_calib(const char *camera, char *path, size_t size) {
  if (!camera || strncmp(camera, "rig:", 4) != 0) return false;
  const char *rest = camera + 4, *slash = strrchr(rest, '/');
  if (!*rest)
    vs_rig_default_path("calib.ini", path, size);
  else
    snprintf(path, size, "%.*scalib.ini", slash ? (int)(slash - rest + 1) : 0, rest);
  return access(path, R_OK) == 0;
}
