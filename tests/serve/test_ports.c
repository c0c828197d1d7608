// Tests src/serve/ports.c: what --ports understands.
#include <string.h>

#include "assert_near.h"
#include "vsss/serve.h"

static void a_shift_moves_all_ports(void **state) {
  (void)state;
  vs_ports p = vs_ports_default();
  assert_ok(vs_ports_parse("+100", &p, err));
  assert_int_equal(p.vision, 10102);
  assert_int_equal(p.command, 20111);
  assert_int_equal(p.team[VS_BLUE], 20113);
  assert_int_equal(p.team[VS_YELLOW], 20112);
  assert_int_equal(p.referee, 10103);
  assert_int_equal(p.placer, 10104);
}

static void names_set_single_ports(void **state) {
  (void)state;
  vs_ports p = vs_ports_default();
  assert_ok(vs_ports_parse("command=30001,yellow=30002", &p, err));
  assert_int_equal(p.command, 30001);
  assert_int_equal(p.team[VS_YELLOW], 30002);
  assert_int_equal(p.vision, 10002);
}

static void what_is_wrong_is_named(void **state) {
  (void)state;
  const char *bad[] = {"+", "+x", "+50000", "vision", "goal=12000", "vision=80", "vision=12000;command=1", "12000"};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    vs_ports p = vs_ports_default();
    vs_error err = {0};
    assert_int_equal(vs_ports_parse(bad[k], &p, &err), VS_USAGE);
    assert_non_null(strstr(err.text, bad[k]));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_shift_moves_all_ports),
      cmocka_unit_test(names_set_single_ports),
      cmocka_unit_test(what_is_wrong_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
