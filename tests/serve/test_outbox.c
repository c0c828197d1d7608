// Tests src/serve/outbox.c: what is put is sent when it is due, in order.
#include "serve/outbox.h"

#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/clock.h"

static vs_udp in, to;

static int open_sockets(void **state) {
  (void)state;
  int port = 30000 + (int)(getpid() % 20000);
  return vs_udp_listen(port, NULL, &in, NULL) == VS_OK && vs_udp_sender("127.0.0.1", port, NULL, &to, NULL) == VS_OK
             ? 0
             : -1;
}

static int close_sockets(void **state) {
  (void)state;
  vs_udp_close(&in);
  vs_udp_close(&to);
  return 0;
}

static int next_byte(void) {
  uint8_t byte[4];
  size_t size;
  return vs_udp_receive(&in, byte, sizeof byte, &size) && size == 1 ? byte[0] : -1;
}

static void a_datagram_waits_until_it_is_due(void **state) {
  (void)state;
  vs_outbox *box = NULL;
  assert_ok(vs_outbox_new(&to, &box, err));
  int64_t due_us = vs_clock_monotonic_us() + 300000;
  vs_outbox_put(box, (const uint8_t *)"a", 1, due_us);
  usleep(20000);
  if (vs_clock_monotonic_us() < due_us) assert_int_equal(next_byte(), -1);
  vs_outbox_flush(box);
  assert_true(vs_clock_monotonic_us() >= due_us);
  assert_int_equal(next_byte(), 'a');
  vs_outbox_free(box);
}

// The second waits for the first; those that are late go at once; what is in the box goes before it is freed.
static void all_are_sent_in_order(void **state) {
  (void)state;
  vs_outbox *box = NULL;
  vs_histogram late = {0};
  int64_t unsent = 7;
  assert_ok(vs_outbox_new(&to, &box, err));
  int64_t due_us = vs_clock_monotonic_us() + 50000;
  vs_outbox_put(box, (const uint8_t *)"a", 1, due_us);
  vs_outbox_put(box, (const uint8_t *)"b", 1, due_us - 1000000);
  assert_true(vs_clock_monotonic_us() >= due_us);
  vs_outbox_flush(box);
  vs_outbox_told(box, &late, &unsent);
  assert_int_equal(late.count, 2);
  assert_true(late.max_us >= 1000000); // b's
  assert_int_equal(unsent, 0);
  vs_outbox_put(box, (const uint8_t *)"c", 1, vs_clock_monotonic_us() + 20000);
  vs_outbox_free(box);
  for (int byte = 'a'; byte <= 'c'; byte++) assert_int_equal(next_byte(), byte);
  assert_int_equal(next_byte(), -1);
}

// A closed socket refuses all.
static void what_is_refused_is_counted(void **state) {
  (void)state;
  vs_outbox *box = NULL;
  vs_histogram late = {0};
  int64_t unsent = 0;
  const vs_udp closed = VS_UDP_CLOSED;
  assert_ok(vs_outbox_new(&closed, &box, err));
  vs_outbox_put(box, (const uint8_t *)"a", 1, 0);
  vs_outbox_flush(box);
  vs_outbox_told(box, &late, &unsent);
  assert_int_equal(unsent, 1);
  vs_outbox_free(box);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_datagram_waits_until_it_is_due),
      cmocka_unit_test(all_are_sent_in_order),
      cmocka_unit_test(what_is_refused_is_counted),
  };
  return cmocka_run_group_tests_name("serve/outbox", tests, open_sockets, close_sockets);
}
