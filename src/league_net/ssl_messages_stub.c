// In place of ssl_messages.c where protobuf-c is missing.
#include "vsss/league_messages.h"
#include "vsss/ssl_vision.h"

vs_status vs_ssl_decode(const uint8_t *data, size_t size, vs_ssl_frame *out, vs_error *err) {
  (void)data, (void)size, (void)out;
  return vs_league_supported(err);
}
