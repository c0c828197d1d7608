#include "vsss/wire.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/field.h"

static double rim_mps(double radps) { return VS_WHEEL_RADIUS_M * radps; }
static double forward_mps(vs_wheels w) { return 0.5 * (rim_mps(w.left_radps) + rim_mps(w.right_radps)); }
static double turning_radps(vs_wheels w) {
  return (rim_mps(w.right_radps) - rim_mps(w.left_radps)) / (2 * VS_HALF_TRACK_M);
}

typedef struct text {
  char *at;
  size_t left;
} text;

static void put_word(text *t, const char *word) {
  size_t length = strlen(word);
  if (length >= t->left) return;
  memcpy(t->at, word, length);
  t->at += length;
  t->left -= length;
}

static void put_number(text *t, long value) {
  char digits[24];
  snprintf(digits, sizeof digits, "%ld", value);
  put_word(t, digits);
}

// value with so many decimals, without the locale's comma.
static void put_decimal(text *t, double value, int decimals) {
  long scale = 1;
  for (int i = 0; i < decimals; i++) scale *= 10;
  long fixed = lround(value * (double)scale), rest = labs(fixed) % scale;
  if (fixed < 0) put_word(t, "-");
  put_number(t, labs(fixed) / scale);
  put_word(t, ".");
  for (long digit = scale / 10; digit > 0; digit /= 10) put_number(t, rest / digit % 10);
}

// EMC's robots: an XBee in API mode 1, one unicast each: frame type 0x01, no answer wanted (frame id 0), the robot's number as
// 16-bit address, acknowledgement off (option 1), then "RIGHT;LEFT" in m/s.
static size_t pequi(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE], uint8_t *out) {
  size_t size = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    char speeds[24];
    text t = {speeds, sizeof speeds};
    put_decimal(&t, rim_mps(wheels[i].right_radps), 2);
    put_word(&t, ";");
    put_decimal(&t, rim_mps(wheels[i].left_radps), 2);
    size_t length = (size_t)(t.at - speeds), payload = 5 + length;
    uint8_t *frame = out + size, sum = 0;
    const uint8_t head[] = {0x7E, (uint8_t)(payload >> 8), (uint8_t)payload, 0x01, 0x00, 0x00, id[i], 0x01};
    memcpy(frame, head, sizeof head);
    memcpy(frame + sizeof head, speeds, length);
    for (size_t k = 3; k < sizeof head + length; k++) sum = (uint8_t)(sum + frame[k]);
    frame[sizeof head + length] = (uint8_t)(0xFF - sum);
    size += sizeof head + length + 1;
  }
  return size;
}

enum { SYSMIC_SLOTS = 5 };

static size_t put_slots(const long slot[SYSMIC_SLOTS][2], uint8_t *out) {
  text t = {(char *)out, VS_WIRE_BYTES_MAX};
  for (int i = 0; i < SYSMIC_SLOTS; i++) {
    put_number(&t, slot[i][0]);
    put_word(&t, ",");
    put_number(&t, slot[i][1]);
    put_word(&t, i + 1 < SYSMIC_SLOTS ? "," : "\n");
  }
  return (size_t)(t.at - (char *)out);
}

// Left and right rim of five slots, mm/s.
static size_t sysmic(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE], uint8_t *out) {
  long slot[SYSMIC_SLOTS][2] = {{0}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    slot[id[i]][0] = lround(1000 * rim_mps(wheels[i].left_radps));
    slot[id[i]][1] = lround(1000 * rim_mps(wheels[i].right_radps));
  }
  return put_slots(slot, out);
}

// The same team's base since September 2026: forward in mm/s, turning in degrees/s, counter-clockwise.
static size_t sysmic_vw(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE], uint8_t *out) {
  long slot[SYSMIC_SLOTS][2] = {{0}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    slot[id[i]][0] = lround(1000 * forward_mps(wheels[i]));
    slot[id[i]][1] = lround(turning_radps(wheels[i]) * 180 / M_PI);
  }
  return put_slots(slot, out);
}

