// Fuzzes src/comms/radio_codec.c: bytes of a serial line. What was taken for a frame must encode to the same again.
#include "fuzz.h"
#include "vsss/radio_codec.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_radio_decoder decoder = {0};
  vs_radio_frame frame;
  // With and without a key.
  if (size && data[0] & 1) vs_radio_key_parse(7, "000102030405060708090a0b0c0d0e0f", &decoder.key);
  for (size_t i = 0; i < size; i++) {
    if (!vs_radio_decode(&decoder, data[i], &frame)) continue;
    uint8_t again[VS_RADIO_FRAME_MAX];
    if (vs_radio_encode_keyed(&frame, &decoder.key, again) == 0) abort();
  }
  return 0;
}
