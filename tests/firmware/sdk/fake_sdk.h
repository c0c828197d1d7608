// As much of ESP-IDF 5 as deploy/firmware/esp32 uses: its names and shapes, and behind them one world that a test owns.
#ifndef VSSS_TESTS_FAKE_SDK_H
#define VSSS_TESTS_FAKE_SDK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef int esp_err_t;
#define ESP_OK 0
#define ESP_ERROR_CHECK(call)                                                                                          \
  do {                                                                                                                 \
    if ((call) != ESP_OK) abort();                                                                                     \
  } while (0)

// ---- the world of the test
typedef struct fake_packet {
  size_t size;
  uint8_t bytes[256];
} fake_packet;
typedef struct fake_world {
  int64_t now_us;
  int level[64];        // of pins
  uint32_t duty[2];     // of channels, set and updated
  double count[2];      // of encoders
  void (*task)(void *); // the one that was started
  void (*heard)(const void *info, const uint8_t *data, int size);
  fake_packet queue[16];
  int queued;
  size_t item;
  fake_packet sent; // the last
  int packets_sent;
  uint8_t line_in[512], line_out[512]; // the base's serial line
  size_t in_used, out_used;
} fake_world;
extern fake_world fake;
void fake_tick(void); // the task sleeps: time goes on, or the test ends

// ---- esp_timer, nvs, netif, event
static inline int64_t esp_timer_get_time(void) { return fake.now_us; }
static inline esp_err_t nvs_flash_init(void) { return ESP_OK; }
static inline esp_err_t esp_netif_init(void) { return ESP_OK; }
static inline esp_err_t esp_event_loop_create_default(void) { return ESP_OK; }

// ---- esp_wifi, esp_now
typedef struct wifi_init_config_t {
  int unused;
} wifi_init_config_t;
#define WIFI_INIT_CONFIG_DEFAULT()                                                                                     \
  { 0 }
typedef enum { WIFI_STORAGE_RAM } wifi_storage_t;
typedef enum { WIFI_MODE_STA } wifi_mode_t;
typedef enum { WIFI_PS_NONE } wifi_ps_type_t;
typedef enum { WIFI_SECOND_CHAN_NONE } wifi_second_chan_t;
typedef enum { WIFI_IF_STA } wifi_interface_t;
typedef struct wifi_pkt_rx_ctrl_t {
  signed rssi : 8;
} wifi_pkt_rx_ctrl_t;
typedef struct esp_now_recv_info {
  uint8_t *src_addr, *des_addr;
  wifi_pkt_rx_ctrl_t *rx_ctrl;
} esp_now_recv_info_t;
typedef struct esp_now_peer_info {
  uint8_t peer_addr[6], lmk[16], channel;
  wifi_interface_t ifidx;
  bool encrypt;
} esp_now_peer_info_t;
typedef void (*esp_now_recv_cb_t)(const esp_now_recv_info_t *info, const uint8_t *data, int size);
static inline esp_err_t esp_wifi_init(const wifi_init_config_t *c) { return c ? ESP_OK : 1; }
static inline esp_err_t esp_wifi_set_storage(wifi_storage_t s) { return (int)s; }
static inline esp_err_t esp_wifi_set_mode(wifi_mode_t m) { return (int)m; }
static inline esp_err_t esp_wifi_start(void) { return ESP_OK; }
static inline esp_err_t esp_wifi_set_ps(wifi_ps_type_t p) { return (int)p; }
static inline esp_err_t esp_wifi_set_channel(uint8_t c, wifi_second_chan_t s) { return c ? (int)s : 1; }
static inline esp_err_t esp_now_init(void) { return ESP_OK; }
static inline esp_err_t esp_now_register_recv_cb(esp_now_recv_cb_t call) {
  fake.heard = (void (*)(const void *, const uint8_t *, int))call;
  return ESP_OK;
}
static inline esp_err_t esp_now_add_peer(const esp_now_peer_info_t *p) { return p->peer_addr[0] == 255 ? ESP_OK : 1; }
static inline esp_err_t esp_now_send(const uint8_t *to, const uint8_t *data, size_t size) {
  if (to[0] != 255 || size > 250) abort();
  fake.sent.size = size;
  memcpy(fake.sent.bytes, data, size);
  fake.packets_sent++;
  return ESP_OK;
}

