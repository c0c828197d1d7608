// src/cli/cmd_calibrate.c, calibrate.c, calibrate_check.c, calibrate_colours.c and src/vision/tag_sheet.c, through the real binary
#include <sys/stat.h>
#include <unistd.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "vision/board.h"
#include "vision/scene.h"
#include "vsss/calib.h"
#include "vsss/camera.h"
#include "vsss/field.h"

static char folder[] = "/tmp/vsss_calibrate_XXXXXX";
static char arguments[1024];
static vs_calib truth; // the camera that drew field.png

static const char *in_folder(const char *format) {
  snprintf(arguments, sizeof arguments, format, folder, folder, folder, folder);
  return arguments;
}

static FILE *create(const char *name) {
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return fopen(path, "w");
}

// A picture with tag 0 on the free ball mark and tag 1 on another, and the pixels of nine known points of its field.
static int make_files(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  static scene s;
  scene_init(&s, 640, 480);
  s.world.robot[VS_BLUE][0] = (vs_robot){.pose = {0.375, 0.4, 0.5}, .valid = true};
  s.world.robot[VS_BLUE][1] = (vs_robot){.pose = {-0.375, -0.4, 0.5}, .valid = true};
  truth = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_frame frame = scene_draw(&s, 0, 0);
  char path[128];
  snprintf(path, sizeof path, "%s/field.png", folder);
  vs_error err;
  if (vs_image_save(path, frame.bgr, frame.bgr_stride, 640, 480, &err) != VS_OK) return -1;
  scene_free(&s);
  FILE *f = create("points.txt"), *swapped = create("swapped.txt");
  if (!f || !swapped) return -1;
  fprintf(f, "# x_px y_px x_m y_m [z_m]\n\n");
  for (int i = 0; i < 9; i++) {
    double x = 0.75 * (i % 3 - 1), y = 0.65 * (i / 3 - 1), px, py;
    if (!vs_calib_to_pixel(&truth, x, y, 0, &px, &py)) return -1;
    fprintf(f, "%.3f %.3f %g %g   # point %d\n", px, py, x, y, i);
    fprintf(swapped, "%.3f %.3f %g %g\n", px, py, i == 0 ? -x : x, y);
  }
  return fclose(f) | fclose(swapped);
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static void points_and_a_tape_measure_make_a_file_that_maps_the_field(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("calibrate --points %s/points.txt --camera %s/field.png --height-m 2.2 --out %s/venue.ini"));
  if (run.status) fail_msg("status %d: %s", run.status, run.err);
  assert_non_null(strstr(run.out, "9 points: error 0.0"));
  assert_non_null(strstr(run.out, "2.200 m over the floor"));
  vs_calib c;
  char path[128];
  snprintf(path, sizeof path, "%s/venue.ini", folder);
  assert_ok(vs_calib_load(path, &c, err));
  assert_string_equal(c.camera, "field.png");
  assert_int_equal(c.points, 9);
  double px, py, x, y;
  assert_true(vs_calib_to_pixel(&truth, 0.6, -0.5, 0.08, &px, &py));
  assert_true(vs_calib_to_field(&c, px, py, 0.08, &x, &y));
  assert_near(hypot(x - 0.6, y + 0.5), 0, 0.001);
}

static void tags_laid_on_marks_are_checked(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run,
       in_folder("calibrate --check --calib %s/venue.ini --camera %s/field.png --at 0=0.375,0.4 --at 1=-0.375,-0.4"));
  if (run.status) fail_msg("status %d: %s", run.status, run.err);
  assert_refused(in_folder("calibrate --check --calib %s/venue.ini --camera %s/field.png --at 0=0.375,0.42"), 1,
                 " mm at worst, 5.0 are allowed");
  assert_refused(in_folder("calibrate --check --calib %s/venue.ini --camera %s/field.png --at 4=0,0"), 1,
                 "tag 4 is not seen");
}

