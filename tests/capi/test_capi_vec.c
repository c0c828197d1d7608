// src/capi/capi_vec.c, with the handshake of src/capi/capi.c and the settings of src/capi/settings.c
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "vsss/capi.h"

enum { ENVS = 2, ROWS = ENVS * 3 };

typedef struct arrays {
  float observation[ROWS * 464], final_observation[ROWS * 464], action[ROWS * 2], reward[ROWS], episode_s[ENVS];
  double terms[ROWS * 32];
  uint8_t terminated[ROWS], truncated[ROWS], done[ENVS];
  int32_t score[ENVS * 2], event[ENVS * 2];
} arrays;

static char said[640];
#define SAID said, sizeof said

static vs_capi_about hello(void) {
  vs_capi_about about;
  assert_int_equal(vs_capi_hello(VS_CAPI_VERSION, sizeof about, &about, SAID), 0);
  return about;
}

static vs_capi_vec *open_vec(arrays *a) {
  const char *const settings[] = {"envs=2", "yellow=emc:", "episode_s=1", "reward=goals,progress=2", NULL};
  vs_capi_vec *v = NULL;
  if (vs_capi_vec_new(settings, &v, SAID) != 0) fail_msg("%s", said);
  size_t terms = (size_t)ROWS * (size_t)hello().reward_terms * sizeof(double);
  const struct {
    const char *name;
    void *data;
    size_t bytes;
  } list[] = {{"observation", a->observation, sizeof a->observation},
              {"final_observation", a->final_observation, sizeof a->final_observation},
              {"action", a->action, sizeof a->action},
              {"reward", a->reward, sizeof a->reward},
              {"reward_terms", a->terms, terms},
              {"terminated", a->terminated, sizeof a->terminated},
              {"truncated", a->truncated, sizeof a->truncated},
              {"done", a->done, sizeof a->done},
              {"score", a->score, sizeof a->score},
              {"episode_s", a->episode_s, sizeof a->episode_s},
              {"event", a->event, sizeof a->event}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    assert_int_equal(vs_capi_vec_step(v, 0, SAID), 2); // an array is not bound yet
    assert_int_equal(vs_capi_vec_bind(v, 0, list[i].name, list[i].data, list[i].bytes, SAID), 0);
  }
  assert_int_equal(vs_capi_vec_reset(v, 0, (uint64_t[]){7}, 1, NULL, SAID), 0);
  return v;
}

static void another_version_or_size_is_refused(void **state) {
  (void)state;
  vs_capi_about about = {.release = "untouched"};
  assert_int_equal(vs_capi_hello(VS_CAPI_VERSION + 1, sizeof about, &about, SAID), 2);
  assert_non_null(strstr(said, "from one release"));
  assert_int_equal(vs_capi_hello(VS_CAPI_VERSION, sizeof about - 4, &about, SAID), 2);
  assert_string_equal(about.release, "untouched");
  assert_int_equal(hello().observation, 464);
  assert_int_equal(hello().size, sizeof about);
}

