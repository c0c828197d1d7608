// src/render/render.c (and paint.c, shadow.c, overlay.c, gl_context.c)
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/render.h"

static vs_world a_world(void) {
  vs_world w;
  memset(&w, 0, sizeof w);
  for (int i = 0; i < 6; i++) {
    vs_robot *r = &w.robot[i / 3][i % 3];
    r->pose = (vs_pose){-0.6 + 0.24 * i, i % 2 ? 0.3 : -0.3, 0.0};
    r->valid = true;
  }
  w.ball = (vs_ball){.x_m = 0.0, .y_m = 0.0, .z_m = VS_BALL_RADIUS_M, .valid = true};
  return w;
}

// A renderer, or a skip where the machine has no EGL.
static vs_render *renderer(const vs_render_def *def) {
  vs_render *r = NULL;
  vs_error err = {0};
  if (vs_render_new(def, &r, &err) != VS_OK) {
    if (strstr(err.text, "install")) skip();
    fail_msg("%s", err.text);
  }
  return r;
}

typedef struct centre {
  double x_px, y_px, count;
} centre;

// Centre of the pixels whose red, green and blue lie within [low, high].
static centre find(const uint8_t *rgb, int width, int height, const uint8_t low[3], const uint8_t high[3]) {
  centre c = {0, 0, 0};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++, rgb += 3)
      if (rgb[0] >= low[0] && rgb[0] <= high[0] && rgb[1] >= low[1] && rgb[1] <= high[1] && rgb[2] >= low[2] &&
          rgb[2] <= high[2]) {
        c.x_px += x + 0.5;
        c.y_px += y + 0.5;
        c.count++;
      }
  c.x_px /= c.count;
  c.y_px /= c.count;
  return c;
}

static const uint8_t orange[2][3] = {{200, 60, 0}, {255, 150, 60}};

static void the_overhead_camera_shows_the_ball_where_its_pinhole_says(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_CAMERA);
  vs_render *r = renderer(&def);
  uint8_t *rgb = malloc(640 * 480 * 3);
  vs_world w = a_world();
  w.ball.x_m = 0.60;
  w.ball.y_m = 0.51;
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  centre c = find(rgb, 640, 480, orange[0], orange[1]);
  // The picture's height shows 2 * 0.68 m of the floor from 2.2 m: focal = 480 / 1.36 * 2.2 = 776.5 px. The ball's
  // centre is 2.2 - 0.02135 = 2.17865 m below the lens: 0.60 m -> 213.8 px, 0.51 m -> 181.8 px; radius 7.6 px.
  assert_near(c.x_px, 320 + 213.8, 0.3);
  assert_near(c.y_px, 240 - 181.8, 0.3);
  assert_near(c.count, 3.1416 * 7.6 * 7.6, 12);
  vs_pinhole p = vs_render_pinhole(r);
  assert_near(p.focal_px, 776.47, 0.01);
  assert_near(p.cx_px, 320, 1e-9);
  assert_near(p.height_m, 2.2, 1e-9);
  vs_render_free(r);
  free(rgb);
}

// The larger field of 5 against 5 from 2.2 m: its height shows 2 * 0.93 m, its width 2 * 1.30 m; the width decides:
// focal = 640 / 2.6 * 2.2 = 541.5 px. The ball, 2.17865 m below the lens: 1.0 m -> 248.6 px, 0.8 m -> 198.9 px.
static void five_against_five_is_drawn_on_its_own_field_with_ten_robots(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_CAMERA);
  def.division = VS_5V5;
  vs_render *r = renderer(&def);
  uint8_t *rgb = malloc(640 * 480 * 3);
  vs_world w = {.division = VS_5V5, .ball = {.x_m = 1.0, .y_m = 0.8, .z_m = VS_BALL_RADIUS_M, .valid = true}};
  for (int i = 0; i < 10; i++)
    w.robot[i / 5][i % 5] = (vs_robot){.pose = {-0.9 + 0.2 * i, i < 5 ? 0.3 : -0.3, 0}, .valid = true};
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  centre c = find(rgb, 640, 480, orange[0], orange[1]);
  assert_near(c.x_px, 320 + 248.6, 0.3);
  assert_near(c.y_px, 240 - 198.9, 0.3);
  static const uint8_t blue[2][3] = {{0, 30, 190}, {60, 110, 255}}, yellow[2][3] = {{220, 180, 0}, {255, 240, 80}};
  // Patches of 6 cm on caps 2.12 m below the lens: 15.3 px wide, the rim blurred; five of each colour, and not four or six.
  c = find(rgb, 640, 480, blue[0], blue[1]);
  assert_true(c.count > 4.1 * 15.3 * 15.3 && c.count < 5.0 * 15.3 * 15.3);
  assert_near(c.x_px, 320 - 0.5 * 541.5 / 2.12, 2); // the mean of -0.9, -0.7 ... -0.1
  c = find(rgb, 640, 480, yellow[0], yellow[1]);
  assert_true(c.count > 4.1 * 15.3 * 15.3 && c.count < 5.0 * 15.3 * 15.3);
  vs_error why = {0};
  w.division = VS_3V3;
  assert_int_equal(vs_render_world(r, &w, NULL, rgb, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "a world of 3v3 for a renderer of 5v5"));
  vs_render_free(r);
  free(rgb);
}

