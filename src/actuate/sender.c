#include "vsss/sender.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "vsss/clock.h"

#define LAST_FRAMES_US 5000 // between the stops on the way out
#define DRAIN_MS       200
#define LISTEN_US      5000 // telemetry is looked for this often, so that its round trip is true
#define SENDERS_MAX    4    // of one process, for the last stop
#define SEQ_AHEAD      16   // of any frame that another thread is writing while the program dies

struct vs_sender {
  pthread_t thread;
  pthread_mutex_t lock; // of all below
  bool stop;
  vs_radio_link link;
  vs_serial *serial; // NULL: dry
};

// What a dying program still has to stop.
static _Atomic(vs_sender *) open_senders[SENDERS_MAX];
static atomic_bool dying;

static void remember(vs_sender *s) {
  for (int i = 0; i < SENDERS_MAX; i++) {
    vs_sender *none = NULL;
    if (atomic_compare_exchange_strong(&open_senders[i], &none, s)) return;
  }
}

static void forget(vs_sender *s) {
  for (int i = 0; i < SENDERS_MAX; i++) {
    vs_sender *mine = s;
    if (atomic_compare_exchange_strong(&open_senders[i], &mine, NULL)) return;
  }
}

// With the lock held.
static void write_frame(vs_sender *s, const uint8_t *bytes, size_t size, int64_t now_us) {
  if (size && s->serial && !dying) vs_serial_write(s->serial, bytes, size, now_us);
}

// The thread that dies may hold the lock, and others go on: the link is copied as it is, its numbers are jumped over.
void vs_sender_last_stop(void) {
  if (atomic_exchange(&dying, true)) return;
  int before = errno;
  for (int frame = 0; frame < VS_RADIO_STOP_FRAMES; frame++) {
    for (int i = 0; i < SENDERS_MAX; i++) {
      const vs_sender *s = open_senders[i];
      int fd = s && s->serial ? vs_serial_fd(s->serial) : -1;
      if (fd < 0) continue;
      uint8_t bytes[VS_WIRE_BYTES_MAX];
      size_t size = vs_radio_link_last_stop(&s->link, (uint8_t)(SEQ_AHEAD + frame), bytes);
      ssize_t written = write(fd, bytes, size); // a full buffer is the watchdog's to end
      (void)written;
    }
    nanosleep(&(struct timespec){0, 1000L * LAST_FRAMES_US}, NULL);
  }
  errno = before;
}

// The handler is gone when it returns: an instruction that faults does so again, and a signal from outside was sent again.
static void on_crash(int number) {
  vs_sender_last_stop();
  raise(number);
}

void vs_sender_stop_at_crash(void) {
  static uint8_t stack[65536]; // the thread's own may be what ran out
  static const int numbers[] = {SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP};
  sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_crash;
  action.sa_flags = (int)(SA_ONSTACK | SA_RESETHAND);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) sigaction(numbers[i], &action, NULL);
}

static void read_telemetry(vs_sender *s, int64_t now_us) {
  uint8_t bytes[256];
  size_t n;
  while (s->serial && (n = vs_serial_read(s->serial, bytes, sizeof bytes, now_us)) > 0)
    vs_radio_link_receive(&s->link, bytes, n, now_us);
}

static void *repeat(void *sender) {
  vs_sender *s = sender;
  for (;;) {
    pthread_mutex_lock(&s->lock);
    bool stop = s->stop;
    int64_t now_us = vs_clock_monotonic_us();
    uint8_t bytes[VS_WIRE_BYTES_MAX];
    write_frame(s, bytes, vs_radio_link_due(&s->link, now_us, bytes), now_us);
    read_telemetry(s, now_us);
    int64_t next_us = s->link.next_us;
    pthread_mutex_unlock(&s->lock);
    if (stop) return NULL;
    vs_clock_sleep_until_us(next_us < now_us + LISTEN_US ? next_us : now_us + LISTEN_US);
  }
}

vs_status vs_sender_new(const vs_sender_def *def, vs_sender **out, vs_error *err) {
  *out = NULL;
  vs_sender *s = calloc(1, sizeof *s);
  if (!s) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status status = vs_radio_link_init(&s->link, def->id, err);
  if (status == VS_OK && def->wire) status = vs_radio_link_set_wire(&s->link, def->wire, err);
  if (status == VS_OK && def->key.set && s->link.wire)
    status = vs_fail(err, VS_USAGE, "radio.key: wire %s has no place for it; leave it empty, or wire = vsss",
                     def->wire->name);
  if (status == VS_OK && def->key.set) vs_radio_link_set_key(&s->link, &def->key, vs_clock_wall_us());
  if (status == VS_OK && def->device) status = vs_serial_open(def->device, def->baud, &s->serial, err);
  pthread_mutex_init(&s->lock, NULL);
  if (status == VS_OK && pthread_create(&s->thread, NULL, repeat, s))
    status = vs_fail(err, VS_FAIL, "no thread for the radio");
  if (status != VS_OK) {
    vs_serial_close(s->serial);
    pthread_mutex_destroy(&s->lock);
    free(s);
    return status;
  }
  remember(s);
  *out = s;
  return VS_OK;
}

void vs_sender_free(vs_sender *s) {
  if (!s) return;
  pthread_mutex_lock(&s->lock);
  s->stop = true;
  pthread_mutex_unlock(&s->lock);
  pthread_join(s->thread, NULL);
  for (int i = 0; i < VS_RADIO_STOP_FRAMES && s->serial; i++) {
    uint8_t bytes[VS_WIRE_BYTES_MAX];
    int64_t now_us = vs_clock_monotonic_us();
    write_frame(s, bytes, vs_radio_link_stop(&s->link, now_us, bytes), now_us);
    vs_clock_sleep_until_us(now_us + LAST_FRAMES_US);
  }
  if (s->serial) vs_serial_drain(s->serial, DRAIN_MS);
  forget(s);
  vs_serial_close(s->serial);
  pthread_mutex_destroy(&s->lock);
  free(s);
}

void vs_sender_command(vs_sender *s, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t capture_us, bool now) {
  pthread_mutex_lock(&s->lock);
  vs_radio_link_command(&s->link, wheels, stop, capture_us);
  if (now) {
    int64_t now_us = vs_clock_monotonic_us();
    uint8_t bytes[VS_WIRE_BYTES_MAX];
    s->link.next_us = now_us; // out of turn; the repeats count from here
    write_frame(s, bytes, vs_radio_link_due(&s->link, now_us, bytes), now_us);
  }
  pthread_mutex_unlock(&s->lock);
}

void vs_sender_state(vs_sender *s, vs_radio_link *link, vs_serial_stats *serial) {
  pthread_mutex_lock(&s->lock);
  *link = s->link;
  if (s->serial)
    *serial = vs_serial_get_stats(s->serial);
  else
    memset(serial, 0, sizeof *serial);
  pthread_mutex_unlock(&s->lock);
}
