// Tests src/sim/nearby.c: leaving out the contact pairs that are out of reach changes nothing, bit for bit.
#include "../../src/sim/sim_internal.h"
#include "sim/arena.h"
#include "vsss/rng.h"

// Robots chase the ball, so that everything meets everything and every wall.
static uint64_t play(vs_sim *sim, bool all_pairs, const vs_sim_params *params, int *fewest) {
  uint64_t hash = VS_HASH_START;
  vs_rng rng = vs_rng_make(5, 0);
  arena_commands command = {{{0}}};
  vs_world world;
  sim->test_all_pairs = all_pairs;
  vs_sim_reset(sim, params);
  vs_sim_world(sim, &world);
  for (int f = 0; f < 600; f++) {
    for (int i = 0; i < 6 && f % 3 == 0; i++) {
      vs_pose pose = world.robot[i / 3][i % 3].pose;
      double to = atan2(world.ball.y_m - pose.y_m, world.ball.x_m - pose.x_m) - pose.theta_rad;
      double v = 46 * cos(to) + vs_rng_range(&rng, -20, 20), w = 30 * sin(to);
      command[i / 3][i % 3] = (vs_wheels){v - w, v + w};
    }
    if (vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])command, NULL) != VS_OK) fail();
    vs_sim_world(sim, &world);
    hash = vs_world_hash(hash, &world);
    if (sim->view.npair < *fewest) *fewest = sim->view.npair;
  }
  sim->test_all_pairs = false;
  return hash;
}

static void play_is_the_same_with_all_pairs_tested(void **state) {
  (void)state;
  vs_sim_params odd = vs_sim_params_default();
  odd.robot_mass_scale = 0.9;
  odd.ball_restitution = 0.7;
  for (int drive = 0; drive < 2; drive++) {
    for (int k = 0; k < 2; k++) {
      int all = arena_model[drive]->mj->npair, fewest = all, fewest_of_all = all;
      uint64_t some = play(arena_sim[drive], false, k ? &odd : NULL, &fewest);
      assert_true(some == play(arena_sim[drive], true, k ? &odd : NULL, &fewest_of_all));
      assert_true(fewest < all / 2 && fewest_of_all == all);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(play_is_the_same_with_all_pairs_tested)};
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