static void points_are_checked_against_a_calibration(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("calibrate --check --calib %s/venue.ini --points %s/points.txt"));
  assert_int_equal(run.status, 0);
  assert_refused(in_folder("calibrate --check --calib %s/venue.ini --points %s/swapped.txt"), 1, "calibrate anew");
}

static void a_snapshot_is_saved(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("calibrate --camera %s/field.png --snapshot %s/shot.png"));
  assert_int_equal(run.status, 0);
  vsss(&run, in_folder("detect %s/shot.png --field"));
  assert_non_null(strstr(run.out, "2 tags"));
}

static void printed_tags_are_read_back_at_true_size(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("calibrate --print-tags 0,7 --out %s/tags.png"));
  assert_int_equal(run.status, 0);
  vsss(&run, in_folder("detect %s/tags.png"));
  assert_non_null(strstr(run.out, "2 tags"));
  assert_non_null(strstr(run.out, "tag 7"));
  double corner[4];
  assert_int_equal(
      sscanf(strstr(run.out, "corners"), "corners (%lf %lf) (%lf %lf)", &corner[0], &corner[1], &corner[2], &corner[3]),
      4);
  // The border is 5 of 9 cells of 78 mm, 43.33 mm, at 300 / 25.4 = 11.81 dots per mm: 511.8 dots.
  assert_near(corner[2] - corner[0], 511.8, 1.5);
  // The league's: 70 mm, 826.8 dots.
  vsss(&run, in_folder("calibrate --print-tags 272,955 --family aruco --out %s/marks.png"));
  assert_int_equal(run.status, 0);
  vsss(&run, in_folder("detect %s/marks.png --family aruco"));
  assert_non_null(strstr(run.out, "tag 272"));
  assert_non_null(strstr(run.out, "tag 955"));
  assert_int_equal(sscanf(strstr(run.out, "corners"), "corners (%lf %*f) (%lf", &corner[0], &corner[1]), 2);
  assert_near(corner[1] - corner[0], 826.8, 1.5);
  vsss(&run, in_folder("calibrate --print-tags 256,272,273,955,771,939 --family aruco --out %s/marks.pdf"));
  assert_int_equal(run.status, 0);
  vsss(&run, in_folder("calibrate --print-tags 0,1,2,3,4,5 --out %s/tags.pdf"));
  assert_int_equal(run.status, 0);
  char path[128], head[9] = {0};
  snprintf(path, sizeof path, "%s/tags.pdf", folder);
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  assert_int_equal(fread(head, 1, 8, f), 8);
  fclose(f);
  assert_string_equal(head, "%PDF-1.4");
}

static double dark_share(const vs_frame *f, double x_mm, double y_mm, double w_mm, double h_mm) {
  const double dots = 300 / 25.4;
  int dark = 0, all = 0;
  for (int y = (int)(y_mm * dots); y < (int)((y_mm + h_mm) * dots); y++)
    for (int x = (int)(x_mm * dots); x < (int)((x_mm + w_mm) * dots); x++, all++)
      dark += f->grey[y * f->grey_stride + x] < 200;
  return (double)dark / all;
}

