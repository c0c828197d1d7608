// deploy/firmware/esp32/base.c on a fake SDK: each frame of the serial line is one packet, noise is none, and what robots say
// comes back on the line.
#include <assert.h>

#include "fake_sdk.h"
#include "vsss/radio_codec.h"

fake_world fake;
void app_main(void);

static vs_radio_frame command(int seq) {
  vs_radio_frame f = {.type = VS_RADIO_COMMAND};
  f.as.command = (vs_radio_command){.seq = (uint8_t)seq, .n = 3, .robot = {{0, 1, 2}, {1, 3, 4}, {2, 5, 6}}};
  return f;
}

static void say(const uint8_t *bytes, size_t size) {
  memcpy(fake.line_in + fake.in_used, bytes, size);
  fake.in_used += size;
}

void fake_tick(void) {
  static int step;
  uint8_t bytes[VS_RADIO_FRAME_MAX], noise[200];
  vs_radio_frame f = command(step);
  size_t size = vs_radio_encode(&f, bytes);
  memset(noise, 0x55, sizeof noise);
  switch (step++) {
  case 0: say(bytes, 7); break; // a frame in two pieces
  case 1:
    f = command(0);
    size = vs_radio_encode(&f, bytes);
    say(bytes + 7, size - 7);
    break;
  case 2:
    assert(fake.packets_sent == 1 && fake.sent.size == 24);
    f = command(0);
    vs_radio_encode(&f, bytes);
    assert(!memcmp(fake.sent.bytes, bytes, 24));
    say(noise, sizeof noise);
    break;
  case 3: say(bytes, size); break;
  case 5: // noise was too long for a frame; the next one is whole
    assert(fake.packets_sent == 2 && !memcmp(fake.sent.bytes, bytes, 3));
    wifi_pkt_rx_ctrl_t control = {.rssi = -50};
    const esp_now_recv_info_t info = {.rx_ctrl = &control};
    fake.heard(&info, bytes, (int)size);
    break;
  case 7:
    assert(fake.out_used == size);
    printf("base: well\n");
    exit(0);
  default: break;
  }
}

int main(void) {
  app_main();
  fake.task(NULL);
  return 1;
}
