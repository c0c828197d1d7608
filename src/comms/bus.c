// The bus: one LCM instance. Holds handlers, encodes on the caller's stack.
#include "bus_internal.h"
#include "bus_near.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <lcm/lcm.h>

#include "vsss/clock.h"

#define SUBSCRIPTIONS_MAX 32

typedef struct subscription {
  struct vs_bus *bus;
  vs_channel channel;
  bool near; // handed only what this machine sent
  vs_bus_handler handler;
  vs_bus_raw_handler raw;
  void *user;
} subscription;

struct vs_bus {
  lcm_t *lcm;
  char url[512];
  subscription list[SUBSCRIPTIONS_MAX];
  int n_list, n_far; // n_far: of those that LCM itself hands messages to
  vs_near near;      // those that this machine sends, for the rest of the list
  int64_t refused;
  int handled; // in this call of vs_bus_handle
  vs_message message;
  uint8_t image[VS_BUS_IMAGE_MAX];
};

vs_status vs_bus_supported(vs_error *err) {
  (void)err;
  return VS_OK;
}

vs_status vs_bus_open(const char *url, vs_bus **out, vs_error *err) {
  *out = NULL;
  if (!url) url = vs_bus_default_url();
  vs_bus *bus = calloc(1, sizeof *bus);
  if (!bus) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = strlen(url) < sizeof bus->url ? vs_bus_url_check(url, err)
                                              : vs_fail(err, VS_USAGE, "LCM URL '%.60s...' is too long", url);
  if (s == VS_OK) {
    memcpy(bus->url, url, strlen(url) + 1);
    bus->lcm = lcm_create(url);
    if (!bus->lcm)
      s = strncmp(url, "udpm", 4) ? vs_fail(err, VS_FAIL, "%.200s: LCM cannot open it", url)
                                  : vs_bus_no_route(url, err);
  }
  if (s != VS_OK) {
    free(bus);
    return s;
  }
  *out = bus;
  return VS_OK;
}

void vs_bus_close(vs_bus *bus) {
  if (!bus) return;
  lcm_destroy(bus->lcm);
  vs_near_close(&bus->near);
  free(bus);
}

const char *vs_bus_url(const vs_bus *bus) { return bus->url; }
int64_t vs_bus_refused(const vs_bus *bus) { return bus->refused; }
int64_t vs_bus_far(const vs_bus *bus) { return bus->near.far; }

vs_status vs_bus_publish(vs_bus *bus, vs_message *message, vs_error *err) {
  if (!message->utime_us) message->utime_us = vs_clock_wall_us();
  uint8_t bytes[VS_MESSAGE_MAX_BYTES];
  size_t size = vs_message_encode(message, bytes, sizeof bytes);
  if (!size) return vs_fail(err, VS_FAIL, "%s: larger than one datagram", vs_channel_name(message->channel));
  return vs_bus_publish_raw(bus, vs_channel_name(message->channel), bytes, size, err);
}

vs_status vs_bus_publish_raw(vs_bus *bus, const char *channel, const uint8_t *data, size_t size, vs_error *err) {
  if (strlen(channel) > LCM_MAX_CHANNEL_NAME_LENGTH)
    return vs_fail(err, VS_FAIL, "channel '%.40s...': a name has at most %d characters", channel,
                   LCM_MAX_CHANNEL_NAME_LENGTH);
  if (lcm_publish(bus->lcm, channel, data, (unsigned)size) != 0)
    return vs_fail(err, VS_FAIL, "%s: not sent over %s", channel, bus->url);
  return VS_OK;
}

static void hand_on(const subscription *s, const uint8_t *data, size_t size) {
  vs_bus *bus = s->bus;
  if (vs_message_decode(s->channel, data, size, &bus->message, bus->image, NULL) != VS_OK) {
    bus->refused++;
    return;
  }
  bus->handled++;
  s->handler(&bus->message, s->user);
}

static void deliver(const lcm_recv_buf_t *buffer, const char *channel, void *user) {
  subscription *s = user;
  if (!s->raw) {
    hand_on(s, buffer->data, buffer->data_size);
    return;
  }
  s->raw(channel, buffer->data, buffer->data_size, buffer->recv_utime, s->user);
  s->bus->handled++;
}

