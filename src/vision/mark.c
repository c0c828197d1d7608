// Marks as pictures of a cap.
#include "vsss/mark.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vsss/detect.h"
#include "vsss/field.h"
#include "vsss/tag.h"

const int vs_aruco_league_id[VS_TEAMS][VS_TEAM_SIZE] = {[VS_BLUE] = {256, 272, 273}, [VS_YELLOW] = {955, 771, 939}};

const uint8_t vs_team_rgb[VS_TEAMS][3] = {{24, 72, 232}, {250, 214, 20}};
static const uint8_t white[3] = {255, 255, 255}, black[3] = {0, 0, 0}, paper_black[3] = {20, 20, 22};

const char *vs_mark_name(vs_mark mark) {
  static const char *const names[VS_MARKS] = {"april", "aruco", "colour", "patch"};
  return names[mark];
}

vs_status vs_mark_parse(const char *what, const char *text, bool theirs, vs_mark *out, vs_error *err) {
  for (int i = 0; i < VS_MARKS; i++) {
    bool allowed = theirs ? i != VS_MARK_APRIL : i != VS_MARK_PATCH;
    if (allowed && !strcmp(text, vs_mark_name((vs_mark)i))) return *out = (vs_mark)i, VS_OK;
  }
  return vs_fail(err, VS_USAGE, "%s %s: expected %s", what, text,
                 theirs ? "patch, aruco or colour" : "april, aruco or colour");
}

static void put(vs_mark_picture *p, int row, int column, const uint8_t rgb[3]) {
  memcpy(p->rgb + 3 * (row * p->px + column), rgb, 3);
}

static void paint_pattern(const vs_tag_pattern *t, const uint8_t light[3], const uint8_t dark[3], vs_mark_picture *p) {
  p->px = t->cells;
  for (int i = 0; i < t->cells * t->cells; i++)
    put(p, i / t->cells, i % t->cells, t->cell[i / t->cells][i % t->cells] ? light : dark);
}

static void paint_patch(vs_team team, vs_mark_picture *p) {
  *p = (vs_mark_picture){.px = VS_MARK_PX, .size_m = VS_ROBOT_SIZE_M};
  for (int i = 0; i < p->px * p->px; i++) {
    double u = fabs((i / p->px + 0.5) / p->px - 0.5), v = fabs((i % p->px + 0.5) / p->px - 0.5);
    put(p, i / p->px, i % p->px, fmax(u, v) * p->size_m < 0.5 * VS_PATCH_M ? vs_team_rgb[team] : paper_black);
  }
}

const uint8_t vs_plate_rgb[VS_PLATE_COLOURS][3] = {{222, 22, 56}, {30, 200, 60}, {248, 112, 180}, {40, 210, 220}};

const vs_hue vs_plate_default[VS_PLATE_COLOURS] = {[VS_PLATE_RED] = {350, 0.9},
                                                   [VS_PLATE_GREEN] = {130, 0.6},
                                                   [VS_PLATE_PINK] = {330, 0.55},
                                                   [VS_PLATE_CYAN] = {184, 0.7}};

static const char *const plate_names[VS_PLATE_COLOURS] = {"red", "green", "pink", "cyan"};
const char *vs_plate_colour_name(vs_plate_colour colour) { return plate_names[colour]; }

int vs_plate_code(vs_team team, int left, int right) { return 100 * (int)team + 10 * left + right; }

static int plate_colour(const char *word) {
  for (int i = 0; i < VS_PLATE_COLOURS; i++)
    if (!strcmp(plate_names[i], word)) return i;
  return -1;
}

vs_status vs_plate_parse(const char *what, const char *text, vs_team team, int *code, vs_error *err) {
  char left[16], right[16], more[2];
  *code = -1;
  if (!*text || !strcmp(text, "-")) return VS_OK;
  int words = sscanf(text, "%15s %15s %1s", left, right, more);
  int l = words == 2 ? plate_colour(left) : -1, r = words == 2 ? plate_colour(right) : -1;
  if (l < 0 || r < 0)
    return vs_fail(err, VS_USAGE, "%s %s: expected the left and the right square's colour of red, green, pink, cyan",
                   what, text);
  *code = vs_plate_code(team, l, r);
  return VS_OK;
}

int vs_plate_default_code(vs_team team, int index) { return vs_plate_code(team, index, index + 1); }

static void paint_plate(vs_team team, int code, vs_mark_picture *p) {
  *p = (vs_mark_picture){.px = VS_MARK_PX, .size_m = VS_ROBOT_SIZE_M};
  const double half = 0.5 * VS_PLATE_SIDE_M, gap = half - VS_PLATE_SQUARE_M;
  for (int i = 0; i < p->px * p->px; i++) {
    double ahead = (0.5 - (i / p->px + 0.5) / p->px) * p->size_m, left = (0.5 - (i % p->px + 0.5) / p->px) * p->size_m;
    bool bar = ahead > -half && ahead < -gap && fabs(left) < half;
    bool square = ahead > gap && ahead < half && fabs(left) > gap && fabs(left) < half;
    put(p, i / p->px, i % p->px,
        bar      ? vs_team_rgb[team]
        : square ? vs_plate_rgb[left > 0 ? code / 10 % 10 : code % 10]
                 : paper_black);
  }
}

vs_status vs_mark_paint(vs_mark mark, vs_team team, int id, vs_mark_picture *out, vs_error *err) {
  vs_tag_pattern pattern;
  if (mark == VS_MARK_PATCH) return paint_patch(team, out), VS_OK;
  if (mark == VS_MARK_COLOUR) {
    int left = id / 10 % 10, right = id % 10;
    if (id < 0 || id >= 100 * VS_TEAMS || left >= VS_PLATE_COLOURS || right >= VS_PLATE_COLOURS)
      return vs_fail(
          err, VS_USAGE,
          "%d is no colour plate: they are 100 for yellow plus 10 times the left and 1 times the right square, red "
          "0, green 1, pink 2, cyan 3",
          id);
    return paint_plate(team, id, out), VS_OK;
  }
  bool aruco = mark == VS_MARK_ARUCO;
  vs_status s = vs_tag_pattern_of(aruco ? VS_TAG_ARUCO : VS_TAG_FAMILY, id, &pattern, err);
  if (s != VS_OK) return s;
  out->size_m = aruco ? VS_ARUCO_SIDE_M : VS_TAG_PAPER_M;
  if (!aruco)
    paint_pattern(&pattern, white, black, out);
  else if (team == VS_BLUE)
    paint_pattern(&pattern, white, vs_team_rgb[VS_BLUE], out);
  else
    paint_pattern(&pattern, vs_team_rgb[VS_YELLOW], black, out);
  return VS_OK;
}
