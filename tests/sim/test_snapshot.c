// Tests src/sim/snapshot.c: a restored simulator continues bit for bit, on both drives, randomised or not.
#include <stdlib.h>

#include "sim/arena.h"
#include "vsss/rng.h"

static uint64_t play(vs_sim *sim, vs_rng *rng, int frames) {
  uint64_t hash = VS_HASH_START;
  arena_commands command = {{{0}}};
  vs_world world;
  for (int f = 0; f < frames; f++) {
    for (int i = 0; i < 6 && f % 3 == 0; i++) {
      command[i / 3][i % 3] = (vs_wheels){vs_rng_range(rng, -46, 46), vs_rng_range(rng, -46, 46)};
    }
    assert_ok(vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])command, err));
    vs_sim_world(sim, &world);
    hash = vs_world_hash(hash, &world);
  }
  return hash;
}

static vs_sim_params odd_params(void) {
  vs_sim_params params = vs_sim_params_default();
  params.motor_tau_s = 0.05;
  params.robot_mass_scale = 1.1;
  params.ball_restitution = 0.5;
  params.wheel_radius_scale[VS_BLUE][1] = 1.02;
  params.com_offset_m[VS_YELLOW][0][0] = 0.004;
  params.push_per_s = 3;
  params.push_mps = 0.2;
  params.push_seed = 5;
  return params;
}

static void continues(int drive, const vs_sim_params *params) {
  vs_sim *sim = arena_sim[drive], *fresh;
  assert_ok(vs_sim_new(arena_model[drive], &fresh, err));
  vs_sim_reset(sim, params);
  vs_rng rng = vs_rng_make(3, 0);
  play(sim, &rng, 40);
  void *state = malloc(vs_sim_state_size(sim));
  assert_int_equal(vs_sim_state_size(sim), vs_sim_state_size(fresh));
  vs_sim_save(sim, state);
  vs_rng at_save = rng;
  uint64_t expected = play(sim, &rng, 60);

  rng = at_save;
  assert_ok(vs_sim_restore(sim, state, err)); // into the same simulator, later in time
  assert_true(play(sim, &rng, 60) == expected);
  rng = at_save;
  assert_ok(vs_sim_restore(fresh, state, err)); // into one that knows nothing of this match
  assert_true(play(fresh, &rng, 60) == expected);
  free(state);
  vs_sim_free(fresh);
}

static void contact_drive_continues_bit_for_bit(void **state) {
  (void)state;
  continues(VS_DRIVE_CONTACT, NULL);
}

static void planar_drive_continues_bit_for_bit(void **state) {
  (void)state;
  continues(VS_DRIVE_PLANAR, NULL);
}

static void randomised_match_continues_bit_for_bit(void **state) {
  (void)state;
  vs_sim_params params = odd_params();
  continues(VS_DRIVE_CONTACT, &params);
  continues(VS_DRIVE_PLANAR, &params);
}

// A match does not depend on what its simulator played before.
static void reset_forgets_the_match_before(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    uint64_t hash[2];
    vs_sim_params params = odd_params();
    for (int run = 0; run < 2; run++) {
      vs_sim_reset(arena_sim[drive], NULL);
      vs_rng rng = vs_rng_make(8, 0);
      hash[run] = play(arena_sim[drive], &rng, 60);
      vs_sim_reset(arena_sim[drive], &params);
      play(arena_sim[drive], &rng, 20);
    }
    assert_true(hash[0] == hash[1]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contact_drive_continues_bit_for_bit),
      cmocka_unit_test(planar_drive_continues_bit_for_bit),
      cmocka_unit_test(randomised_match_continues_bit_for_bit),
      cmocka_unit_test(reset_forgets_the_match_before),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
