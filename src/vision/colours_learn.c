// Labelled points -> colours.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "point_line.h"
#include "vsss/colours.h"

enum { REACH_PX = 2, MOST_PIXELS = 4096 };
#define LEAST_SATURATION 0.12 // below it a hue is noise
#define ROOM_DEG         10.0 // of a range around what was seen: light changes
#define SHARE_OF_DARKEST 0.6

const char *vs_colour_name(int colour) {
  static const char *const names[] = {"ball", "blue", "yellow"};
  return colour < VS_COLOUR_SQUARE ? names[colour] : vs_plate_colour_name((vs_plate_colour)(colour - VS_COLOUR_SQUARE));
}

static int colour_of(const char *name) {
  for (int i = 0; i < VS_COLOURS; i++)
    if (!strcmp(vs_colour_name(i), name)) return i;
  return -1;
}

vs_status vs_colours_load_points(const char *path, vs_colour_point *out, int capacity, int *count, vs_error *err) {
  *count = 0;
  FILE *f = fopen(path, "r");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  char line[256];
  vs_status s = VS_OK;
  for (int number = 1; s == VS_OK && fgets(line, sizeof line, f); number++) {
    char name[16], more[2];
    s = vs_point_line_check(f, path, number, line, sizeof line, err);
    if (s != VS_OK) break;
    line[strcspn(line, "#\r\n")] = '\0';
    if (line[strspn(line, " \t")] == '\0') continue;
    vs_colour_point p;
    if (sscanf(line, "%lf %lf %15s %1s", &p.x_px, &p.y_px, name, more) != 3 || (p.colour = colour_of(name)) < 0)
      s = vs_fail(err, VS_USAGE,
                  "%s:%d: '%s': expected x_px y_px and one of ball, blue, yellow, red, green, pink, cyan", path, number,
                  line);
    else if (*count == capacity)
      s = vs_fail(err, VS_USAGE, "%s:%d: more than %d points", path, number, capacity);
    else
      out[(*count)++] = p;
  }
  fclose(f);
  if (s == VS_OK && *count == 0) s = vs_fail(err, VS_USAGE, "%s: holds no points", path);
  return s;
}

// What was seen of one colour.
typedef struct seen {
  int pixels;
  double x, y;                          // sums of (saturation, hue) in the plane
  double hue_deg, saturation;           // means
  double low_deg, high_deg;             // furthest from the mean hue
  double least_saturation, least_value; // of all pixels
} seen;

static bool plane(const uint8_t *bgr, double *x, double *y, double *value) {
  double b = bgr[0] / 255.0, g = bgr[1] / 255.0, r = bgr[2] / 255.0, high = fmax(b, fmax(g, r));
  *value = high;
  if (high <= 0) return false;
  *x = (r - 0.5 * (g + b)) / high, *y = 0.866025404 * (g - b) / high;
  return true;
}

static double saturation_of(const uint8_t *bgr) {
  double high = fmax(bgr[0], fmax(bgr[1], bgr[2])), low = fmin(bgr[0], fmin(bgr[1], bgr[2]));
  return high > 0 ? (high - low) / high : 0;
}

static double turn_deg(double from, double to) { return remainder(to - from, 360.0); }

static const uint8_t *pixel(const vs_frame *f, int x, int y) {
  return f->bgr + (size_t)y * f->bgr_stride + 3 * (size_t)x;
}

// pass 0: the mean; pass 1: the spread about it.
static vs_status look_at(const vs_frame *f, const vs_colour_point *p, int pass, seen *s, vs_error *err) {
  int cx = (int)floor(p->x_px), cy = (int)floor(p->y_px);
  if (!isfinite(p->x_px + p->y_px) || cx < REACH_PX || cy < REACH_PX || cx >= f->width - REACH_PX ||
      cy >= f->height - REACH_PX)
    return vs_fail(err, VS_USAGE, "point (%g, %g): the picture has %d x %d pixels", p->x_px, p->y_px, f->width,
                   f->height);
  for (int dy = -REACH_PX; dy <= REACH_PX; dy++)
    for (int dx = -REACH_PX; dx <= REACH_PX; dx++) {
      const uint8_t *bgr = pixel(f, cx + dx, cy + dy);
      double x, y, value, saturation = saturation_of(bgr);
      if (!plane(bgr, &x, &y, &value) || (pass == 1 && saturation < LEAST_SATURATION)) continue;
      if (pass == 0) {
        s->x += x, s->y += y, s->pixels++;
        continue;
      }
      double away = turn_deg(s->hue_deg, atan2(y, x) * 180 / M_PI);
      s->low_deg = fmin(s->low_deg, away), s->high_deg = fmax(s->high_deg, away);
      s->least_saturation = fmin(s->least_saturation, saturation);
      s->least_value = fmin(s->least_value, value);
    }
  return VS_OK;
}

static vs_status survey(const vs_frame *f, const vs_colour_point *points, int count, seen *all, vs_error *err) {
  vs_status s = VS_OK;
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i < count && s == VS_OK; i++) s = look_at(f, &points[i], pass, &all[points[i].colour], err);
    for (int c = 0; pass == 0 && c < VS_COLOURS && s == VS_OK; c++) {
      seen *t = &all[c];
      if (!t->pixels) continue;
      t->x /= t->pixels, t->y /= t->pixels;
      t->hue_deg = fmod(atan2(t->y, t->x) * 180 / M_PI + 360, 360);
      t->saturation = hypot(t->x, t->y);
      t->least_saturation = t->least_value = 1;
      if (t->saturation < LEAST_SATURATION)
        s = vs_fail(err, VS_USAGE, "the points of %s lie on grey (saturation %.2f): put them inside the patch",
                    vs_colour_name(c), t->saturation);
    }
  }
  return s;
}

static vs_colour range_of(const seen *all, int c) {
  const seen *t = &all[c];
  double low = t->low_deg - ROOM_DEG, high = t->high_deg + ROOM_DEG;
  for (int k = 0; k < VS_COLOURS; k++) {
    if (k == c || !all[k].pixels) continue;
    double way = turn_deg(t->hue_deg, all[k].hue_deg);
    if (way > 0) high = fmin(high, 0.5 * way);
    if (way < 0) low = fmax(low, 0.5 * way);
  }
  double least = fmax(SHARE_OF_DARKEST * t->least_saturation, LEAST_SATURATION);
  return (vs_colour){fmod(t->hue_deg + low + 360, 360), fmod(t->hue_deg + high + 360, 360), least,
                     SHARE_OF_DARKEST * t->least_value};
}

vs_status vs_colours_learn(const vs_frame *frame, const vs_colour_point *points, int count, vs_detector_def *def,
                           vs_error *err) {
  seen all[VS_COLOURS] = {{0}};
  vs_status s = survey(frame, points, count, all, err);
  if (s != VS_OK) return s;
  if (all[VS_COLOUR_BALL].pixels) def->ball = range_of(all, VS_COLOUR_BALL);
  if (all[VS_COLOUR_BLUE].pixels) def->team[VS_BLUE] = range_of(all, VS_COLOUR_BLUE);
  if (all[VS_COLOUR_YELLOW].pixels) def->team[VS_YELLOW] = range_of(all, VS_COLOUR_YELLOW);
  for (int i = 0; i < VS_PLATE_COLOURS; i++) {
    const seen *t = &all[VS_COLOUR_SQUARE + i];
    if (t->pixels) def->square[i] = (vs_hue){t->hue_deg, fmin(t->saturation, 1)};
  }
  return VS_OK;
}
