// The [vision] section of the field's configuration.
#include "vsss/vision_config.h"

#include <stdio.h>
#include <string.h>

typedef struct rows {
  vs_config_key *out;
  int count, capacity;
} rows;

static void row(rows *r, vs_config_key key) {
  if (r->count < r->capacity) r->out[r->count++] = key;
}

static void number(rows *r, const char *name, double *target, double min, double max, const char *help) {
  row(r, (vs_config_key){name, VS_CONFIG_REAL, target, 0, min, max, help});
}

static void whole(rows *r, const char *name, int *target, double min, double max, const char *help) {
  row(r, (vs_config_key){name, VS_CONFIG_INT, target, 0, min, max, help});
}

static void word(rows *r, const char *name, char *target, size_t size, const char *help) {
  row(r, (vs_config_key){name, VS_CONFIG_TEXT, target, size, 0, 0, help});
}

static void colour(rows *r, const char *const names[4], vs_colour *c) {
  number(r, names[0], &c->hue_min_deg, 0, 360, "red 0, yellow 60, blue 240; min > max wraps");
  number(r, names[1], &c->hue_max_deg, 0, 360, "red 0, yellow 60, blue 240");
  number(r, names[2], &c->saturation_min, 0, 1, "0 grey, 1 pure");
  number(r, names[3], &c->value_min, 0, 1, "0 black, 1 bright");
}

