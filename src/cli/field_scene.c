#include <math.h>
#include <stdio.h>
#include <string.h>

#include "field_overlay.h"
#include "vsss/field.h"
#include "vsss/geom.h"

#define HALF_M  (VS_ROBOT_SIZE_M / 2)
#define WHEEL_M 0.15 // an arrow of a wheel at its limit

static const uint8_t white[3] = {255, 255, 255}, black[3] = {0, 0, 0}, green[3] = {80, 220, 60}, red[3] = {40, 40, 235},
                     orange[3] = {0, 140, 255}, magenta[3] = {230, 60, 230}, grey[3] = {150, 150, 150};
static const uint8_t team_bgr[VS_TEAMS][3] = {{255, 130, 40}, {30, 230, 250}};

typedef struct canvas {
  const vs_calib *calib;
  vs_image *image;
  double sign; // of the calibration's x and y in the absolute frame
} canvas;

static bool at(const canvas *c, double x_m, double y_m, double z_m, double px[2]) {
  return vs_calib_to_pixel(c->calib, c->sign * x_m, c->sign * y_m, z_m, &px[0], &px[1]);
}

static void line(const canvas *c, const double a_m[2], const double b_m[2], double z_m, int width,
                 const uint8_t colour[3]) {
  double a[2], b[2];
  if (at(c, a_m[0], a_m[1], z_m, a) && at(c, b_m[0], b_m[1], z_m, b))
    vs_image_line(c->image, a[0], a[1], b[0], b[1], width, colour);
}

// A point given along the robot's front and to its left.
static void of_robot(const vs_pose *p, double along_m, double across_m, double out[2]) {
  double co = cos(p->theta_rad), si = sin(p->theta_rad);
  out[0] = p->x_m + co * along_m - si * across_m;
  out[1] = p->y_m + si * along_m + co * across_m;
}

static void draw_robot(const canvas *c, const vs_pose *pose, int width, const uint8_t colour[3]) {
  static const double corner[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
  for (int i = 0; i < 4; i++) {
    double a[2], b[2];
    of_robot(pose, HALF_M * corner[i][0], HALF_M * corner[i][1], a);
    of_robot(pose, HALF_M * corner[i + 1][0], HALF_M * corner[i + 1][1], b);
    line(c, a, b, VS_ROBOT_HEIGHT_M, width, colour);
  }
  double middle[2], front[2];
  of_robot(pose, 0, 0, middle);
  of_robot(pose, HALF_M, 0, front);
  line(c, middle, front, VS_ROBOT_HEIGHT_M, width, colour);
}

static void draw_ball(const canvas *c, const vs_ball *ball, double radius_m, int width, const uint8_t colour[3]) {
  enum { SIDES = 20 };
  for (int i = 0; i < SIDES; i++) {
    double a = 2 * VS_PI * i / SIDES, b = 2 * VS_PI * (i + 1) / SIDES;
    const double from[2] = {ball->x_m + radius_m * cos(a), ball->y_m + radius_m * sin(a)};
    const double to[2] = {ball->x_m + radius_m * cos(b), ball->y_m + radius_m * sin(b)};
    line(c, from, to, VS_BALL_RADIUS_M, width, colour);
  }
}

// Each wheel's command as a line from its hub, forwards or back.
static void draw_wheels(const canvas *c, const vs_pose *pose, const vs_wheels *wheels) {
  const double speed[2] = {wheels->left_radps, wheels->right_radps};
  for (int side = 0; side < 2; side++) {
    double hub[2], tip[2], across = side ? -VS_HALF_TRACK_M : VS_HALF_TRACK_M;
    of_robot(pose, 0, across, hub);
    of_robot(pose, WHEEL_M * speed[side] / VS_WHEEL_LIMIT_RADPS, across, tip);
    line(c, hub, tip, VS_ROBOT_HEIGHT_M, 3, magenta);
  }
}

static void cross(vs_image *image, double x, double y, const uint8_t colour[3]) {
  vs_image_line(image, x - 6, y, x + 6, y, 1, colour);
  vs_image_line(image, x, y - 6, x, y + 6, 1, colour);
}

static void draw_found(const vs_detections *seen, vs_image *image) {
  for (int i = 0; i < seen->tags; i++)
    for (int k = 0; k < 4; k++) {
      const double *a = seen->tag[i].corner_px[k], *b = seen->tag[i].corner_px[(k + 1) % 4];
      vs_image_line(image, a[0], a[1], b[0], b[1], k == 2 ? 3 : 1, green);
    }
  for (int i = 0; i < seen->adversaries; i++) cross(image, seen->adversary[i].x_px, seen->adversary[i].y_px, green);
  for (int i = 0; i < seen->balls; i++) cross(image, seen->ball[i].x_px, seen->ball[i].y_px, green);
}

static void draw_world(const canvas *c, const field_scene *s) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_team team = (vs_team)(i / VS_TEAM_SIZE);
    int index = i % VS_TEAM_SIZE;
    const vs_robot *now = &s->now.robot[team][index], *ahead = &s->ahead.robot[team][index];
    draw_robot(c, &now->pose, now->valid ? 2 : 1, now->valid ? team_bgr[team] : grey);
    if (now->valid) draw_robot(c, &ahead->pose, 1, white);
    if (team != s->team) continue;
    double px[2];
    char name[2] = {(char)('0' + index), '\0'};
    if (at(c, now->pose.x_m, now->pose.y_m + c->sign * HALF_M, VS_ROBOT_HEIGHT_M, px))
      vs_image_text(c->image, (int)px[0] + 12, (int)px[1] - 12, 2, name, team_bgr[team]);
    draw_wheels(c, &now->pose, &s->wheels[index]);
  }
  draw_ball(c, &s->now.ball, 1.5 * VS_BALL_RADIUS_M, s->now.ball.valid ? 2 : 1, s->now.ball.valid ? orange : grey);
  if (s->now.ball.valid) draw_ball(c, &s->ahead.ball, VS_BALL_RADIUS_M, 1, white);
}

static void write_line(vs_image *image, int row, const char *text, const uint8_t colour[3]) {
  int dot = image->width >= 960 ? 3 : 2, high = 11 * dot;
  int wide = 6 * dot * (int)strlen(text);
  vs_image_box(image, 0, row * high, wide + 4 * dot, high, black);
  vs_image_text(image, 2 * dot, row * high + 2 * dot, dot, text, colour);
}

void field_scene_draw(const field_scene *s, const vs_calib *calib, vs_image *image) {
  const canvas c = {calib, image, s->turned ? -1.0 : 1.0};
  char text[160];
  draw_found(&s->seen, image);
  draw_world(&c, s);
  snprintf(text, sizeof text, "%s%s", s->stop ? "stop: " : "running", s->stop ? vs_safety_reason(s->safety) : "");
  write_line(image, 0, text, s->stop ? red : green);
  if (s->picture)
    snprintf(text, sizeof text, "camera to radio %.1f ms, ahead %.0f ms", s->age_ms, 1e3 * s->latency_s);
  else
    snprintf(text, sizeof text, "no picture for %.2f s%s", s->silent_s, s->bridged ? ", predicted" : "");
  write_line(image, 1, text, s->picture ? white : red);
}
