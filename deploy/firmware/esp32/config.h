// What one robot, or the base, is. ESP-NOW carries the frames of radio_codec.h as they are, one in each packet.
#ifndef VSSS_ESP32_CONFIG_H
#define VSSS_ESP32_CONFIG_H

#define ROBOT_ID     0  // radio.robotN_id of deploy/config/field.ini
#define TEAM_ID      0  // radio.team_id
#define TEAM_KEY     "" // radio.key, 32 hexadecimal digits; "": no key, anybody on the channel is obeyed
#define WIFI_CHANNEL 1  // 1, 6 or 11: ask the other team which one it takes

// Motor driver TB6612FNG, PWM 20 kHz. IN1 and IN2 both high: short brake.
#define PIN_PWM_LEFT  25
#define PIN_IN1_LEFT  26
#define PIN_IN2_LEFT  27
#define PIN_PWM_RIGHT 32
#define PIN_IN1_RIGHT 33
#define PIN_IN2_RIGHT 14
#define PIN_STANDBY   13
// Quadrature encoders. 34 and 35 are inputs only and have no pull-up: the encoder must drive them.
#define PIN_A_LEFT  34
#define PIN_B_LEFT  35
#define PIN_A_RIGHT 18
#define PIN_B_RIGHT 19
// Battery over 20 kOhm to 10 kOhm: 8.4 V is 2.8 V here.
#define BATTERY_ADC_CHANNEL 0 // ADC1, GPIO 36
#define BATTERY_MV_PER_STEP (3 * 3100.0 / 4095)

// 12 lines, 4 edges, gear 30:1, counted at the motor: 1440 a turn of the wheel.
#define COUNTS_PER_RAD (1440 / 6.2831853f)
#define FULL_RADPS     50.0f // of a wheel at full duty; feed-forward
#define GAIN_P         0.02f // duty per rad/s
#define GAIN_I         0.25f // duty per rad

// The base's serial line to the PC: UART0, over the board's USB chip.
#define BASE_BAUD 115200

#endif
