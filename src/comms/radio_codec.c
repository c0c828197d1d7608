// Protocol v1 and v2 between PC and robots. Freestanding: also part of a robot's firmware.
#include "vsss/radio_codec.h"

#define ROBOT_BYTES     5u
#define TELEMETRY_BYTES 18u // of version 1; the keyed one has the team besides

bool vs_radio_key_parse(int team, const char *digits, vs_radio_key *out) {
  vs_radio_key key = {.set = true, .team = (uint8_t)team};
  if (team < 0 || team > 255) return false;
  for (int i = 0; i < 2 * VS_SIPHASH_KEY; i++) {
    char c = digits[i];
    int value = c >= '0' && c <= '9'   ? c - '0'
                : c >= 'a' && c <= 'f' ? c - 'a' + 10
                : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                       : -1;
    if (value < 0) return false;
    key.secret[i / 2] = (uint8_t)(key.secret[i / 2] << 4 | value);
  }
  if (digits[2 * VS_SIPHASH_KEY]) return false;
  *out = key;
  return true;
}

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

static uint8_t *put_u32(uint8_t *p, uint32_t value) {
  return put_u16(put_u16(p, (uint16_t)value), (uint16_t)(value >> 16));
}

static uint32_t get_u32(const uint8_t *p) { return get_u16(p) | (uint32_t)get_u16(p + 2) << 16; }

// Head, and for keyed frames the team.
static uint8_t *put_head(uint8_t *p, vs_radio_type type, const vs_radio_key *key) {
  *p++ = (uint8_t)((key ? VS_RADIO_KEYED : VS_RADIO_VERSION) << 4 | (int)type);
  if (key) *p++ = key->team;
  return p;
}

static size_t pack_command(const vs_radio_command *c, const vs_radio_key *key, uint8_t *out) {
  uint8_t *p = put_head(out, VS_RADIO_COMMAND, key);
  if (key) {
    p = put_u32(p, (uint32_t)c->counter);
    p = put_u16(p, (uint16_t)(c->counter >> 32));
  } else {
    *p++ = c->seq;
  }
  *p++ = c->flags;
  *p++ = c->n;
  for (int i = 0; i < c->n; i++) {
    *p++ = c->robot[i].id;
    p = put_u16(p, (uint16_t)c->robot[i].left);
    p = put_u16(p, (uint16_t)c->robot[i].right);
  }
  return (size_t)(p - out);
}

static size_t pack_telemetry(const vs_radio_telemetry *t, const vs_radio_key *key, uint8_t *out) {
  uint8_t *p = put_head(out, VS_RADIO_TELEMETRY, key);
  *p++ = t->id;
  *p++ = t->seq_echo;
  p = put_u16(p, (uint16_t)t->left);
  p = put_u16(p, (uint16_t)t->right);
  p = put_u16(p, t->battery_mv);
  *p++ = (uint8_t)t->rssi_dbm;
  p = put_u16(p, t->rx_ok);
  p = put_u16(p, t->rx_bad);
  p = put_u32(p, t->uptime_ms);
  return (size_t)(p - out);
}

// in: what follows the head, and the team where there is one.
static bool unpack_command(const uint8_t *in, size_t size, bool keyed, vs_radio_command *c) {
  size_t start = keyed ? 6 : 1;
  if (size < start + 2) return false;
  c->counter = keyed ? get_u32(in) | (uint64_t)get_u16(in + 4) << 32 : 0;
  c->seq = in[0];
  c->flags = in[start];
  c->n = in[start + 1];
  if (c->n > VS_RADIO_ROBOTS_MAX || size != start + 2 + ROBOT_BYTES * c->n) return false;
  for (int i = 0; i < c->n; i++) {
    const uint8_t *p = in + start + 2 + ROBOT_BYTES * (size_t)i;
    c->robot[i] = (vs_radio_robot){.id = p[0], .left = get_i16(p + 1), .right = get_i16(p + 3)};
  }
  return true;
}

static bool unpack_telemetry(const uint8_t *in, size_t size, vs_radio_telemetry *t) {
  if (size != TELEMETRY_BYTES - 1) return false;
  t->id = in[0];
  t->seq_echo = in[1];
  t->left = get_i16(in + 2);
  t->right = get_i16(in + 4);
  t->battery_mv = get_u16(in + 6);
  t->rssi_dbm = (int8_t)in[8];
  t->rx_ok = get_u16(in + 9);
  t->rx_bad = get_u16(in + 11);
  t->uptime_ms = get_u32(in + 13);
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

size_t vs_radio_encode_keyed(const vs_radio_frame *frame, const vs_radio_key *key, uint8_t out[VS_RADIO_FRAME_MAX]) {
  uint8_t payload[VS_RADIO_PAYLOAD_MAX + 2];
  size_t size;
  if (!key->set) key = 0;
  if (frame->type == VS_RADIO_COMMAND) {
    if (frame->as.command.n > VS_RADIO_ROBOTS_MAX) return 0;
    size = pack_command(&frame->as.command, key, payload);
  } else {
    size = pack_telemetry(&frame->as.telemetry, key, payload);
  }
  if (key) {
    put_u32(payload + size, (uint32_t)vs_siphash(key->secret, payload, size));
    size += VS_RADIO_CHECK;
  }
  put_u16(payload + size, vs_radio_crc(payload, size));
  out[0] = 0; // ends whatever noise or cut frame is on the line
  size_t coded = cobs_encode(payload, size + 2, out + 1);
  out[1 + coded] = 0;
  return coded + 2;
}

size_t vs_radio_encode(const vs_radio_frame *frame, uint8_t out[VS_RADIO_FRAME_MAX]) {
  static const vs_radio_key none = {.set = false};
  return vs_radio_encode_keyed(frame, &none, out);
}

// The frame is our team's: where a key is set it carries it, else it is of the form that has none.
static bool is_ours(const vs_radio_key *key, const uint8_t *bytes, size_t *size) {
  if (bytes[0] >> 4 != (key->set ? VS_RADIO_KEYED : VS_RADIO_VERSION)) return false;
  if (!key->set) return true;
  if (*size < 2 + VS_RADIO_CHECK || bytes[1] != key->team) return false;
  *size -= VS_RADIO_CHECK;
  return get_u32(bytes + *size) == (uint32_t)vs_siphash(key->secret, bytes, *size);
}

static bool unpack(vs_radio_decoder *decoder, size_t coded, vs_radio_frame *out) {
  uint8_t *bytes = decoder->bytes;
  size_t size = cobs_decode(bytes, coded), head = decoder->key.set ? 2 : 1;
  if (size < 3 || vs_radio_crc(bytes, size - 2) != get_u16(bytes + size - 2)) return false;
  size -= 2;
  if (!is_ours(&decoder->key, bytes, &size)) {
    decoder->foreign++;
    return false;
  }
  if ((bytes[0] & 15) == VS_RADIO_COMMAND) {
    out->type = VS_RADIO_COMMAND;
    return unpack_command(bytes + head, size - head, decoder->key.set, &out->as.command);
  }
  if ((bytes[0] & 15) == VS_RADIO_TELEMETRY) {
    out->type = VS_RADIO_TELEMETRY;
    return unpack_telemetry(bytes + head, size - head, &out->as.telemetry);
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
  bool good = !overlong && unpack(decoder, coded, out);
  if (good)
    decoder->ok++;
  else
    decoder->bad++;
  return good;
}
