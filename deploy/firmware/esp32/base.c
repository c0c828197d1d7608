// The base beside the PC on an ESP32 (ESP-IDF 5): frames from the serial line go out over ESP-NOW as they are, and what robots
// say goes back. It knows no key: check and order are between the PC and the robots.
#include "driver/uart.h"
#include "freertos/task.h"
#include "radio.h"

#define PORT UART_NUM_0

static uint8_t frame[PACKET_MAX];
static size_t used;

// Bytes between two 0x00, with both: one packet. Longer runs are noise.
static void forward(uint8_t byte) {
  static uint8_t out[PACKET_MAX];
  if (byte != 0) {
    if (used < PACKET_MAX - 1) frame[used] = byte;
    used++;
    return;
  }
  if (used > 0 && used <= PACKET_MAX - 2) {
    out[0] = 0;
    memcpy(out + 1, frame, used);
    out[used + 1] = 0;
    esp_now_send(everybody, out, used + 2);
  }
  used = 0;
}

static void run(void *unused) {
  (void)unused;
  for (;;) {
    uint8_t bytes[128];
    packet p;
    int n = uart_read_bytes(PORT, bytes, sizeof bytes, pdMS_TO_TICKS(1));
    for (int i = 0; i < n; i++) forward(bytes[i]);
    while (xQueueReceive(packets, &p, 0) == pdTRUE) uart_write_bytes(PORT, p.bytes, p.size);
  }
}

void app_main(void) {
  uart_config_t line = {.baud_rate = BASE_BAUD,
                        .data_bits = UART_DATA_8_BITS,
                        .parity = UART_PARITY_DISABLE,
                        .stop_bits = UART_STOP_BITS_1,
                        .flow_ctrl = UART_HW_FLOWCTRL_DISABLE};
  ESP_ERROR_CHECK(uart_driver_install(PORT, 1024, 1024, 0, NULL, 0));
  ESP_ERROR_CHECK(uart_param_config(PORT, &line));
  radio_start();
  xTaskCreatePinnedToCore(run, "base", 4096, NULL, 20, NULL, 1);
}
