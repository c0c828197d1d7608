// Built in place of bus.c, bus_encode.c and bus_decode.c where LCM is not installed.
#include "bus_internal.h"
#include "vsss/tick.h"

vs_status vs_bus_supported(vs_error *err) {
  return vs_fail(err, VS_FAIL, "this build has no LCM: install liblcm-dev and liblcm-bin and run make again");
}

vs_status vs_bus_open(const char *url, vs_bus **out, vs_error *err) {
  *out = NULL;
  vs_status s = vs_bus_url_check(url ? url : vs_bus_default_url(), err);
  return s == VS_USAGE ? s : vs_bus_supported(err);
}

void vs_bus_close(vs_bus *bus) { (void)bus; }

const char *vs_bus_url(const vs_bus *bus) {
  (void)bus;
  return "";
}

vs_status vs_bus_publish(vs_bus *bus, vs_message *message, vs_error *err) {
  (void)bus, (void)message;
  return vs_bus_supported(err);
}

vs_status vs_bus_subscribe(vs_bus *bus, vs_channel channel, bool newest_only, vs_bus_handler handler, void *user,
                           vs_error *err) {
  (void)bus, (void)channel, (void)newest_only, (void)handler, (void)user;
  return vs_bus_supported(err);
}

vs_status vs_bus_subscribe_near(vs_bus *bus, vs_channel channel, vs_bus_handler handler, void *user, vs_error *err) {
  return vs_bus_subscribe(bus, channel, false, handler, user, err);
}

int64_t vs_bus_far(const vs_bus *bus) {
  (void)bus;
  return 0;
}

vs_status vs_bus_handle(vs_bus *bus, int timeout_ms, int *handled, vs_error *err) {
  (void)bus, (void)timeout_ms;
  if (handled) *handled = 0;
  return vs_bus_supported(err);
}

int64_t vs_bus_refused(const vs_bus *bus) {
  (void)bus;
  return 0;
}

vs_status vs_bus_subscribe_raw(vs_bus *bus, const char *channel, vs_bus_raw_handler handler, void *user,
                               vs_error *err) {
  (void)bus, (void)channel, (void)handler, (void)user;
  return vs_bus_supported(err);
}

vs_status vs_bus_publish_raw(vs_bus *bus, const char *channel, const uint8_t *data, size_t size, vs_error *err) {
  (void)bus, (void)channel, (void)data, (void)size;
  return vs_bus_supported(err);
}

size_t vs_message_encode(const vs_message *message, uint8_t *out, size_t out_size) {
  (void)message, (void)out, (void)out_size;
  return 0;
}

vs_status vs_message_decode(vs_channel channel, const uint8_t *data, size_t size, vs_message *out,
                            uint8_t *image_buffer, vs_error *err) {
  (void)channel, (void)data, (void)size, (void)out, (void)image_buffer;
  return vs_bus_supported(err);
}

size_t vs_tick_encode(const vs_tick *tick, int64_t utime_us, int64_t utime_capture_us, uint8_t *out, size_t size) {
  (void)tick, (void)utime_us, (void)utime_capture_us, (void)out, (void)size;
  return 0;
}

vs_status vs_tick_decode(const uint8_t *data, size_t size, vs_tick *out, vs_error *err) {
  (void)data, (void)size, (void)out;
  return vs_bus_supported(err);
}
