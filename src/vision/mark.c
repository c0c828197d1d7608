// Marks as pictures of a cap.
#include "vsss/mark.h"

#include <math.h>
#include <string.h>

#include "vsss/detect.h"
#include "vsss/field.h"
#include "vsss/tag.h"

const int vs_aruco_league_id[VS_TEAMS][VS_TEAM_SIZE] = {[VS_BLUE] = {256, 272, 273}, [VS_YELLOW] = {955, 771, 939}};

static const uint8_t team_rgb[VS_TEAMS][3] = {{24, 72, 232}, {250, 214, 20}};
static const uint8_t white[3] = {255, 255, 255}, black[3] = {0, 0, 0}, paper_black[3] = {20, 20, 22};

const char *vs_mark_name(vs_mark mark) {
  static const char *const names[VS_MARKS] = {"april", "aruco", "patch"};
  return names[mark];
}

vs_status vs_mark_parse(const char *what, const char *text, bool theirs, vs_mark *out, vs_error *err) {
  for (int i = 0; i < VS_MARKS; i++) {
    bool allowed = theirs ? i != VS_MARK_APRIL : i != VS_MARK_PATCH;
    if (allowed && !strcmp(text, vs_mark_name((vs_mark)i))) return *out = (vs_mark)i, VS_OK;
  }
  return vs_fail(err, VS_USAGE, "%s %s: expected %s", what, text, theirs ? "patch or aruco" : "april or aruco");
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
    put(p, i / p->px, i % p->px, fmax(u, v) * p->size_m < 0.5 * VS_PATCH_M ? team_rgb[team] : paper_black);
  }
}

vs_status vs_mark_paint(vs_mark mark, vs_team team, int id, vs_mark_picture *out, vs_error *err) {
  vs_tag_pattern pattern;
  if (mark == VS_MARK_PATCH) return paint_patch(team, out), VS_OK;
  bool aruco = mark == VS_MARK_ARUCO;
  vs_status s = vs_tag_pattern_of(aruco ? VS_TAG_ARUCO : VS_TAG_FAMILY, id, &pattern, err);
  if (s != VS_OK) return s;
  out->size_m = aruco ? VS_ARUCO_SIDE_M : VS_TAG_PAPER_M;
  if (!aruco)
    paint_pattern(&pattern, white, black, out);
  else if (team == VS_BLUE)
    paint_pattern(&pattern, white, team_rgb[VS_BLUE], out);
  else
    paint_pattern(&pattern, team_rgb[VS_YELLOW], black, out);
  return VS_OK;
}
