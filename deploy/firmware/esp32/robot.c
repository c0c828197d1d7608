// A robot on an ESP32 (ESP-IDF 5): ESP-NOW in, the contract of firmware.h, speed control of two wheels every 5 ms, telemetry
// out. Pins and constants: config.h.
#include <math.h>

#include "driver/gpio.h"
#include "driver/ledc.h"
#include "driver/pulse_cnt.h"
#include "esp_adc/adc_oneshot.h"
#include "esp_timer.h"
#include "freertos/task.h"
#include "radio.h"
#include "vsss/firmware.h"

#define PERIOD_MS    5
#define TELEMETRY_MS 100
#define DUTY_BITS    LEDC_TIMER_10_BIT
#define DUTY_MAX     1023
#define COUNT_LIMIT  20000
#define RADPS        ((float)VS_RADIO_UNIT_RADPS)

typedef struct wheel {
  ledc_channel_t channel;
  int in1, in2;
  pcnt_unit_handle_t encoder;
  float speed_radps, integral;
} wheel;

static vs_firmware firmware;
static wheel left = {.channel = LEDC_CHANNEL_0, .in1 = PIN_IN1_LEFT, .in2 = PIN_IN2_LEFT};
static wheel right = {.channel = LEDC_CHANNEL_1, .in1 = PIN_IN1_RIGHT, .in2 = PIN_IN2_RIGHT};
static adc_oneshot_unit_handle_t battery;
static int8_t rssi_dbm;
static uint32_t telemetry_ms;

static uint32_t now_ms(void) { return (uint32_t)(esp_timer_get_time() / 1000); }

static void wheel_start(wheel *w, int pwm, int a, int b) {
  ledc_channel_config_t channel = {
      .gpio_num = pwm, .speed_mode = LEDC_LOW_SPEED_MODE, .channel = w->channel, .timer_sel = LEDC_TIMER_0, .duty = 0};
  pcnt_unit_config_t unit = {.low_limit = -COUNT_LIMIT, .high_limit = COUNT_LIMIT};
  pcnt_chan_config_t edges_a = {.edge_gpio_num = a, .level_gpio_num = b};
  pcnt_chan_config_t edges_b = {.edge_gpio_num = b, .level_gpio_num = a};
  pcnt_channel_handle_t of_a, of_b;
  ESP_ERROR_CHECK(ledc_channel_config(&channel));
  ESP_ERROR_CHECK(gpio_set_direction((gpio_num_t)w->in1, GPIO_MODE_OUTPUT));
  ESP_ERROR_CHECK(gpio_set_direction((gpio_num_t)w->in2, GPIO_MODE_OUTPUT));
  ESP_ERROR_CHECK(pcnt_new_unit(&unit, &w->encoder));
  ESP_ERROR_CHECK(pcnt_new_channel(w->encoder, &edges_a, &of_a));
  ESP_ERROR_CHECK(pcnt_new_channel(w->encoder, &edges_b, &of_b));
  ESP_ERROR_CHECK(
      pcnt_channel_set_edge_action(of_a, PCNT_CHANNEL_EDGE_ACTION_DECREASE, PCNT_CHANNEL_EDGE_ACTION_INCREASE));
  ESP_ERROR_CHECK(
      pcnt_channel_set_level_action(of_a, PCNT_CHANNEL_LEVEL_ACTION_KEEP, PCNT_CHANNEL_LEVEL_ACTION_INVERSE));
  ESP_ERROR_CHECK(
      pcnt_channel_set_edge_action(of_b, PCNT_CHANNEL_EDGE_ACTION_INCREASE, PCNT_CHANNEL_EDGE_ACTION_DECREASE));
  ESP_ERROR_CHECK(
      pcnt_channel_set_level_action(of_b, PCNT_CHANNEL_LEVEL_ACTION_KEEP, PCNT_CHANNEL_LEVEL_ACTION_INVERSE));
  ESP_ERROR_CHECK(pcnt_unit_enable(w->encoder));
  ESP_ERROR_CHECK(pcnt_unit_clear_count(w->encoder));
  ESP_ERROR_CHECK(pcnt_unit_start(w->encoder));
}

static void wheel_measure(wheel *w) {
  int count = 0;
  pcnt_unit_get_count(w->encoder, &count);
  pcnt_unit_clear_count(w->encoder);
  float speed = (float)count / COUNTS_PER_RAD / (1e-3f * PERIOD_MS);
  w->speed_radps += 0.5f * (speed - w->speed_radps); // one count is 0.9 rad/s
}

