// Colours learnt from points of a picture.
#include <stdio.h>

#include "calibrate.h"
#include "field_config.h"
#include "vsss/colours.h"
#include "vsss/detect.h"
#include "vsss/paths.h"

static void print_colours(const vs_detector_def *d) {
  const char *const names[] = {"ball", "blue", "yellow"};
  const vs_colour *const ranges[] = {&d->ball, &d->team[VS_BLUE], &d->team[VS_YELLOW]};
  for (int i = 0; i < 3; i++)
    printf("%-7s hue %3.0f to %3.0f, saturation from %.2f, value from %.2f\n", names[i], ranges[i]->hue_min_deg,
           ranges[i]->hue_max_deg, ranges[i]->saturation_min, ranges[i]->value_min);
  for (int i = 0; i < VS_PLATE_COLOURS; i++)
    printf("%-7s hue %3.0f, saturation %.2f\n", vs_plate_colour_name((vs_plate_colour)i), d->square[i].hue_deg,
           d->square[i].saturation);
}

vs_status calibrate_colours(const calibrate_request *r, vs_error *err) {
  static vs_field_config config;
  static vs_colour_point points[CALIBRATE_MOST_POINTS];
  char from[512];
  int count;
  vs_camera *camera = NULL;
  vs_frame frame;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--colours needs --camera SOURCE (a picture will do)");
  if (!r->out) return vs_fail(err, VS_USAGE, "--colours needs --out FILE.ini, for `vsss field --config`");
  vs_status s = vs_colours_load_points(r->colours, points, CALIBRATE_MOST_POINTS, &count, err);
  if (s == VS_OK) s = vs_field_config_load(r->config, &config, err);
  if (s == VS_OK && !r->config) s = vs_path_find("deploy/config/field.ini", from, sizeof from, err);
  if (s == VS_OK) s = calibrate_settled_picture(r->camera, &camera, &frame, err);
  if (s == VS_OK && vs_colours_learn(&frame, points, count, &config.def.detector, err) != VS_OK)
    s = vs_fail_prefix(err, "%s", r->colours);
  if (s == VS_OK) print_colours(&config.def.detector);
  if (s == VS_OK) s = vs_colours_save(r->out, r->config ? r->config : from, &config.def.detector, err);
  if (s == VS_OK)
    printf("saved as %s: vsss detect PICTURE --colours --config %s tries it, vsss field --config %s plays with it\n",
           r->out, r->out, r->out);
  vs_camera_close(camera);
  return s;
}