// ---- FreeRTOS
#define configTICK_RATE_HZ 1000
typedef uint32_t TickType_t;
typedef int BaseType_t;
typedef void *QueueHandle_t;
typedef void *TaskHandle_t;
#define pdTRUE            1
#define pdMS_TO_TICKS(ms) ((TickType_t)(ms))
static inline QueueHandle_t xQueueCreate(unsigned length, unsigned item) {
  if (length > 16 || item > sizeof fake.queue[0].bytes) abort();
  fake.item = item;
  return fake.queue;
}
static inline BaseType_t xQueueSend(QueueHandle_t q, const void *item, TickType_t wait) {
  if (q != fake.queue || wait != 0 || fake.queued == 16) return 0;
  memcpy(fake.queue[fake.queued++].bytes, item, fake.item);
  return pdTRUE;
}
static inline BaseType_t xQueueReceive(QueueHandle_t q, void *item, TickType_t wait) {
  if (q != fake.queue || wait != 0 || fake.queued == 0) return 0;
  memcpy(item, fake.queue[0].bytes, fake.item);
  memmove(&fake.queue[0], &fake.queue[1], sizeof fake.queue[0] * (size_t)--fake.queued);
  return pdTRUE;
}
static inline TickType_t xTaskGetTickCount(void) { return (TickType_t)(fake.now_us / 1000); }
static inline void vTaskDelayUntil(TickType_t *wake, TickType_t ticks) {
  *wake += ticks;
  fake_tick();
}
static inline BaseType_t xTaskCreatePinnedToCore(void (*task)(void *), const char *name, uint32_t stack, void *arg,
                                                 unsigned priority, TaskHandle_t *out, int core) {
  (void)name, (void)stack, (void)arg, (void)priority, (void)out, (void)core;
  fake.task = task;
  return pdTRUE;
}

// ---- drivers
typedef int gpio_num_t;
typedef enum { GPIO_MODE_OUTPUT } gpio_mode_t;
static inline esp_err_t gpio_set_direction(gpio_num_t pin, gpio_mode_t mode) { return pin < 34 ? (int)mode : 1; }
static inline esp_err_t gpio_set_level(gpio_num_t pin, uint32_t level) {
  fake.level[pin] = (int)level;
  return ESP_OK;
}

typedef enum { LEDC_LOW_SPEED_MODE } ledc_mode_t;
typedef enum { LEDC_CHANNEL_0, LEDC_CHANNEL_1 } ledc_channel_t;
typedef enum { LEDC_TIMER_0 } ledc_timer_t;
typedef enum { LEDC_TIMER_10_BIT = 10 } ledc_timer_bit_t;
typedef enum { LEDC_AUTO_CLK } ledc_clk_cfg_t;
typedef struct ledc_channel_config_t {
  int gpio_num;
  ledc_mode_t speed_mode;
  ledc_channel_t channel;
  ledc_timer_t timer_sel;
  uint32_t duty;
} ledc_channel_config_t;
typedef struct ledc_timer_config_t {
  ledc_mode_t speed_mode;
  ledc_timer_bit_t duty_resolution;
  ledc_timer_t timer_num;
  uint32_t freq_hz;
  ledc_clk_cfg_t clk_cfg;
} ledc_timer_config_t;
static inline esp_err_t ledc_channel_config(const ledc_channel_config_t *c) { return c->gpio_num < 34 ? ESP_OK : 1; }
// 80 MHz over 2^bits is the highest frequency.
static inline esp_err_t ledc_timer_config(const ledc_timer_config_t *c) {
  return c->freq_hz <= 80000000u >> c->duty_resolution ? ESP_OK : 1;
}
static inline esp_err_t ledc_set_duty(ledc_mode_t mode, ledc_channel_t channel, uint32_t duty) {
  if (duty > 1023) abort();
  fake.duty[channel] = duty;
  return (int)mode;
}
static inline esp_err_t ledc_update_duty(ledc_mode_t mode, ledc_channel_t channel) {
  return (int)mode + 0 * (int)channel;
}

