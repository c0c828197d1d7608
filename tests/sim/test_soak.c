// Tests src/sim/*.c and models/*.xml by long play: robots at random and chasing the ball, on both drives. Nothing breaks
// down, leaves the field, tips over or buries the ball. VSSS_SOAK_S sets the simulated seconds per drive (default 40;
// 7200 is the two hours that the arena is asked for).
#include <stdio.h>
#include <stdlib.h>

#include "sim/arena.h"
#include "vsss/rng.h"

// Half of the time random wheels, half of the time straight at the ball, so that it is squeezed and cornered a lot.
static void decide(vs_rng *rng, const vs_world *world, int decision, arena_commands command) {
  for (int i = 0; i < 6; i++) {
    vs_pose pose = world->robot[i / 3][i % 3].pose;
    vs_wheels *wheels = &command[i / 3][i % 3];
    if ((decision / 20 + i) % 2) {
      *wheels = (vs_wheels){vs_rng_range(rng, -46.66, 46.66), vs_rng_range(rng, -46.66, 46.66)};
      continue;
    }
    double to = atan2(world->ball.y_m - pose.y_m, world->ball.x_m - pose.x_m) - pose.theta_rad;
    *wheels = (vs_wheels){46.66 * (cos(to) - sin(to)), 46.66 * (cos(to) + sin(to))};
  }
}

static bool on_the_field(double x_m, double y_m, double margin_m) {
  if (fabs(x_m) <= VS_FIELD_HALF_LENGTH_M - margin_m) return fabs(y_m) <= VS_FIELD_HALF_WIDTH_M - margin_m;
  return fabs(x_m) <= VS_FIELD_HALF_LENGTH_M + VS_GOAL_DEPTH_M - margin_m &&
         fabs(y_m) <= VS_GOAL_HALF_WIDTH_M - margin_m;
}

static double tilt_rad(int drive, int robot) {
  if (drive == VS_DRIVE_PLANAR) return 0;
  const mjModel *m = vs_model_mjmodel(arena_model[drive]);
  const mjData *d = vs_sim_mjdata(arena_sim[drive]);
  char name[16];
  snprintf(name, sizeof name, "%s%d", robot < 3 ? "blue" : "yellow", robot % 3);
  const double *q = d->qpos + m->jnt_qposadr[mj_name2id(m, mjOBJ_JOINT, name)] + 3;
  return acos(vs_clamp(1 - 2 * (q[1] * q[1] + q[2] * q[2]), -1, 1));
}

// Placed anew every 40 s as a training episode would be; the ball also after 10 s in a goal or at rest.
static void kick_off(vs_sim *sim, vs_rng *rng) {
  vs_world world;
  vs_sim_reset(sim, NULL);
  vs_sim_world(sim, &world);
  world.ball.x_m = vs_rng_range(rng, -0.3, 0.3);
  world.ball.y_m = vs_rng_range(rng, -0.5, 0.5);
  vs_sim_place(sim, &world);
}

static void soak(int drive) {
  const char *asked = getenv("VSSS_SOAK_S");
  int frames = 30 * (asked ? atoi(asked) : 40);
  vs_sim *sim = arena_sim[drive];
  vs_rng rng = vs_rng_make(2022, (uint64_t)drive);
  arena_commands command = {{{0}}};
  vs_world world;
  int outside = 0;
  for (int f = 0; f < frames; f++) {
    if (f % 1200 == 0) kick_off(sim, &rng);
    vs_sim_world(sim, &world);
    if (f % 3 == 0) decide(&rng, &world, f / 3, command);
    arena_frames(sim, 1, (const vs_wheels(*)[VS_TEAM_MOST])command);
    vs_sim_world(sim, &world);
    vs_error err = {0};
    if (vs_world_check(&world, &err) != VS_OK) fail_msg("%s", err.text);
    // Walls give way by some millimetres under a crash.
    for (int i = 0; i < 6; i++) {
      vs_pose pose = world.robot[i / 3][i % 3].pose;
      if (!on_the_field(pose.x_m, pose.y_m, VS_ROBOT_SIZE_M / 2 - 0.02)) {
        fail_msg("robot %d outside at %.3f %.3f after %.1f s", i, pose.x_m, pose.y_m, f / 30.0);
      }
      if (tilt_rad(drive, i) > 0.35) fail_msg("robot %d on its side after %.1f s", i, f / 30.0);
    }
    vs_ball ball = world.ball;
    outside = on_the_field(ball.x_m, ball.y_m, VS_BALL_RADIUS_M - 0.015) ? 0 : outside + 1;
    if (outside > 3) fail_msg("ball outside at %.3f %.3f after %.1f s", ball.x_m, ball.y_m, f / 30.0);
    if (ball.z_m < 0.7 * VS_BALL_RADIUS_M || ball.z_m > 0.085)
      fail_msg("ball at height %.3f after %.1f s", ball.z_m, f / 30.0);
  }
}

static void contact_drive_lasts(void **state) {
  (void)state;
  soak(VS_DRIVE_CONTACT);
}

static void planar_drive_lasts(void **state) {
  (void)state;
  soak(VS_DRIVE_PLANAR);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contact_drive_lasts),
      cmocka_unit_test(planar_drive_lasts),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