static vs_status add(vs_bus *bus, const subscription *what, subscription **out, vs_error *err) {
  if (bus->n_list == SUBSCRIPTIONS_MAX) return vs_fail(err, VS_FAIL, "more than %d subscriptions", SUBSCRIPTIONS_MAX);
  *out = &bus->list[bus->n_list++];
  **out = *what;
  (*out)->bus = bus;
  return VS_OK;
}

static vs_status subscribe(vs_bus *bus, const char *pattern, const subscription *what, int waiting, vs_error *err) {
  subscription *s = NULL;
  vs_status status = add(bus, what, &s, err);
  if (status != VS_OK) return status;
  lcm_subscription_t *handle = lcm_subscribe(bus->lcm, pattern, deliver, s);
  if (!handle) {
    bus->n_list--;
    return vs_bus_no_route(bus->url, err);
  }
  if (waiting) lcm_subscription_set_queue_capacity(handle, waiting);
  bus->n_far++;
  return VS_OK;
}

vs_status vs_bus_subscribe_near(vs_bus *bus, vs_channel channel, vs_bus_handler handler, void *user, vs_error *err) {
  // The other kinds of bus do not leave this machine.
  if (strncmp(bus->url, "udpm://", 7) != 0) return vs_bus_subscribe(bus, channel, false, handler, user, err);
  subscription *s = NULL;
  vs_status status = bus->near.fd ? VS_OK : vs_near_open(&bus->near, bus->url, err);
  return status == VS_OK
             ? add(bus, &(subscription){.channel = channel, .near = true, .handler = handler, .user = user}, &s, err)
             : status;
}

vs_status vs_bus_subscribe(vs_bus *bus, vs_channel channel, bool newest_only, vs_bus_handler handler, void *user,
                           vs_error *err) {
  int first = channel == VS_CHANNELS ? 0 : (int)channel, last = channel == VS_CHANNELS ? VS_CHANNELS - 1 : (int)channel;
  for (int i = first; i <= last; i++) {
    subscription what = {.channel = (vs_channel)i, .handler = handler, .user = user};
    vs_status s = subscribe(bus, vs_channel_name((vs_channel)i), &what, newest_only ? 1 : 0, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

vs_status vs_bus_subscribe_raw(vs_bus *bus, const char *channel, vs_bus_raw_handler handler, void *user,
                               vs_error *err) {
  subscription what = {.raw = handler, .user = user};
  // A spy must not lose messages while it writes to a slow terminal.
  return subscribe(bus, channel ? channel : ".*", &what, 1000, err);
}

static void handle_near(vs_bus *bus) {
  const char *channel;
  const uint8_t *data;
  size_t size;
  while (vs_near_read(&bus->near, &channel, &data, &size))
    for (int i = 0; i < bus->n_list; i++)
      if (bus->list[i].near && !strcmp(vs_channel_name(bus->list[i].channel), channel))
        hand_on(&bus->list[i], data, size);
}

vs_status vs_bus_handle(vs_bus *bus, int timeout_ms, int *handled, vs_error *err) {
  bus->handled = 0;
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * timeout_ms;
  // LCM begins to receive when its descriptor is asked for.
  bool far = bus->n_far || !bus->near.fd;
  struct pollfd wait[2] = {{.fd = far ? lcm_get_fileno(bus->lcm) : -1, .events = POLLIN},
                           {.fd = bus->near.fd ? bus->near.fd : -1, .events = POLLIN}};
  for (int left_ms = timeout_ms;;) {
    int ready = poll(wait, 2, left_ms);
    if (ready < 0 && errno != EINTR) return vs_fail(err, VS_FAIL, "%s: %s", bus->url, strerror(errno));
    if (ready <= 0) break;
    if (wait[0].revents && lcm_handle(bus->lcm) != 0) return vs_fail(err, VS_FAIL, "%s: LCM cannot read", bus->url);
    if (wait[1].revents) handle_near(bus);
    // What waited already is taken too, but not for longer than the time given.
    left_ms = 0;
    if (vs_clock_monotonic_us() > until_us && bus->handled) break;
  }
  if (handled) *handled = bus->handled;
  return VS_OK;
}