// Around a tag of 78 mm at (12, 12) mm: an arrow head above it, a line around it, its number below, and words beside the bar.
static void a_sheet_as_a_picture_tells_what_the_pdf_tells(void **state) {
  (void)state;
  static vsss_run run;
  for (int colour = 0; colour < 2; colour++) {
    vsss(&run, in_folder(colour ? "calibrate --print-tags 123 --family colour --paper-mm 65 --out %s/sheet.png"
                                : "calibrate --print-tags 0 --out %s/sheet.png"));
    assert_int_equal(run.status, 0);
    vs_camera *camera;
    vs_frame f;
    vs_camera_got got;
    assert_ok(vs_camera_open(in_folder("%s/sheet.png"), NULL, &camera, err));
    assert_ok(vs_camera_read(camera, 1000, &f, &got, err));
    assert_int_equal(got, VS_CAMERA_FRAME);
    // A plate's black ground is as wide as a robot.
    double side = colour ? 1000 * VS_ROBOT_SIZE_M : 78, middle = 12 + side / 2;
    assert_near(dark_share(&f, middle - 0.5, 9, 1, 1.5), 1, 0.05); // the arrow
    assert_near(dark_share(&f, middle - 3, 9, 1, 1.5), 0, 0);      // none beside it
    assert_true(dark_share(&f, middle + 3, 9, 10, 2) > 0.1);       // "front"
    assert_near(dark_share(&f, 11.85, 20, 0.12, 20), 0.5, 0.05);   // the line to cut along, in dashes
    assert_near(dark_share(&f, 11.5, 20, 0.2, 20), 0, 0);
    assert_true(dark_share(&f, 12, 12 + side + 1.5, 30, 1.2) > 0.1); // the caption
    assert_true(dark_share(&f, 114, 287.5, 60, 1.2) > 0.1);          // how long the bar is
    vs_camera_close(camera);
  }
}

// On a printed sheet of plates: learnt colours go into the configuration that detect then reads.
static void colours_are_learnt_from_points_and_saved_for_the_field(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("calibrate --print-tags 1,101 --family colour --out %s/plates.png"));
  assert_int_equal(run.status, 0);
  char path[128];
  snprintf(path, sizeof path, "%s/colours.txt", folder);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  // Dots, 11.81 a mm: plate 1 begins at 12 + 7.5 mm, its red square's middle 15 mm on, its bar's 50 mm down; plate 101 lies
  // 90 mm to the right.
  fputs("408 408 red\n820 408 green\n614 821 blue\n1677 821 yellow\n", f);
  fclose(f);
  vsss(&run, in_folder("calibrate --colours %s/colours.txt --camera %s/plates.png --out /tmp/vsss_calibrate_test.ini"));
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "blue    hue 217 to 237")); // (24, 72, 232) is hue 227, 10 degrees to each side
  vsss(&run, in_folder("detect %s/field.png --colours --config /tmp/vsss_calibrate_test.ini"));
  assert_int_equal(run.status, 0);
  remove("/tmp/vsss_calibrate_test.ini");
  assert_refused("calibrate --colours /nowhere/c.txt --camera /dev/null --out /tmp/x.ini", 1, "/nowhere/c.txt");
  assert_refused("calibrate --colours c.txt --out x.ini", 2, "--camera");
  assert_refused("calibrate --colours c.txt --camera x.png", 2, "--out");
}

static void a_folder_of_checkerboard_pictures_gives_the_lens(void **state) {
  (void)state;
  static unsigned char grey[BOARD_WIDTH * BOARD_HEIGHT], bgr[3 * BOARD_WIDTH * BOARD_HEIGHT];
  char path[128];
  assert_int_equal(mkdir(in_folder("%s/boards"), 0700), 0);
  for (int pose = 0; pose < 6; pose++) {
    board_draw(pose, grey);
    for (int i = 0; i < 3 * BOARD_WIDTH * BOARD_HEIGHT; i++) bgr[i] = grey[i / 3];
    snprintf(path, sizeof path, "%s/boards/%d.png", folder, pose);
    assert_ok(vs_image_save(path, bgr, 3 * BOARD_WIDTH, BOARD_WIDTH, BOARD_HEIGHT, err));
  }
  static vsss_run run;
  vsss(&run, in_folder("calibrate --checkerboard 7x5 --square-mm 30 --camera %s/boards --out %s/lens.ini"));
  if (run.status) fail_msg("status %d: %s", run.status, run.err);
  vs_calib c;
  snprintf(path, sizeof path, "%s/lens.ini", folder);
  assert_ok(vs_calib_load(path, &c, err));
  assert_near(c.fx_px, 496.9, 5); // 240 / tan(0.45)
  assert_int_equal(c.width, BOARD_WIDTH);
  assert_true(c.intrinsics_rms_px > 0 && c.intrinsics_rms_px < 0.4);
}

