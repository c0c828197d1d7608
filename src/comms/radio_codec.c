// Protocol v1 between PC and robots. Freestanding: also part of a robot's firmware.
#include "vsss/radio_codec.h"

#define COMMAND_BYTES(n) (4u + 5u * (n))
#define TELEMETRY_BYTES  18u

uint16_t vs_radio_crc(const uint8_t *bytes, size_t size) {
  uint16_t crc = 0xFFFF;
  for (size_t i = 0; i < size; i++) {
    crc = (uint16_t)(crc ^ (bytes[i] << 8));
    for (int bit = 0; bit < 8; bit++) crc = (uint16_t)(crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1);
  }
  return crc;
}

int16_t vs_radio_counts(double radps) {
  double counts = radps / VS_RADIO_UNIT_RADPS;
  if (!(counts == counts)) return 0; // NaN
  if (counts >= 32767.0) return 32767;
  if (counts <= -32767.0) return -32767;
  return (int16_t)(counts >= 0.0 ? counts + 0.5 : counts - 0.5);
}

double vs_radio_radps(int16_t counts) { return counts * VS_RADIO_UNIT_RADPS; }

bool vs_radio_seq_newer(uint8_t seq, uint8_t last) {
  uint8_t ahead = (uint8_t)(seq - last);
  return ahead != 0 && ahead < 128;
}

static uint8_t *put_u16(uint8_t *p, uint16_t value) {
  p[0] = (uint8_t)value;
  p[1] = (uint8_t)(value >> 8);
  return p + 2;
}

static uint16_t get_u16(const uint8_t *p) { return (uint16_t)(p[0] | p[1] << 8); }
static int16_t get_i16(const uint8_t *p) { return (int16_t)get_u16(p); }

static size_t pack_command(const vs_radio_command *c, uint8_t *out) {
  out[0] = VS_RADIO_VERSION << 4 | VS_RADIO_COMMAND;
  out[1] = c->seq;
  out[2] = c->flags;
  out[3] = c->n;
  uint8_t *p = out + 4;
  for (int i = 0; i < c->n; i++) {
    *p++ = c->robot[i].id;
    p = put_u16(p, (uint16_t)c->robot[i].left);
    p = put_u16(p, (uint16_t)c->robot[i].right);
  }
  return (size_t)(p - out);
}

static size_t pack_telemetry(const vs_radio_telemetry *t, uint8_t *out) {
  out[0] = VS_RADIO_VERSION << 4 | VS_RADIO_TELEMETRY;
  out[1] = t->id;
  out[2] = t->seq_echo;
  uint8_t *p = put_u16(out + 3, (uint16_t)t->left);
  p = put_u16(p, (uint16_t)t->right);
  p = put_u16(p, t->battery_mv);
  *p++ = (uint8_t)t->rssi_dbm;
  p = put_u16(p, t->rx_ok);
  p = put_u16(p, t->rx_bad);
  p = put_u16(p, (uint16_t)t->uptime_ms);
  p = put_u16(p, (uint16_t)(t->uptime_ms >> 16));
  return (size_t)(p - out);
}

static bool unpack_command(const uint8_t *in, size_t size, vs_radio_command *c) {
  if (size < COMMAND_BYTES(0) || in[3] > VS_RADIO_ROBOTS_MAX || size != COMMAND_BYTES(in[3])) return false;
  c->seq = in[1];
  c->flags = in[2];
  c->n = in[3];
  for (int i = 0; i < c->n; i++) {
    const uint8_t *p = in + COMMAND_BYTES(i);
    c->robot[i] = (vs_radio_robot){.id = p[0], .left = get_i16(p + 1), .right = get_i16(p + 3)};
  }
  return true;
}

static bool unpack_telemetry(const uint8_t *in, size_t size, vs_radio_telemetry *t) {
  if (size != TELEMETRY_BYTES) return false;
  t->id = in[1];
  t->seq_echo = in[2];
  t->left = get_i16(in + 3);
  t->right = get_i16(in + 5);
  t->battery_mv = get_u16(in + 7);
  t->rssi_dbm = (int8_t)in[9];
  t->rx_ok = get_u16(in + 10);
  t->rx_bad = get_u16(in + 12);
  t->uptime_ms = get_u16(in + 14) | (uint32_t)get_u16(in + 16) << 16;
  return true;
}

// Consistent overhead byte stuffing of at most 253 bytes: a code byte tells how far away the next zero is.
static size_t cobs_encode(const uint8_t *in, size_t size, uint8_t *out) {
  size_t code_at = 0, used = 1;
  for (size_t i = 0; i < size; i++) {
    if (in[i] == 0) {
      out[code_at] = (uint8_t)(used - code_at);
      code_at = used++;
    } else {
      out[used++] = in[i];
    }
  }
  out[code_at] = (uint8_t)(used - code_at);
  return used;
}

// In place; returns the size, 0 for what no encoder makes.
static size_t cobs_decode(uint8_t *bytes, size_t size) {
  size_t read = 0, written = 0;
  while (read < size) {
    size_t end = read + bytes[read];
    if (end > size) return 0;
    for (read++; read < end; read++) bytes[written++] = bytes[read];
    if (read < size) bytes[written++] = 0;
  }
  return written;
}

size_t vs_radio_encode(const vs_radio_frame *frame, uint8_t out[VS_RADIO_FRAME_MAX]) {
  uint8_t payload[VS_RADIO_PAYLOAD_MAX + 2];
  size_t size;
  if (frame->type == VS_RADIO_COMMAND) {
    if (frame->as.command.n > VS_RADIO_ROBOTS_MAX) return 0;
    size = pack_command(&frame->as.command, payload);
  } else {
    size = pack_telemetry(&frame->as.telemetry, payload);
  }
  put_u16(payload + size, vs_radio_crc(payload, size));
  out[0] = 0; // ends whatever noise or cut frame is on the line
  size_t coded = cobs_encode(payload, size + 2, out + 1);
  out[1 + coded] = 0;
  return coded + 2;
}

static bool unpack(uint8_t *bytes, size_t coded, vs_radio_frame *out) {
  size_t size = cobs_decode(bytes, coded);
  if (size < 3 || vs_radio_crc(bytes, size - 2) != get_u16(bytes + size - 2)) return false;
  size -= 2;
  if (bytes[0] == (VS_RADIO_VERSION << 4 | VS_RADIO_COMMAND)) {
    out->type = VS_RADIO_COMMAND;
    return unpack_command(bytes, size, &out->as.command);
  }
  if (bytes[0] == (VS_RADIO_VERSION << 4 | VS_RADIO_TELEMETRY)) {
    out->type = VS_RADIO_TELEMETRY;
    return unpack_telemetry(bytes, size, &out->as.telemetry);
  }
  return false;
}

bool vs_radio_decode(vs_radio_decoder *decoder, uint8_t byte, vs_radio_frame *out) {
  if (byte != 0) {
    if (decoder->used == sizeof decoder->bytes)
      decoder->overlong = true;
    else
      decoder->bytes[decoder->used++] = byte;
    return false;
  }
  size_t coded = decoder->used;
  bool overlong = decoder->overlong;
  decoder->used = 0;
  decoder->overlong = false;
  if (coded == 0) return false; // two delimiters in a row: an idle line
  bool good = !overlong && unpack(decoder->bytes, coded, out);
  if (good)
    decoder->ok++;
  else
    decoder->bad++;
  return good;
}
