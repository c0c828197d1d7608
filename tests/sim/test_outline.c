// Tests src/sim/outline.c: the contacts MuJoCo gets for robots of the planar drive.
#include "sim/arena.h"
#include "vsss/rng.h"

// The contacts of blue 0 with geom `other`, where blue 0 and yellow 0 stand as given.
static int contacts(const mjModel *m, vs_pose blue, vs_pose yellow, const char *other, const mjContact **first) {
  vs_sim *sim = arena_sim[VS_DRIVE_PLANAR];
  vs_world world = {0};
  for (int i = 0; i < 6; i++) world.robot[i / 3][i % 3].pose = (vs_pose){-0.5 + 0.2 * i, 0.55, 0};
  world.robot[VS_BLUE][0].pose = blue;
  world.robot[VS_YELLOW][0].pose = yellow;
  vs_sim_place(sim, &world);
  mjData *d = vs_sim_mjdata(sim);
  mj_forward(m, d);
  int one = mj_name2id(m, mjOBJ_GEOM, "blue0"), two = mj_name2id(m, mjOBJ_GEOM, other), count = 0;
  assert_true(one >= 0 && two >= 0);
  for (int i = 0; i < d->ncon; i++) {
    const mjContact *c = &d->contact[i];
    if (!(c->geom1 == one && c->geom2 == two) && !(c->geom1 == two && c->geom2 == one)) continue;
    if (count++ == 0) *first = c;
  }
  return count;
}

static const mjModel *planar(void) { return vs_model_mjmodel(arena_model[VS_DRIVE_PLANAR]); }

// Two robots of 8 cm, 7.9 cm apart and 2 cm aside: faces overlap by 1 mm, over the 6 cm from y = -0.02 to 0.04.
static void two_faces_touch_at_the_ends_of_what_they_share(void **state) {
  (void)state;
  const mjContact *c = NULL;
  assert_int_equal(contacts(planar(), (vs_pose){0, 0, 0}, (vs_pose){0.079, 0.02, 0}, "yellow0", &c), 2);
  for (int i = 0; i < 2; i++) {
    assert_near(c[i].dist, -0.001, 1e-12);
    assert_near(c[i].pos[0], 0.0395, 1e-12); // midway between the faces at 0.040 and 0.039
    assert_near(c[i].frame[0], 1.0, 1e-12);  // from blue 0, the first of the pair, to yellow 0
  }
  assert_near(fmin(c[0].pos[1], c[1].pos[1]), -0.02, 1e-12);
  assert_near(fmax(c[0].pos[1], c[1].pos[1]), 0.04, 1e-12);
}

// Yellow 0 on its corner: half its diagonal is 4 cm x sqrt(2) = 56.57 mm, and 96 mm apart it is 0.57 mm inside.
static void a_corner_touches_a_face_once(void **state) {
  (void)state;
  const mjContact *c = NULL;
  assert_int_equal(contacts(planar(), (vs_pose){0, 0, 0}, (vs_pose){0.096, 0, VS_PI / 4 + 1e-3}, "yellow0", &c), 1);
  assert_near(c->dist, 0.096 - 0.04 - 0.04 * sqrt(2.0), 1e-6);
  assert_near(c->pos[1], 0.0, 1e-3);
}

static void robots_apart_do_not_touch(void **state) {
  (void)state;
  const mjContact *c = NULL;
  assert_int_equal(contacts(planar(), (vs_pose){0, 0, 0}, (vs_pose){0.0801, 0, 0}, "yellow0", &c), 0);
  // Their circles overlap, but not the squares, turned corner to corner: 2 x 56.57 mm.
  assert_int_equal(contacts(planar(), (vs_pose){0, 0, VS_PI / 4}, (vs_pose){0.08, 0.0802, VS_PI / 4}, "yellow0", &c),
                   0);
}

// The right wall's inner face is y = -0.65, and the robot's side reaches 40 mm from its middle.
static void a_robot_touches_a_wall_with_two_corners(void **state) {
  (void)state;
  const mjContact *c = NULL;
  vs_pose away = {0.3, 0, 0};
  assert_int_equal(contacts(planar(), (vs_pose){0.1, -0.612, 0}, away, "wall_right", &c), 2);
  assert_near(c[0].dist, -0.002, 1e-12);
  assert_near(c[0].frame[1], 1.0, 1e-12); // out of the wall
  assert_near(fabs(c[1].pos[0] - c[0].pos[0]), 0.08, 1e-12);
  assert_int_equal(contacts(planar(), (vs_pose){0.1, -0.609, 0}, away, "wall_right", &c), 0);
}

// As boxes, MuJoCo finds each of these twice, one over the other, in the same direction. Its depth between boxes is half
// the overlap (2.2.2: the two faces of the first test get 0.5 mm); between a plane and a box it is all of it, as ours.
static void contacts_are_those_of_mujocos_boxes_without_the_second_storey(void **state) {
  (void)state;
  mjModel *boxes = mj_copyModel(NULL, planar());
  memset(boxes->geom_user, 0, sizeof(double) * (size_t)(boxes->ngeom * boxes->nuser_geom));
  vs_rng rng = vs_rng_make(4, 0);
  int touched = 0, same_way = 0;
  for (int i = 0; i < 2000; i++) {
    vs_pose blue = {vs_rng_range(&rng, -0.2, 0.2), vs_rng_range(&rng, -0.2, 0.2), vs_rng_range(&rng, -VS_PI, VS_PI)};
    double way = vs_rng_range(&rng, -VS_PI, VS_PI), far = vs_rng_range(&rng, 0.078, 0.11);
    vs_pose yellow = {blue.x_m + far * cos(way), blue.y_m + far * sin(way), vs_rng_range(&rng, -VS_PI, VS_PI)};
    const mjContact *c = NULL;
    int n = contacts(planar(), blue, yellow, "yellow0", &c);
    double deepest = 0, x = 0, y = 0;
    for (int k = 0; k < n; k++) {
      if (c[k].dist >= deepest) continue;
      deepest = c[k].dist;
      x = c[k].frame[0];
      y = c[k].frame[1];
    }
    int doubled = contacts(boxes, blue, yellow, "yellow0", &c);
    assert_int_equal(n > 0, doubled > 0);
    assert_true(doubled >= n);
    double box_deepest = 0;
    for (int k = 0; k < doubled; k++) box_deepest = fmin(box_deepest, c[k].dist);
    if (n == 0 || deepest < -0.01) continue; // deeper than play ever gets, the shallowest way out is a matter of taste
    touched++;
    same_way += c->frame[0] * x + c->frame[1] * y > 0.999;
    assert_near(deepest, 2 * box_deepest, 1e-6);
  }
  assert_true(touched > 300);
  assert_true(same_way > 0.98 * touched); // where two ways out are equally short, either may be taken
  mj_deleteModel(boxes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_faces_touch_at_the_ends_of_what_they_share),
      cmocka_unit_test(a_corner_touches_a_face_once),
      cmocka_unit_test(robots_apart_do_not_touch),
      cmocka_unit_test(a_robot_touches_a_wall_with_two_corners),
      cmocka_unit_test(contacts_are_those_of_mujocos_boxes_without_the_second_storey),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
