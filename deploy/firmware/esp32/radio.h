// ESP-NOW, broadcast on one channel: what robot and base share.
#ifndef VSSS_ESP32_RADIO_H
#define VSSS_ESP32_RADIO_H

#include <stdint.h>
#include <string.h>

#include "config.h"
#include "esp_event.h"
#include "esp_netif.h"
#include "esp_now.h"
#include "esp_wifi.h"
#include "freertos/FreeRTOS.h"
#include "freertos/queue.h"
#include "nvs_flash.h"

_Static_assert(configTICK_RATE_HZ == 1000, "set CONFIG_FREERTOS_HZ=1000: the speed control runs every 5 ms");

#define PACKET_MAX 64 // a frame of radio_codec.h with both delimiters is shorter

typedef struct packet {
  uint8_t size;
  int8_t rssi_dbm;
  uint8_t bytes[PACKET_MAX];
} packet;

static QueueHandle_t packets; // heard, not yet read
static const uint8_t everybody[6] = {255, 255, 255, 255, 255, 255};

// Runs in the Wi-Fi task: copies and leaves. A full queue loses the newest; the next one comes in 20 ms.
static void on_packet(const esp_now_recv_info_t *info, const uint8_t *data, int size) {
  packet p;
  if (size < 1 || size > PACKET_MAX) return;
  p.size = (uint8_t)size;
  p.rssi_dbm = (int8_t)info->rx_ctrl->rssi;
  memcpy(p.bytes, data, (size_t)size);
  xQueueSend(packets, &p, 0);
}

static void radio_start(void) {
  wifi_init_config_t wifi = WIFI_INIT_CONFIG_DEFAULT();
  esp_now_peer_info_t peer = {.channel = WIFI_CHANNEL, .ifidx = WIFI_IF_STA};
  packets = xQueueCreate(16, sizeof(packet));
  ESP_ERROR_CHECK(nvs_flash_init());
  ESP_ERROR_CHECK(esp_netif_init());
  ESP_ERROR_CHECK(esp_event_loop_create_default());
  ESP_ERROR_CHECK(esp_wifi_init(&wifi));
  ESP_ERROR_CHECK(esp_wifi_set_storage(WIFI_STORAGE_RAM));
  ESP_ERROR_CHECK(esp_wifi_set_mode(WIFI_MODE_STA));
  ESP_ERROR_CHECK(esp_wifi_start());
  ESP_ERROR_CHECK(esp_wifi_set_ps(WIFI_PS_NONE)); // asleep it would hear one packet in three
  ESP_ERROR_CHECK(esp_wifi_set_channel(WIFI_CHANNEL, WIFI_SECOND_CHAN_NONE));
  ESP_ERROR_CHECK(esp_now_init());
  ESP_ERROR_CHECK(esp_now_register_recv_cb(on_packet));
  memcpy(peer.peer_addr, everybody, sizeof everybody);
  ESP_ERROR_CHECK(esp_now_add_peer(&peer));
}

#endif