static void a_cap_picture_shows_its_top_row_to_the_robots_front(void **state) {
  (void)state;
  // Black but for the first quarter of the top row: front left.
  static uint8_t picture[4][4][3] = {{{255, 255, 255}}};
  vs_render_def def = vs_render_def_default(VS_VIEW_CAMERA);
  def.cap[VS_BLUE][1] = (vs_cap){&picture[0][0][0], 4, VS_ROBOT_SIZE_M};
  vs_render *r = renderer(&def);
  uint8_t *rgb = malloc(640 * 480 * 3);
  vs_world w;
  memset(&w, 0, sizeof w);
  static const uint8_t white[3] = {250, 250, 250}, full[3] = {255, 255, 255};
  // Heading 90 degrees (picture up) at (0.2, -0.3): the robot's front left is the cap's upper left in the picture, at
  // (-0.03, +0.03) m of its centre. The cap is 2.2 - 0.08 = 2.12 m below the lens: 366.3 px per metre.
  w.robot[VS_BLUE][1] = (vs_robot){.pose = {0.2, -0.3, 1.5707963}, .valid = true};
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  centre c = find(rgb, 640, 480, white, full);
  assert_near(c.x_px, 320 + 0.17 * 366.3, 0.6);
  assert_near(c.y_px, 240 + 0.27 * 366.3, 0.6);
  assert_near(c.count, 0.02 * 0.02 * 366.3 * 366.3, 20);
  vs_render_free(r);
  free(rgb);
}

static void adversaries_carry_their_colour_and_what_is_not_valid_is_left_out(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_CAMERA);
  vs_render *r = renderer(&def);
  uint8_t *rgb = malloc(640 * 480 * 3);
  vs_world w;
  memset(&w, 0, sizeof w);
  w.robot[VS_YELLOW][2] = (vs_robot){.pose = {-0.4, 0.25, 0.7}, .valid = true};
  static const uint8_t low[3] = {135, 115, 0}, high[3] = {255, 235, 60}; // from half way on
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  centre c = find(rgb, 640, 480, low, high);
  assert_near(c.x_px, 320 - 0.4 * 366.3, 0.3);
  assert_near(c.y_px, 240 - 0.25 * 366.3, 0.3);
  assert_near(c.count, 0.06 * 0.06 * 366.3 * 366.3, 25);
  assert_int_equal((int)find(rgb, 640, 480, orange[0], orange[1]).count, 0); // the ball is not valid
  w.robot[VS_YELLOW][2].valid = false;
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  assert_int_equal((int)find(rgb, 640, 480, low, high).count, 0);
  vs_render_free(r);
  free(rgb);
}

static int differing(const uint8_t *a, const uint8_t *b, int pixels) {
  int n = 0;
  for (int i = 0; i < pixels; i++) n += memcmp(a + 3 * i, b + 3 * i, 3) != 0;
  return n;
}

static void the_broadcast_shows_score_clock_and_caption(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.width_px = 640;
  def.height_px = 360;
  def.title = "emc:  inf:";
  vs_render *r = renderer(&def);
  const int pixels = 640 * 360;
  uint8_t *plain = malloc(pixels * 3), *with = malloc(pixels * 3), *later = malloc(pixels * 3);
  vs_world w = a_world();
  vs_game game = {.time_s = 65, .duration_s = 120};
  assert_ok(vs_render_world(r, &w, NULL, plain, err));
  assert_ok(vs_render_world(r, &w, &game, with, err));
  assert_true(differing(plain, with, pixels) > 500); // the board
  game.time_s = 66;
  assert_ok(vs_render_world(r, &w, &game, later, err));
  int clock = differing(with, later, pixels);
  assert_true(clock > 0 && clock < 400); // one digit
  game.time_s = 66 - 1e-9;               // as sums of frames come out
  assert_ok(vs_render_world(r, &w, &game, with, err));
  assert_int_equal(differing(with, later, pixels), 0);
  game.time_s = 66 - 1.0 / VS_CAMERA_HZ; // the frame before
  assert_ok(vs_render_world(r, &w, &game, with, err));
  assert_int_equal(differing(with, later, pixels), clock);
  game.time_s = 66;
  game.last_event = (vs_event){.kind = VS_EVENT_GOAL, .team = VS_YELLOW, .time_s = 65.5};
  assert_ok(vs_render_world(r, &w, &game, with, err));
  assert_true(differing(with, later, pixels) > 500); // the caption
  game.last_event.time_s = 60;                       // long ago: gone
  assert_ok(vs_render_world(r, &w, &game, with, err));
  assert_int_equal(differing(with, later, pixels), 0);
  vs_render_free(r);
  free(plain);
  free(with);
  free(later);
}

