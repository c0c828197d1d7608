// Tests src/league_net/udp.c and port_holder.c: loopback, multicast, and who holds a port.
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/clock.h"
#include "vsss/udp.h"

static int base; // ports of this process

static void must_receive(const vs_udp *from, const char *expected) {
  uint8_t bytes[64];
  size_t size = 0;
  const vs_udp *list[] = {from};
  assert_true(vs_udp_wait(list, 1, vs_clock_monotonic_us() + 5000000));
  assert_true(vs_udp_receive(from, bytes, sizeof bytes, &size));
  assert_int_equal(size, strlen(expected));
  assert_memory_equal(bytes, expected, size);
}

static void unicast_arrives_and_a_longer_datagram_tells_its_size(void **state) {
  (void)state;
  vs_udp in, out;
  uint8_t bytes[16], big[3000] = {0};
  size_t size;
  assert_ok(vs_udp_listen(base, NULL, &in, err));
  assert_ok(vs_udp_sender("127.0.0.1", base, NULL, &out, err));
  assert_false(vs_udp_receive(&in, bytes, sizeof bytes, &size));
  assert_true(vs_udp_send(&out, (const uint8_t *)"wheels", 6));
  must_receive(&in, "wheels");
  assert_true(vs_udp_send(&out, big, sizeof big));
  const vs_udp *list[] = {&in};
  assert_true(vs_udp_wait(list, 1, vs_clock_monotonic_us() + 5000000));
  assert_true(vs_udp_receive(&in, bytes, sizeof bytes, &size));
  assert_int_equal(size, sizeof big);
  vs_udp_close(&in);
  vs_udp_close(&out);
}

static void a_group_reaches_two_who_joined(void **state) {
  (void)state;
  vs_udp first, second, out;
  assert_ok(vs_udp_join("224.5.23.2", base + 1, NULL, &first, err));
  assert_ok(vs_udp_join("224.5.23.2", base + 1, NULL, &second, err));
  assert_ok(vs_udp_sender("224.5.23.2", base + 1, NULL, &out, err));
  assert_true(vs_udp_send(&out, (const uint8_t *)"kick-off", 8));
  must_receive(&first, "kick-off");
  must_receive(&second, "kick-off");
  vs_udp_close(&first);
  vs_udp_close(&second);
  vs_udp_close(&out);
}

static void a_port_in_use_names_its_holder(void **state) {
  (void)state;
  vs_udp in, again, claim;
  vs_error err = {0};
  char self[64];
  snprintf(self, sizeof self, "process %d (", (int)getpid());
  assert_ok(vs_udp_listen(base + 2, NULL, &in, err));
  assert_int_equal(vs_udp_listen(base + 2, NULL, &again, &err), VS_FAIL);
  if (!strstr(err.text, self) || !strstr(err.text, "--ports")) fail_msg("%s", err.text);
  vs_udp_close(&in);
  assert_ok(vs_udp_listen(base + 2, NULL, &in, err));
  vs_udp_close(&in);

  assert_ok(vs_udp_claim("224.0.0.1", base + 3, &claim, err));
  assert_int_equal(vs_udp_claim("224.0.0.1", base + 3, &again, &err), VS_FAIL);
  if (!strstr(err.text, self)) fail_msg("%s", err.text);
  assert_ok(vs_udp_claim("224.0.0.1", base + 4, &again, err));
  vs_udp_close(&again);
  vs_udp_close(&claim);
}

static void an_unknown_interface_is_refused_with_the_known_ones(void **state) {
  (void)state;
  vs_udp out;
  vs_error err = {0};
  assert_int_equal(vs_udp_sender("224.0.0.1", base, "hall0", &out, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "'hall0'"));
  assert_non_null(strstr(err.text, "lo"));
}

int main(void) {
  base = 21000 + (int)(getpid() % 4000) * 8;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unicast_arrives_and_a_longer_datagram_tells_its_size),
      cmocka_unit_test(a_group_reaches_two_who_joined),
      cmocka_unit_test(a_port_in_use_names_its_holder),
      cmocka_unit_test(an_unknown_interface_is_refused_with_the_known_ones),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
