// Fuzzes src/comms/bus_decode.c, src/cli/message_text.c and src/cli/message_json.c: the first byte chooses the channel,
// the others are a message of LCM.
#include "cli/message_text.h"
#include "fuzz.h"
#include "vsss/bus.h"

static vs_message message;

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  static uint8_t bytes[1 + VS_MESSAGE_MAX_BYTES];
  for (int channel = 0; channel < VS_CHANNELS; channel++) {
    char name[32];
    memset(&message, 0, sizeof message);
    message.channel = (vs_channel)channel;
    bytes[0] = (uint8_t)channel;
    if (channel == VS_CH_IMAGE) message.as.image.data = bytes;
    size_t size = vs_message_encode(&message, bytes + 1, sizeof bytes - 1);
    snprintf(name, sizeof name, "channel%d", channel);
    if (size) fuzz_seed(name, bytes, size + 1);
  }
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static uint8_t image[VS_BUS_IMAGE_MAX];
  static char text[VS_MESSAGE_JSON_MAX];
  vs_error err = {0};
  if (size < 1 || vs_message_decode((vs_channel)(data[0] % VS_CHANNELS), data + 1, size - 1, &message, image, &err))
    return 0;
  vs_message_text(&message, text, sizeof text);
  vs_text_clean(text);
  if (strchr(text, '\033')) abort();
  vs_message_json(&message, 0.0, text, sizeof text);
  vs_message_text(&message, text, 40);
  vs_message_json(&message, 0.0, text, 40);
  return 0;
}