typedef double *pcnt_unit_handle_t;
typedef int pcnt_channel_handle_t;
typedef struct pcnt_unit_config_t {
  int low_limit, high_limit;
} pcnt_unit_config_t;
typedef struct pcnt_chan_config_t {
  int edge_gpio_num, level_gpio_num;
} pcnt_chan_config_t;
typedef enum { PCNT_CHANNEL_EDGE_ACTION_DECREASE, PCNT_CHANNEL_EDGE_ACTION_INCREASE } pcnt_channel_edge_action_t;
typedef enum { PCNT_CHANNEL_LEVEL_ACTION_KEEP, PCNT_CHANNEL_LEVEL_ACTION_INVERSE } pcnt_channel_level_action_t;
static inline esp_err_t pcnt_new_unit(const pcnt_unit_config_t *c, pcnt_unit_handle_t *out) {
  static int made;
  *out = &fake.count[made++ % 2];
  return c->low_limit < 0 && c->high_limit > 0 && c->high_limit < 32768 ? ESP_OK : 1;
}
static inline esp_err_t pcnt_new_channel(pcnt_unit_handle_t u, const pcnt_chan_config_t *c,
                                         pcnt_channel_handle_t *out) {
  *out = 0;
  return u && c->edge_gpio_num != c->level_gpio_num ? ESP_OK : 1;
}
static inline esp_err_t pcnt_channel_set_edge_action(pcnt_channel_handle_t c, pcnt_channel_edge_action_t up,
                                                     pcnt_channel_edge_action_t down) {
  return up != down ? c : 1;
}
static inline esp_err_t pcnt_channel_set_level_action(pcnt_channel_handle_t c, pcnt_channel_level_action_t high,
                                                      pcnt_channel_level_action_t low) {
  return high != low ? c : 1;
}
static inline esp_err_t pcnt_unit_enable(pcnt_unit_handle_t u) { return u ? ESP_OK : 1; }
static inline esp_err_t pcnt_unit_start(pcnt_unit_handle_t u) { return u ? ESP_OK : 1; }
static inline esp_err_t pcnt_unit_clear_count(pcnt_unit_handle_t u) {
  *u -= (int)*u; // the part of a count stays
  return ESP_OK;
}
static inline esp_err_t pcnt_unit_get_count(pcnt_unit_handle_t u, int *out) {
  *out = (int)*u;
  return ESP_OK;
}

typedef int adc_oneshot_unit_handle_t;
typedef int adc_channel_t;
typedef enum { ADC_UNIT_1 } adc_unit_t;
typedef enum { ADC_ATTEN_DB_12 } adc_atten_t;
typedef enum { ADC_BITWIDTH_DEFAULT } adc_bitwidth_t;
typedef struct adc_oneshot_unit_init_cfg_t {
  adc_unit_t unit_id;
} adc_oneshot_unit_init_cfg_t;
typedef struct adc_oneshot_chan_cfg_t {
  adc_atten_t atten;
  adc_bitwidth_t bitwidth;
} adc_oneshot_chan_cfg_t;
static inline esp_err_t adc_oneshot_new_unit(const adc_oneshot_unit_init_cfg_t *c, adc_oneshot_unit_handle_t *out) {
  *out = 0;
  return (int)c->unit_id;
}
static inline esp_err_t adc_oneshot_config_channel(adc_oneshot_unit_handle_t u, adc_channel_t c,
                                                   const adc_oneshot_chan_cfg_t *config) {
  return u + 0 * c + (int)config->atten;
}
static inline esp_err_t adc_oneshot_read(adc_oneshot_unit_handle_t u, adc_channel_t c, int *out) {
  *out = 3346; // 7.6 V
  return u + 0 * c;
}

typedef int uart_port_t;
#define UART_NUM_0 0
typedef struct uart_config_t {
  int baud_rate, data_bits, parity, stop_bits, flow_ctrl;
} uart_config_t;
enum { UART_DATA_8_BITS = 3, UART_PARITY_DISABLE = 0, UART_STOP_BITS_1 = 1, UART_HW_FLOWCTRL_DISABLE = 0 };
static inline esp_err_t uart_driver_install(uart_port_t p, int rx, int tx, int n, void *q, int flags) {
  return p == UART_NUM_0 && rx > 128 && tx >= 0 && !n && !q && !flags ? ESP_OK : 1;
}
static inline esp_err_t uart_param_config(uart_port_t p, const uart_config_t *c) { return c->baud_rate > 0 ? p : 1; }
static inline int uart_read_bytes(uart_port_t p, void *out, uint32_t size, TickType_t wait) {
  (void)p, (void)wait;
  fake_tick();
  size_t n = fake.in_used < size ? fake.in_used : size;
  memcpy(out, fake.line_in, n);
  memmove(fake.line_in, fake.line_in + n, fake.in_used -= n);
  return (int)n;
}
static inline int uart_write_bytes(uart_port_t p, const void *bytes, size_t size) {
  if (p != UART_NUM_0 || fake.out_used + size > sizeof fake.line_out) abort();
  memcpy(fake.line_out + fake.out_used, bytes, size);
  fake.out_used += size;
  return (int)size;
}

#endif
