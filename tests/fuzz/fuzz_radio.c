// Fuzzes src/comms/radio_codec.c: bytes of a serial line. What was taken for a frame must encode to the same again.
#include "fuzz.h"
#include "vsss/radio_codec.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_radio_decoder decoder = {0};
  vs_radio_frame frame;
  for (size_t i = 0; i < size; i++) {
    if (!vs_radio_decode(&decoder, data[i], &frame)) continue;
    uint8_t again[VS_RADIO_FRAME_MAX];
    if (vs_radio_encode(&frame, again) == 0) abort();
  }
  return 0;
}
