// Tests src/sim/sim_model.c: which models are refused, and with what message.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "sim/arena.h"
#include "vsss/paths.h"

static char folder[] = "/tmp/vsss_sim_model_XXXXXX";

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static void file_in(char *path, size_t size, const char *name) { snprintf(path, size, "%s/%s", folder, name); }

static int remove_folder(void **state) {
  (void)state;
  static const char *const name[] = {"field.xml", "contacts.xml", "vsss_contact.xml", "vsss_planar.xml"};
  char path[128];
  for (int i = 0; i < 4; i++) {
    file_in(path, sizeof path, name[i]);
    unlink(path);
  }
  return rmdir(folder);
}

// Copies a model file, with the first occurrence of from replaced by to; size 0: whole, else cut after that many bytes.
static void copy_with(const char *name, const char *from, const char *to, size_t cut) {
  char relative[64], path[512];
  static char text[1 << 17];
  snprintf(relative, sizeof relative, "models/%s", name);
  assert_ok(vs_path_find(relative, path, sizeof path, err));
  FILE *in = fopen(path, "r");
  size_t size = fread(text, 1, sizeof text - 1, in);
  fclose(in);
  text[size] = '\0';
  if (cut) text[cut] = '\0';
  file_in(path, sizeof path, name);
  FILE *out = fopen(path, "w");
  char *at = from ? strstr(text, from) : NULL;
  assert_true(!from || at);
  if (at) {
    fprintf(out, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
  } else {
    fputs(text, out);
  }
  fclose(out);
}

static void whole_copy(void) {
  copy_with("field.xml", NULL, NULL, 0);
  copy_with("contacts.xml", NULL, NULL, 0);
  copy_with("vsss_contact.xml", NULL, NULL, 0);
  copy_with("vsss_planar.xml", NULL, NULL, 0);
}

// Loads the copy; text: what the one-line message must contain, NULL where it must load.
static void expect_load(vs_drive drive, const char *text) {
  char path[128];
  vs_error err = {0};
  vs_model_def def = vs_model_def_default(drive);
  file_in(path, sizeof path, drive == VS_DRIVE_CONTACT ? "vsss_contact.xml" : "vsss_planar.xml");
  def.path = path;
  vs_model *model = NULL;
  vs_status status = vs_model_load(&def, &model, &err);
  if (!text) {
    if (status != VS_OK) fail_msg("%s", err.text);
    vs_model_free(model);
    return;
  }
  assert_int_equal(status, VS_FAIL);
  assert_null(strchr(err.text, '\n'));
  assert_non_null(strstr(err.text, path));
  if (!strstr(err.text, text)) fail_msg("'%s' does not contain '%s'", err.text, text);
}

static void unchanged_copies_load(void **state) {
  (void)state;
  whole_copy();
  expect_load(VS_DRIVE_CONTACT, NULL);
  expect_load(VS_DRIVE_PLANAR, NULL);
}

static void missing_and_truncated_files_are_refused(void **state) {
  (void)state;
  whole_copy();
  copy_with("vsss_contact.xml", NULL, NULL, 3000);
  expect_load(VS_DRIVE_CONTACT, "not a MuJoCo model");
  char path[128];
  file_in(path, sizeof path, "vsss_planar.xml");
  unlink(path);
  expect_load(VS_DRIVE_PLANAR, "not a MuJoCo model");
}

static void other_sizes_are_refused_by_name_and_value(void **state) {
  (void)state;
  static const struct {
    const char *file, *from, *to, *text;
  } row[] = {
      {"field.xml", "type=\"sphere\" size=\".02135\"", "type=\"sphere\" size=\".03\"", "ball: radius is 0.03"},
      {"field.xml", "0 .65 .05", "0 .75 .05", "wall_left: y is 0.75"},
      {"field.xml", ".1 .225 .1", ".1 .25 .1", "end_1: half width is 0.25"},
      {"field.xml", ".04 .04 .0375", ".05 .04 .0375", "blue0: half length is 0.05"},
      {"vsss_contact.xml", "mass=\".401\"", "mass=\".5\"", "blue0: mass is 0.524"},
      {"vsss_contact.xml", "type=\"sphere\" size=\".03\"", "type=\"sphere\" size=\".02\"", "wheel radius is 0.02"},
      {"vsss_contact.xml", "pos=\"0 .035 .03\"", "pos=\"0 .03 .03\"", "blue0_left: distance from the middle"},
      {"vsss_contact.xml", "kv=\"3.94e-3\"", "kv=\"5e-3\"", "servo gain is 0.005"},
      {"vsss_contact.xml", "-.0303 .0303", "-.0303 .06", "torque limit is 0.06"},
      {"vsss_contact.xml", "armature=\"2e-5\"", "armature=\"0\"", "rotor inertia is 0"},
      {"vsss_contact.xml", "friction=\".9 .9", "friction=\".5 .5", "friction is 0.5"},
      {"vsss_contact.xml", "6.1e-4 6.1e-4", "1e-3 1e-3", "rolling friction is 0.001"},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    whole_copy();
    copy_with(row[i].file, row[i].from, row[i].to, 0);
    expect_load(VS_DRIVE_CONTACT, row[i].text);
  }
}

static void model_of_the_other_drive_is_refused(void **state) {
  (void)state;
  char path[512];
  assert_ok(vs_path_find("models/vsss_planar.xml", path, sizeof path, err));
  vs_error err = {0};
  vs_model *model = NULL;
  vs_model_def def = vs_model_def_default(VS_DRIVE_CONTACT);
  def.path = path;
  assert_int_equal(vs_model_load(&def, &model, &err), VS_FAIL);
  assert_null(model);
  assert_non_null(strstr(err.text, "joint 'ball'"));
}

static void steps_per_frame_set_the_time_step(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_PLANAR);
  vs_model *model;
  def.substeps_per_frame = 7;
  assert_ok(vs_model_load(&def, &model, err));
  assert_near(vs_model_step_s(model), 1.0 / 210, 1e-12);
  assert_int_equal(vs_model_substeps(model), 7);
  assert_int_equal(vs_model_drive(model), VS_DRIVE_PLANAR);
  vs_model_free(model);
  def.substeps_per_frame = -1;
  vs_error err = {0};
  assert_int_equal(vs_model_load(&def, &model, &err), VS_USAGE);
}