int vs_vision_schema(vs_detector_def *d, vs_track_def *t, vs_camera_def *c, vs_vision_words *words, vs_config_key *out,
                     int capacity) {
  static const char *const ball[] = {"vision.ball_hue_min_deg", "vision.ball_hue_max_deg", "vision.ball_saturation_min",
                                     "vision.ball_value_min"};
  static const char *const blue[] = {"vision.blue_hue_min_deg", "vision.blue_hue_max_deg", "vision.blue_saturation_min",
                                     "vision.blue_value_min"};
  static const char *const yellow[] = {"vision.yellow_hue_min_deg", "vision.yellow_hue_max_deg",
                                       "vision.yellow_saturation_min", "vision.yellow_value_min"};
  static const char *const tag[] = {"vision.robot0_tag", "vision.robot1_tag", "vision.robot2_tag"};
  static const char *const aruco[] = {"vision.blue0_aruco",   "vision.blue1_aruco",   "vision.blue2_aruco",
                                      "vision.yellow0_aruco", "vision.yellow1_aruco", "vision.yellow2_aruco"};
  static const char *const plate[] = {"vision.blue0_plate",   "vision.blue1_plate",   "vision.blue2_plate",
                                      "vision.yellow0_plate", "vision.yellow1_plate", "vision.yellow2_plate"};
  static const char *const square[] = {"vision.red_hue_deg",      "vision.red_saturation", "vision.green_hue_deg",
                                       "vision.green_saturation", "vision.pink_hue_deg",   "vision.pink_saturation",
                                       "vision.cyan_hue_deg",     "vision.cyan_saturation"};
  static const char *const yaw[] = {"vision.robot0_yaw_rad", "vision.robot1_yaw_rad", "vision.robot2_yaw_rad"};
  rows r = {out, 0, capacity};
  whole(&r, "vision.width_px", &c->width, 0, 8192, "asked of the camera; 0: 1280x720 or 640x480");
  whole(&r, "vision.height_px", &c->height, 0, 8192, "asked of the camera");
  number(&r, "vision.fps", &c->fps, 0, 1000, "asked of the camera; 0: 60");
  number(&r, "vision.exposure_ms", &c->exposure_ms, 0, 1000, "above 5 ms tags blur; 0: left alone");
  number(&r, "vision.gain", &c->gain, 0, 10000, "of the camera's own scale; 0: left alone");
  number(&r, "vision.white_balance_k", &c->white_balance_k, 0, 20000, "kelvin; 0: held where the camera has it");
  char name[sizeof words->family]; // by way of a copy: the family may already point to this buffer
  snprintf(name, sizeof name, "%s", d->tag.family);
  memcpy(words->family, name, sizeof name);
  d->tag.family = words->family;
  snprintf(words->own_tags, sizeof words->own_tags, "%s", vs_mark_name(d->own));
  snprintf(words->their_tags, sizeof words->their_tags, "%s", vs_mark_name(d->their));
  word(&r, "vision.own_tags", words->own_tags, sizeof words->own_tags, "what our robots wear: april, aruco, colour");
  word(&r, "vision.their_tags", words->their_tags, sizeof words->their_tags, "what theirs wear: patch, aruco, colour");
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    whole(&r, aruco[i], &t->aruco_id[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE], -1, 1023, "ArUco mark; -1: not playing");
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    int code = t->plate_id[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    char *text = words->plate[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    snprintf(text, sizeof words->plate[0][0], "%s %s", vs_plate_colour_name((vs_plate_colour)(code / 10 % 10)),
             vs_plate_colour_name((vs_plate_colour)(code % 10)));
    word(&r, plate[i], text, sizeof words->plate[0][0], "left and right square; -: not playing");
  }
  for (int i = 0; i < VS_PLATE_COLOURS; i++) {
    number(&r, square[2 * i], &d->square[i].hue_deg, 0, 360, "of a plate's square");
    number(&r, square[2 * i + 1], &d->square[i].saturation, 0, 1, "of it");
  }
  word(&r, "vision.tag_family", words->family, sizeof words->family, "AprilTags: of libapriltag");
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    whole(&r, tag[i], &t->tag_id[i], -1, 100000, "AprilTag of the robot; -1: not playing");
    number(&r, yaw[i], &t->tag_yaw_rad[i], -7, 7, "from the robot's front to the pattern's top, counter-clockwise");
  }
  number(&r, "vision.tag_decimate", &d->tag.decimate, 1, 8, "tags are searched in a picture smaller by this");
  whole(&r, "vision.tag_contrast", &d->tag.min_white_black_diff, 1, 255, "smallest black to white, grey levels");
  whole(&r, "vision.tag_max_hamming", &d->tag.max_hamming, 0, 2, "corrected bits accepted");
  number(&r, "vision.tag_min_margin", &d->tag.min_margin, 0, 255, "decision margin accepted");
  number(&r, "vision.tag_paper_m", &d->tag_paper_m, 0.01, 0.2, "side of the printed pattern");
  number(&r, "vision.tag_height_m", &t->tag_height_m, 0, 0.3, "of the tags over the floor");
  number(&r, "vision.patch_m", &d->patch_m, 0.01, 0.2, "side of the adversaries' team colour");
  number(&r, "vision.patch_height_m", &t->patch_height_m, 0, 0.3, "of it over the floor");
  number(&r, "vision.ball_height_m", &t->ball_height_m, 0, 0.1, "of the point its blob's middle shows");
  number(&r, "vision.margin_m", &t->margin_m, 0, 1, "further outside the field nothing is believed");
  colour(&r, ball, &d->ball);
  colour(&r, blue, &d->team[VS_BLUE]);
  colour(&r, yellow, &d->team[VS_YELLOW]);
  number(&r, "vision.robot_acceleration_mps2", &t->robot_acceleration_mps2, 0.1, 100, "tracker: model deviation");
  number(&r, "vision.ball_acceleration_mps2", &t->ball_acceleration_mps2, 0.1, 500, "tracker: model deviation");
  number(&r, "vision.turn_acceleration_radps2", &t->turn_acceleration_radps2, 1, 5000, "tracker: model deviation");
  number(&r, "vision.position_noise_m", &t->position_noise_m, 1e-5, 0.1, "tracker: of a tag");
  number(&r, "vision.ball_noise_m", &t->ball_noise_m, 1e-5, 0.1, "tracker: of a ball");
  number(&r, "vision.patch_noise_m", &t->patch_noise_m, 1e-5, 0.1, "tracker: of an adversary");
  number(&r, "vision.heading_noise_rad", &t->heading_noise_rad, 1e-4, 1, "tracker: of a tag");
  return r.count;
}

void vs_vision_marks(vs_detector_def *d, vs_track_def *t, vs_mark own, vs_mark their) {
  d->own = t->own = own;
  d->their = t->their = their;
  d->tag.ids = 0;
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    int id = t->aruco_id[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    if (id >= 0) d->tag.id[d->tag.ids++] = id;
  }
}

vs_status vs_vision_take(const vs_vision_words *words, vs_detector_def *d, vs_track_def *t, vs_error *err) {
  vs_mark own, their;
  vs_status s = vs_mark_parse("vision.own_tags =", words->own_tags, false, &own, err);
  if (s == VS_OK) s = vs_mark_parse("vision.their_tags =", words->their_tags, true, &their, err);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE && s == VS_OK; i++) {
    int team = i / VS_TEAM_SIZE, index = i % VS_TEAM_SIZE;
    char what[40];
    snprintf(what, sizeof what, "vision.%s%d_plate =", vs_team_name((vs_team)team), index);
    s = vs_plate_parse(what, words->plate[team][index], (vs_team)team, &t->plate_id[team][index], err);
  }
  if (s == VS_OK) vs_vision_marks(d, t, own, their);
  return s;
}
