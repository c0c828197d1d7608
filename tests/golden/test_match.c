// tests/golden/match.txt: hashes of a short match (src/env/env.c), keyed by what the last bit of a result depends on
#include <gnu/libc-version.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>

#include "assert_near.h"
#include "vsss/env.h"

#define GOLDEN  "tests/golden/match.txt"
#define SEED    2022
#define SECONDS 20

// MuJoCo's arithmetic and the C library's sin, cos and exp, whose variant is chosen by the processor.
static void key_of_this_machine(char *key, size_t size) {
  struct utsname machine;
  uname(&machine);
  const char *variant = "";
#if defined(__x86_64__)
  variant = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "+avx2+fma" : "";
#endif
  snprintf(key, size, "mujoco-%s glibc-%s %s%s", mj_versionString(), gnu_get_libc_version(), machine.machine, variant);
}

static uint64_t hash_of_a_match(vs_drive drive) {
  vs_model *model = NULL;
  vs_model_def model_def = vs_model_def_default(drive);
  assert_ok(vs_model_load(&model_def, &model, err));
  vs_env_def def = vs_env_def_default(model);
  def.player[VS_BLUE] = "emc:";
  def.player[VS_YELLOW] = "inf:";
  def.referee.duration_s = SECONDS;
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, SEED, err));
  while (!vs_env_over(env)) assert_ok(vs_env_frame(env, NULL, err));
  uint64_t hash = vs_env_hash(env);
  vs_env_free(env);
  vs_model_free(model);
  return hash;
}

// Finds "KEY DRIVE HASH" of this machine and drive; false where there is none.
static bool find_golden(const char *key, const char *drive, unsigned long long *hash) {
  FILE *file = fopen(GOLDEN, "r");
  if (!file) fail_msg("%s: cannot be read; run from the top of the checkout", GOLDEN);
  char line[256], prefix[200];
  size_t length = (size_t)snprintf(prefix, sizeof prefix, "%s %s ", key, drive);
  bool found = false;
  while (!found && fgets(line, sizeof line, file))
    found = !strncmp(line, prefix, length) && sscanf(line + length, "%llx", hash) == 1;
  fclose(file);
  return found;
}

static void check(vs_drive drive) {
  char key[128];
  unsigned long long expected = 0, hash = hash_of_a_match(drive);
  key_of_this_machine(key, sizeof key);
  if (!find_golden(key, vs_drive_name(drive), &expected)) {
    print_message("note: %s has no line '%s %s %016llx'\n", GOLDEN, key, vs_drive_name(drive), hash);
    skip();
  }
  if (hash != expected)
    fail_msg("EMC against INF, %d s, %s drive: hash %016llx, expected %016llx. Where a change of play was meant, put "
             "this line into %s: %s %s %016llx",
             SECONDS, vs_drive_name(drive), hash, expected, GOLDEN, key, vs_drive_name(drive), hash);
}

static void the_contact_drives_match_has_its_golden_hash(void **state) {
  (void)state;
  check(VS_DRIVE_CONTACT);
}

static void the_planar_drives_match_has_its_golden_hash(void **state) {
  (void)state;
  check(VS_DRIVE_PLANAR);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_contact_drives_match_has_its_golden_hash),
      cmocka_unit_test(the_planar_drives_match_has_its_golden_hash),
  };
  return cmocka_run_group_tests_name("golden/match", tests, NULL, NULL);
}
