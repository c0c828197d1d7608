// Times what a message costs: a world onto the bus, a world through the bus back to its reader (in this process: in memory
// and over multicast), and a command frame through codec and pseudo terminal.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/bus.h"
#include "vsss/clock.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"

enum { RUNS = 201, CALLS = 20 };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Median over RUNS of the mean of CALLS calls.
static void time_it(const char *name, void (*what)(void *), void *user) {
  double us[RUNS];
  for (int run = 0; run < RUNS; run++) {
    int64_t start = vs_clock_monotonic_us();
    for (int i = 0; i < CALLS; i++) what(user);
    us[run] = (double)(vs_clock_monotonic_us() - start) / CALLS;
  }
  qsort(us, RUNS, sizeof *us, by_value);
  printf("bench %s %.2f us\n", name, us[RUNS / 2]);
}

static void publish(void *user) {
  vs_message m = {.channel = VS_CH_STATE};
  m.as.world.asks_team = -1;
  vs_bus_publish(user, &m, NULL);
}

static void hear(const vs_message *message, void *user) { (void)message, (void)user; }

static void there_and_back(void *user) {
  int handled = 0;
  publish(user);
  for (int tries = 0; !handled && tries < 10; tries++) vs_bus_handle(user, 10, &handled, NULL);
}

static void time_bus(const char *url, const char *name) {
  vs_bus *bus;
  vs_error err = {0};
  if (vs_bus_open(url, &bus, &err) != VS_OK) {
    printf("note: %s not measured: %s\n", name, err.text);
    return;
  }
  char line[64];
  snprintf(line, sizeof line, "%s_publish", name);
  time_it(line, publish, bus);
  if (vs_bus_subscribe(bus, VS_CH_STATE, false, hear, NULL, NULL) == VS_OK) time_it(name, there_and_back, bus);
  vs_bus_close(bus);
}

typedef struct line {
  vs_serial *serial;
  vs_pty *pty;
  vs_radio_decoder decoder;
} line;

static void send_frame(void *user) {
  line *l = user;
  vs_radio_frame f = {.type = VS_RADIO_COMMAND, .as.command = {.n = 3}};
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  bool arrived = !vs_serial_write(l->serial, bytes, vs_radio_encode(&f, bytes), 1);
  while (!arrived) {
    size_t n = vs_pty_read(l->pty, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++) arrived |= vs_radio_decode(&l->decoder, bytes[i], &f);
  }
}

int main(void) {
  time_bus("memq://", "bus_memory");
  time_bus("udpm://239.255.76.67:7699?ttl=0", "bus_multicast");
  line l = {0};
  if (vs_pty_new(&l.pty, NULL) != VS_OK) return 1;
  if (vs_serial_open(vs_pty_path(l.pty), VS_SERIAL_BAUD, &l.serial, NULL) != VS_OK) return 1;
  time_it("radio_frame_through_pty", send_frame, &l);
  vs_serial_close(l.serial);
  vs_pty_free(l.pty);
  return 0;
}