// <id,v,w,...>, by ascending id.
static size_t neon(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE], uint8_t *out) {
  text t = {(char *)out, VS_WIRE_BYTES_MAX};
  put_word(&t, "<");
  int last = -1;
  for (int k = 0; k < VS_TEAM_SIZE; k++) {
    int next = -1;
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      if (id[i] > last && (next < 0 || id[i] < id[next])) next = i;
    if (next < 0) break;
    last = id[next];
    if (k) put_word(&t, ",");
    put_number(&t, last);
    put_word(&t, ",");
    put_decimal(&t, forward_mps(wheels[next]), 4);
    put_word(&t, ",");
    put_decimal(&t, turning_radps(wheels[next]), 4);
  }
  put_word(&t, ">");
  return (size_t)(t.at - (char *)out);
}

// Towards zero, and 32767 becomes 0, as theirs does; by our limits it is never reached.
static int unball_number(double value, double full) { return (int)(value / full * 32767) % 32767; }

static uint8_t *put_i16(uint8_t *p, int value) {
  p[0] = (uint8_t)value;
  p[1] = (uint8_t)((unsigned)value >> 8);
  return p + 2;
}

// "BBB", forward of the three (2 m/s is full scale), turning of the three (64 rad/s), and their sum; int16, little-endian.
static size_t unball(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE], uint8_t *out) {
  int number[2][VS_TEAM_SIZE] = {{0}}, sum = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    number[0][id[i]] = unball_number(forward_mps(wheels[i]), 2);
    number[1][id[i]] = unball_number(turning_radps(wheels[i]), 64);
  }
  memcpy(out, "BBB", 3);
  uint8_t *p = out + 3;
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      p = put_i16(p, number[k][i]);
      sum += number[k][i];
    }
  p = put_i16(p, sum % 32767);
  return (size_t)(p - out);
}

static const vs_wire table[] = {
    {"vsss", "frames of radio_codec.h", NULL, 255, NULL},
    {"pequi-xbee", "XBee API frames, \"RIGHT;LEFT\" in m/s",
     "no telemetry, no order against delay or replay, no key; the robots brake 500 ms after the last frame, not 150",
     255, pequi},
    {"sysmic", "L1,R1,...,L5,R5 in mm/s",
     "no telemetry, no check against damaged bytes, no key; what the robots do in silence is their firmware's",
     SYSMIC_SLOTS - 1, sysmic},
    {"sysmic-vw", "V1,W1,...,V5,W5 in mm/s and degrees/s",
     "no telemetry, no check against damaged bytes, no key; what the robots do in silence is their firmware's",
     SYSMIC_SLOTS - 1, sysmic_vw},
    {"neon", "<id,v,w,...> in m/s and rad/s",
     "no telemetry, no check against damaged bytes, no key; the robots stop 500 ms after the last frame, not 150", 255,
     neon},
    {"unball", "BBB, six int16, a sum",
     "no telemetry, a sum that misses swapped bytes, no key; after 500 ms of silence the robots of 2024 drive by "
     "themselves: "
     "switch them off before ending the program",
     VS_TEAM_SIZE - 1, unball},
};

const vs_wire *vs_wire_vsss(void) { return &table[0]; }

const vs_wire *vs_wire_at(int index) {
  return index >= 0 && index < (int)(sizeof table / sizeof *table) ? &table[index] : NULL;
}

vs_status vs_wire_find(const char *name, const vs_wire **out, vs_error *err) {
  char known[160] = "";
  for (int i = 0; vs_wire_at(i); i++) {
    *out = vs_wire_at(i);
    if (!strcmp((*out)->name, name)) return VS_OK;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", (*out)->name);
  }
  *out = NULL;
  return vs_fail(err, VS_USAGE, "wire '%.40s': expected one of %s", name, known);
}
