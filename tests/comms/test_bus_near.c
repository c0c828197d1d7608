// src/comms/bus_near.c
#define _GNU_SOURCE // syscall
#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "assert_near.h"
#include "comms/bus_near.h"
#include "vsss/clock.h"

// Stands before the C library's: looking an address up is binding a socket to it.
static int binds;
int bind(int fd, const struct sockaddr *address, socklen_t size) {
  binds++;
  return (int)syscall(SYS_bind, fd, address, size);
}

static vs_near near_;
static int speaker;
static struct sockaddr_in group = {.sin_family = AF_INET};

static bool open_both(void) {
  char url[64];
  int port = 20000 + (int)(getpid() % 20000);
  snprintf(url, sizeof url, "udpm://239.255.76.67:%d?ttl=0", port);
  vs_error err = {0};
  memset(&near_, 0, sizeof near_);
  if (vs_near_open(&near_, url, &err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return false;
  }
  group.sin_port = htons((uint16_t)port);
  inet_pton(AF_INET, "239.255.76.67", &group.sin_addr);
  speaker = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  return true;
}

static bool say(int number) {
  char text[64] = "LC02....VSSS_CMD";
  memcpy(text + 4, &number, 4);
  text[sizeof "LC02....VSSS_CMD"] = (char)number; // after the channel's end: the data
  ssize_t size = sizeof "LC02....VSSS_CMD" + 1;
  return sendto(speaker, text, (size_t)size, 0, (struct sockaddr *)&group, sizeof group) == size;
}

// Waits up to 2 s for a message.
static bool hear(const uint8_t **data) {
  const char *channel;
  size_t size;
  for (int i = 0; i < 2000; i++) {
    if (vs_near_read(&near_, &channel, data, &size)) return !strcmp(channel, "VSSS_CMD") && size == 1;
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 1000);
  }
  return false;
}

static void a_sender_is_looked_up_once_for_many_messages(void **state) {
  (void)state;
  const uint8_t *data;
  if (!open_both()) skip();
  int before = binds;
  if (!say(1)) skip(); // no multicast route
  assert_true(hear(&data));
  for (int i = 2; i < 20; i++) {
    near_.last_us = vs_clock_monotonic_us(); // however slow the machine is
    assert_true(say(i));
    assert_true(hear(&data));
    assert_int_equal(*data, i);
  }
  assert_int_equal(binds - before, 1);
  close(speaker);
  vs_near_close(&near_);
}

// An address moves to another machine: after a second it is looked up again.
static void what_is_known_of_a_sender_is_forgotten(void **state) {
  (void)state;
  const uint8_t *data;
  if (!open_both()) skip();
  if (!say(1)) skip();
  assert_true(hear(&data));
  int before = binds;
  near_.last_us -= VS_NEAR_KNOWN_US + 1;
  near_.last_near = false;
  assert_true(say(2));
  assert_true(hear(&data)); // found to be near again
  assert_int_equal(binds - before, 1);
  near_.last_us = vs_clock_monotonic_us() + 60 * 1000000LL; // as if it were known to be another machine's
  near_.last_near = false;
  int64_t far = near_.far;
  assert_true(say(3));
  const char *channel;
  size_t size;
  for (int i = 0; i < 2000 && near_.far == far; i++) {
    assert_false(vs_near_read(&near_, &channel, &data, &size));
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 1000);
  }
  assert_int_equal(near_.far, far + 1);
  close(speaker);
  vs_near_close(&near_);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_sender_is_looked_up_once_for_many_messages),
      cmocka_unit_test(what_is_known_of_a_sender_is_forgotten),
  };
  return cmocka_run_group_tests_name("comms/bus_near", tests, NULL, NULL);
}