static void settings_are_refused_by_name_with_what_is_allowed(void **state) {
  (void)state;
  const struct {
    const char *setting, *expected;
  } wrong[] = {{"drve=planar", "did you mean 'drive'"},
               {"drive=hover", "contact or planar"},
               {"envs=0", "allowed are 1 to 4096"},
               {"rules=chess", "paper"},
               {"reward=dense,gaol=3", "goal, foul"},
               {"realism=latency_s = 3\n", "realism:1"},
               {"yellow=ghost:", "emc:"},
               {"placement=here", "random"},
               {"start_open=0.9\nx", "expected a number"},
               {"realism=/no/such.ini", "/no/such.ini"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vs_capi_vec *v = NULL;
    assert_int_not_equal(vs_capi_vec_new((const char *[]){wrong[i].setting, NULL}, &v, SAID), 0);
    assert_null(v);
    if (!strstr(said, wrong[i].expected)) fail_msg("'%s' says: %s", wrong[i].setting, said);
  }
}

static void a_step_writes_the_weighted_rewards_and_the_ends(void **state) {
  (void)state;
  arrays *a = calloc(1, sizeof *a);
  vs_capi_vec *v = open_vec(a);
  assert_int_equal(vs_capi_vec_rows(v), ROWS);
  int terms = hello().reward_terms;
  double weights[32];
  assert_int_equal(vs_capi_reward("goals,progress=2", weights, SAID), 0);
  int ended = 0;
  for (int step = 0; step < 25; step++) {
    for (int k = 0; k < ROWS * 2; k++) a->action[k] = (float)((k + step) % 3 - 1);
    assert_int_equal(vs_capi_vec_step(v, 0, SAID), 0);
    for (int row = 0; row < ROWS; row++) {
      double sum = 0;
      for (int k = 0; k < terms; k++) sum += weights[k] * a->terms[row * terms + k];
      assert_true(fabs(sum - a->reward[row]) < 1e-5);
      assert_int_equal(a->terminated[row] + a->truncated[row], a->done[row / 3]);
      ended += a->truncated[row];
    }
  }
  assert_true(ended >= 3); // an episode lasts 10 steps
  assert_int_equal(vs_capi_vec_free(v, SAID), 0);
  free(a);
}

static void an_action_that_is_no_number_moves_no_match(void **state) {
  (void)state;
  arrays *a = calloc(1, sizeof *a);
  vs_capi_vec *v = open_vec(a);
  uint64_t before, after;
  assert_int_equal(vs_capi_vec_hash(v, &before, SAID), 0);
  a->action[9] = NAN;
  assert_int_equal(vs_capi_vec_step(v, 0, SAID), 2);
  assert_non_null(strstr(said, "row 4, wheel 1"));
  assert_int_equal(vs_capi_vec_hash(v, &after, SAID), 0);
  assert_int_equal(before, after);
  a->action[9] = 0;
  assert_int_equal(vs_capi_vec_step(v, 0, SAID), 0);
  assert_int_equal(vs_capi_vec_bind(v, 0, "observation", a->observation, 12, SAID), 2);
  assert_int_equal(vs_capi_vec_bind(v, VS_CAPI_SETS, "observation", a->observation, sizeof a->observation, SAID), 2);
  assert_int_equal(vs_capi_vec_bind(v, 0, "colour", a->observation, 1, SAID), 2);
  double world[VS_CAPI_WORLD];
  assert_int_equal(vs_capi_vec_world(v, ENVS, 0, 0, world, SAID), 2);
  assert_int_equal(vs_capi_vec_world(v, 0, 0, 0, world, SAID), 0);
  assert_true(world[0] > 0.09 && world[0] < 0.11 && world[1] == 1.0);
  assert_int_equal(vs_capi_vec_free(v, SAID), 0);
  free(a);
}

static void a_snapshot_fits_its_own_settings_alone(void **state) {
  (void)state;
  arrays *a = calloc(1, sizeof *a);
  vs_capi_vec *v = open_vec(a), *other = NULL;
  size_t size;
  assert_int_equal(vs_capi_vec_state_size(v, &size, SAID), 0);
  unsigned char *block = malloc(size + 1), *unaligned = block + 1;
  assert_int_equal(vs_capi_vec_save(v, unaligned, size, SAID), 0);
  uint64_t then[2];
  for (int run = 0; run < 2; run++) {
    for (int i = 0; i < 15; i++) assert_int_equal(vs_capi_vec_step(v, 0, SAID), 0);
    assert_int_equal(vs_capi_vec_hash(v, &then[run], SAID), 0);
    assert_int_equal(vs_capi_vec_restore(v, unaligned, size, SAID), 0);
  }
  assert_int_equal(then[0], then[1]);
  assert_int_equal(vs_capi_vec_restore(v, unaligned, size - 1, SAID), 2);
  const char *const settings[] = {"envs=2", "yellow=inf:", "episode_s=1", "reward=goals,progress=2", NULL};
  assert_int_equal(vs_capi_vec_new(settings, &other, SAID), 0);
  assert_int_equal(vs_capi_vec_restore(other, unaligned, size, SAID), 2);
  assert_non_null(strstr(said, "other settings"));
  memset(unaligned, 1, size);
  assert_int_equal(vs_capi_vec_restore(v, unaligned, size, SAID), 2);
  assert_non_null(strstr(said, "not a snapshot"));
  vs_capi_vec_free(v, SAID);
  vs_capi_vec_free(other, SAID);
  free(block);
  free(a);
}

static void a_fork_is_told_to_make_its_own(void **state) {
  (void)state;
  arrays *a = calloc(1, sizeof *a);
  vs_capi_vec *v = open_vec(a);
  pid_t child = fork();
  if (child == 0) {
    int bad = vs_capi_vec_step(v, 0, SAID) != 2 || !strstr(said, "after the fork") || vs_capi_vec_free(v, SAID) != 2;
    _exit(bad);
  }
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
  assert_int_equal(vs_capi_vec_step(v, 0, SAID), 0);
  assert_int_equal(vs_capi_vec_free(v, SAID), 0);
  free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(another_version_or_size_is_refused),
      cmocka_unit_test(settings_are_refused_by_name_with_what_is_allowed),
      cmocka_unit_test(a_step_writes_the_weighted_rewards_and_the_ends),
      cmocka_unit_test(an_action_that_is_no_number_moves_no_match),
      cmocka_unit_test(a_snapshot_fits_its_own_settings_alone),
      cmocka_unit_test(a_fork_is_told_to_make_its_own),
  };
  return cmocka_run_group_tests_name("capi/capi_vec", tests, NULL, NULL);
}