static void wheel_out(wheel *w, float duty, bool brake) {
  if (duty > 1) duty = 1;
  if (duty < -1) duty = -1;
  gpio_set_level((gpio_num_t)w->in1, brake || duty > 0);
  gpio_set_level((gpio_num_t)w->in2, brake || duty < 0);
  ledc_set_duty(LEDC_LOW_SPEED_MODE, w->channel, brake ? DUTY_MAX : (uint32_t)(fabsf(duty) * DUTY_MAX));
  ledc_update_duty(LEDC_LOW_SPEED_MODE, w->channel);
}

static void wheel_control(wheel *w, int16_t counts, bool brake) {
  float target = counts * RADPS, error = target - w->speed_radps;
  if (brake) {
    w->integral = 0;
    wheel_out(w, 0, true);
    return;
  }
  float duty = target / FULL_RADPS + GAIN_P * error + w->integral;
  if (fabsf(duty) < 1) w->integral += GAIN_I * error * 1e-3f * PERIOD_MS; // not while the battery is the limit
  wheel_out(w, duty, false);
}

// In a slot of the robot's own, so that three do not speak at once.
static void tell(uint32_t ms) {
  if ((int32_t)(ms - telemetry_ms) < 0) return;
  telemetry_ms += TELEMETRY_MS;
  if ((int32_t)(ms - telemetry_ms) > 0) telemetry_ms = ms + TELEMETRY_MS;
  int raw = 0;
  uint8_t frame[VS_RADIO_FRAME_MAX];
  adc_oneshot_read(battery, (adc_channel_t)BATTERY_ADC_CHANNEL, &raw);
  size_t size =
      vs_firmware_telemetry(&firmware, ms, vs_radio_counts(left.speed_radps), vs_radio_counts(right.speed_radps),
                            (uint16_t)(raw * BATTERY_MV_PER_STEP), rssi_dbm, frame);
  esp_now_send(everybody, frame, size);
}

static void control(void *unused) {
  (void)unused;
  TickType_t wake = xTaskGetTickCount();
  for (;;) {
    packet p;
    uint32_t ms = now_ms();
    while (xQueueReceive(packets, &p, 0) == pdTRUE) {
      rssi_dbm = p.rssi_dbm;
      vs_firmware_receive(&firmware, p.bytes, p.size, ms);
    }
    wheel_measure(&left);
    wheel_measure(&right);
    vs_firmware_drive drive = vs_firmware_tick(&firmware, ms);
    wheel_control(&left, drive.left, drive.brake);
    wheel_control(&right, drive.right, drive.brake);
    tell(ms);
    vTaskDelayUntil(&wake, pdMS_TO_TICKS(PERIOD_MS));
  }
}

void app_main(void) {
  vs_radio_key key;
  ledc_timer_config_t timer = {.speed_mode = LEDC_LOW_SPEED_MODE,
                               .duty_resolution = DUTY_BITS,
                               .timer_num = LEDC_TIMER_0,
                               .freq_hz = 20000,
                               .clk_cfg = LEDC_AUTO_CLK};
  adc_oneshot_unit_init_cfg_t adc = {.unit_id = ADC_UNIT_1};
  adc_oneshot_chan_cfg_t channel = {.atten = ADC_ATTEN_DB_12, .bitwidth = ADC_BITWIDTH_DEFAULT};
  vs_firmware_init(&firmware, ROBOT_ID, now_ms());
  if (vs_radio_key_parse(TEAM_ID, TEAM_KEY, &key)) vs_firmware_set_key(&firmware, &key);
  ESP_ERROR_CHECK(ledc_timer_config(&timer));
  wheel_start(&left, PIN_PWM_LEFT, PIN_A_LEFT, PIN_B_LEFT);
  wheel_start(&right, PIN_PWM_RIGHT, PIN_A_RIGHT, PIN_B_RIGHT);
  wheel_out(&left, 0, true);
  wheel_out(&right, 0, true);
  ESP_ERROR_CHECK(gpio_set_direction((gpio_num_t)PIN_STANDBY, GPIO_MODE_OUTPUT));
  gpio_set_level((gpio_num_t)PIN_STANDBY, 1);
  ESP_ERROR_CHECK(adc_oneshot_new_unit(&adc, &battery));
  ESP_ERROR_CHECK(adc_oneshot_config_channel(battery, (adc_channel_t)BATTERY_ADC_CHANNEL, &channel));
  radio_start();
  telemetry_ms = now_ms() + TELEMETRY_MS + (ROBOT_ID % 3) * (TELEMETRY_MS / 3);
  xTaskCreatePinnedToCore(control, "control", 4096, NULL, 20, NULL, 1); // Wi-Fi lives on core 0
}