static void the_example_of_points_makes_a_calibration(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, "calibrate --points deploy/calibration/points.example.txt --size 640x480 --height-m 2.2");
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "9 points: error 0.1"));
}

static void bad_requests_are_one_line_with_the_fix(void **state) {
  (void)state;
  assert_refused("calibrate --print-tags 256 --family aruco --paper-mm 186 --out /tmp/none.png", 2,
                 "with their margin");
  FILE *f = create("broken.txt");
  fputs("1 2 0.1 0.1\n3 4 x 0.2\n", f);
  fclose(f);
  f = create("few.txt");
  fputs("1 2 0.1 0.1\n300 4 0.5 0.2\n5 200 0 0.6\n", f);
  fclose(f);
  assert_refused("calibrate", 2, "nothing to do");
  assert_refused(in_folder("calibrate --points %s/points.txt"), 2, "--camera, --size or --calib");
  assert_refused(in_folder("calibrate --points %s/points.txt --size 640x480"), 2, "--height-m");
  assert_refused(in_folder("calibrate --points %s/points.txt --size 640 --height-m 2"), 2, "640x480");
  assert_refused(in_folder("calibrate --points %s/broken.txt --size 640x480 --height-m 2"), 2, "broken.txt:2");
  assert_refused(in_folder("calibrate --points %s/few.txt --size 640x480 --height-m 2"), 1, "at least 4");
  assert_refused(in_folder("calibrate --points %s/swapped.txt --size 640x480 --height-m 2.2"), 1, "swapped");
  assert_refused("calibrate --points /nowhere/p.txt --size 640x480 --height-m 2", 1, "/nowhere/p.txt");
  assert_refused(in_folder("calibrate --check --points %s/points.txt"), 2, "--calib");
  assert_refused(in_folder("calibrate --check --calib %s/venue.ini --points %s/points.txt --size 1280x720"), 1,
                 "640 x 480");
  assert_refused("calibrate --checkerboard 9x6", 2, "--camera");
  assert_refused(in_folder("calibrate --checkerboard 9x6 --camera %s/field.png"), 1, "at least 3");
  assert_refused("calibrate --checkerboard nine --camera /tmp", 2, "--checkerboard nine");
  assert_refused("calibrate --print-tags 0,a --out /tmp/t.pdf", 2, "0,a");
  assert_refused("calibrate --print-tags 0", 2, "--out");
  assert_refused("calibrate --print-tags 0 --out t.gif", 2, "t.gif");
  assert_refused("calibrate --print-tags 0 --out /nowhere/t.pdf", 1, "/nowhere/t.pdf");
  assert_refused("calibrate --print-tags 0,1,2,3,4,5,6 --out /tmp/t.pdf", 2, "holds 1 to 6");
  assert_refused(in_folder("calibrate --check --calib %s/venue.ini --camera %s/field.png --at 0:1,2"), 2, "ID=X,Y");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_and_a_tape_measure_make_a_file_that_maps_the_field),
      cmocka_unit_test(tags_laid_on_marks_are_checked),
      cmocka_unit_test(points_are_checked_against_a_calibration),
      cmocka_unit_test(a_snapshot_is_saved),
      cmocka_unit_test(printed_tags_are_read_back_at_true_size),
      cmocka_unit_test(a_sheet_as_a_picture_tells_what_the_pdf_tells),
      cmocka_unit_test(colours_are_learnt_from_points_and_saved_for_the_field),
      cmocka_unit_test(a_folder_of_checkerboard_pictures_gives_the_lens),
      cmocka_unit_test(the_example_of_points_makes_a_calibration),
      cmocka_unit_test(bad_requests_are_one_line_with_the_fix),
  };
  return cmocka_run_group_tests_name("cli/calibrate", tests, make_files, remove_folder);
}