static void drives_are_known_by_name(void **state) {
  (void)state;
  vs_drive drive;
  vs_error err = {0};
  assert_ok(vs_drive_parse("planar", &drive, err));
  assert_int_equal(drive, VS_DRIVE_PLANAR);
  assert_string_equal(vs_drive_name(VS_DRIVE_CONTACT), "contact");
  assert_int_equal(vs_drive_parse("wheels", &drive, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "'wheels'"));
}

// Table 1: block, two slabs along x, two along y, cap; about the centre of mass of all but the wheels.
static void inertia_in_the_model_is_that_of_table_1(void **state) {
  (void)state;
  static const struct {
    double mass, x, y, z, a, b, c;
  } part[] = {
      {0.396, 0, 0, 0.035, 0.079, 0.060, 0.060},         {0.001, 0.03975, 0, 0.035, 0.0005, 0.080, 0.060},
      {0.001, -0.03975, 0, 0.035, 0.0005, 0.080, 0.060}, {0.001, 0, 0.03975, 0.035, 0.080, 0.0005, 0.060},
      {0.001, 0, -0.03975, 0.035, 0.080, 0.0005, 0.060}, {0.001, 0, 0, 0.0725, 0.080, 0.080, 0.015},
  };
  double mass = 0, height = 0, inertia[3] = {0};
  for (int i = 0; i < 6; i++) {
    mass += part[i].mass;
    height += part[i].mass * part[i].z;
  }
  height /= mass;
  for (int i = 0; i < 6; i++) {
    double m = part[i].mass, x = part[i].x, y = part[i].y, z = part[i].z - height;
    double a = part[i].a * part[i].a / 12, b = part[i].b * part[i].b / 12, c = part[i].c * part[i].c / 12;
    inertia[0] += m * (b + c + y * y + z * z);
    inertia[1] += m * (a + c + x * x + z * z);
    inertia[2] += m * (a + b + x * x + y * y);
  }
  const mjModel *m = vs_model_mjmodel(arena_model[VS_DRIVE_CONTACT]);
  int body = mj_name2id(m, mjOBJ_BODY, "yellow2");
  assert_near(m->body_mass[body], mass, 1e-9);
  assert_near(m->body_ipos[3 * body + 2], height, 1e-7);
  // The planar drive's body carries its wheels: 12 g discs of 3 cm and 6 mm, 3.5 cm from the middle.
  double wheels = 2 * 0.012 * ((3 * 0.03 * 0.03 + 0.006 * 0.006) / 12 + 0.035 * 0.035);
  const mjModel *planar = vs_model_mjmodel(arena_model[VS_DRIVE_PLANAR]);
  int planar_body = mj_name2id(planar, mjOBJ_BODY, "yellow2");
  assert_near(planar->body_mass[planar_body], mass + 0.024, 1e-9);
  assert_near(planar->body_inertia[3 * planar_body + 2], inertia[2] + wheels, 1e-9);
  for (int i = 0; i < 3; i++) {
    // MuJoCo stores principal moments in its own order; the three values are distinct enough to be found.
    double nearest = 1;
    for (int k = 0; k < 3; k++) nearest = fmin(nearest, fabs(m->body_inertia[3 * body + k] - inertia[i]));
    assert_near(nearest, 0, 1e-9);
  }
}

static int open_all(void **state) { return make_folder(state) || arena_open(state); }
static int close_all(void **state) { return remove_folder(state) || arena_close(state); }

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unchanged_copies_load),
      cmocka_unit_test(missing_and_truncated_files_are_refused),
      cmocka_unit_test(other_sizes_are_refused_by_name_and_value),
      cmocka_unit_test(model_of_the_other_drive_is_refused),
      cmocka_unit_test(steps_per_frame_set_the_time_step),
      cmocka_unit_test(drives_are_known_by_name),
      cmocka_unit_test(inertia_in_the_model_is_that_of_table_1),
  };
  return cmocka_run_group_tests(tests, open_all, close_all);
}