static int grey_at(const uint8_t *rgb, double x_px, double y_px) {
  const uint8_t *p = rgb + 3 * ((int)y_px * 640 + (int)x_px);
  return p[0] + p[1] + p[2];
}

static void a_robots_shadow_darkens_the_floor_away_from_the_lamp_and_moves_with_it(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.width_px = 640;
  def.height_px = 360;
  vs_render *r = renderer(&def);
  const int pixels = 640 * 360;
  uint8_t *empty = malloc(pixels * 3), *rgb = malloc(pixels * 3), *later = malloc(pixels * 3);
  vs_world w;
  memset(&w, 0, sizeof w);
  assert_ok(vs_render_world(r, &w, NULL, empty, err));
  w.robot[VS_YELLOW][0] = (vs_robot){.pose = {0.4, 0.0, 0.0}, .valid = true};
  assert_ok(vs_render_world(r, &w, NULL, rgb, err));
  // The lamp stands over +x, -y: on the floor at (0.353, 0.02) the cube's shadow reaches 0.08 * 0.16 = 0.013 m past its
  // side at 0.36. The camera is 1.78 m from (0, -0.03, 0), 60 degrees up: at (0, -0.92, 1.5415); MuJoCo's view of 45
  // degrees is 360 / 2 / tan(22.5) = 434.6 px. There the depth is 0.5 * 0.94 + 0.8660 * 1.5415 = 1.805 m:
  // x = 320 + 0.353 * 434.6 / 1.805 = 405.0, y = 180 - (0.8660 * 0.94 - 0.5 * 1.5415) * 434.6 / 1.805 = 169.6.
  assert_true(grey_at(rgb, 405.0, 169.6) < 0.8 * grey_at(empty, 405.0, 169.6));
  assert_true(grey_at(rgb, 405.0, 169.6) > 0.3 * grey_at(empty, 405.0, 169.6));
  w.robot[VS_YELLOW][0].pose.x_m = -0.4;
  assert_ok(vs_render_world(r, &w, NULL, later, err));
  assert_true(differing(empty, later, pixels) > 500);
  w.robot[VS_YELLOW][0].valid = false;
  assert_ok(vs_render_world(r, &w, NULL, later, err));
  assert_int_equal(differing(empty, later, pixels), 0); // nothing stays behind
  vs_render_free(r);
  free(empty);
  free(rgb);
  free(later);
}

static void two_renderers_in_one_thread_do_not_disturb_each_other(void **state) {
  (void)state;
  vs_render_def camera = vs_render_def_default(VS_VIEW_CAMERA), broadcast = vs_render_def_default(VS_VIEW_BROADCAST);
  broadcast.width_px = 320;
  broadcast.height_px = 180;
  vs_render *a = renderer(&camera), *b = renderer(&broadcast);
  uint8_t *first = malloc(640 * 480 * 3), *again = malloc(640 * 480 * 3), *other = malloc(320 * 180 * 3);
  vs_world w = a_world();
  assert_ok(vs_render_world(a, &w, NULL, first, err));
  assert_ok(vs_render_world(b, &w, NULL, other, err));
  assert_ok(vs_render_world(a, &w, NULL, again, err));
  assert_int_equal(differing(first, again, 640 * 480), 0);
  vs_render_free(b);
  vs_render_free(a);
  free(first);
  free(again);
  free(other);
}

static void sizes_out_of_range_are_refused(void **state) {
  (void)state;
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.width_px = 9;
  vs_render *r;
  vs_error err = {0};
  assert_int_equal(vs_render_new(&def, &r, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "9 x 720"));
  def = vs_render_def_default(VS_VIEW_CAMERA);
  def.camera_height_m = 0.2;
  assert_int_equal(vs_render_new(&def, &r, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "0.2 m"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_overhead_camera_shows_the_ball_where_its_pinhole_says),
      cmocka_unit_test(five_against_five_is_drawn_on_its_own_field_with_ten_robots),
      cmocka_unit_test(a_cap_picture_shows_its_top_row_to_the_robots_front),
      cmocka_unit_test(adversaries_carry_their_colour_and_what_is_not_valid_is_left_out),
      cmocka_unit_test(the_broadcast_shows_score_clock_and_caption),
      cmocka_unit_test(a_robots_shadow_darkens_the_floor_away_from_the_lamp_and_moves_with_it),
      cmocka_unit_test(two_renderers_in_one_thread_do_not_disturb_each_other),
      cmocka_unit_test(sizes_out_of_range_are_refused),
  };
  return cmocka_run_group_tests_name("render/render", tests, NULL, NULL);
}
