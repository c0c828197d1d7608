// Tests src/comms/radio_codec.c.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/paths.h"
#include "vsss/radio_codec.h"
#include "vsss/rng.h"

static vs_radio_frame random_command(vs_rng *rng, int robots) {
  vs_radio_frame f;
  memset(&f, 0, sizeof f);
  f.type = VS_RADIO_COMMAND;
  f.as.command.seq = (uint8_t)vs_rng_u64(rng);
  f.as.command.flags = (uint8_t)vs_rng_below(rng, 2);
  f.as.command.n = (uint8_t)robots;
  for (int i = 0; i < robots; i++)
    f.as.command.robot[i] = (vs_radio_robot){(uint8_t)i, (int16_t)((int)vs_rng_below(rng, 9333) - 4666),
                                             (int16_t)((int)vs_rng_below(rng, 9333) - 4666)};
  return f;
}

static bool same_command(const vs_radio_frame *a, const vs_radio_frame *b) {
  const vs_radio_command *x = &a->as.command, *y = &b->as.command;
  if (a->type != VS_RADIO_COMMAND || b->type != VS_RADIO_COMMAND) return false;
  if (x->seq != y->seq || x->flags != y->flags || x->n != y->n) return false;
  for (int i = 0; i < x->n; i++)
    if (x->robot[i].id != y->robot[i].id || x->robot[i].left != y->robot[i].left ||
        x->robot[i].right != y->robot[i].right)
      return false;
  return true;
}

// Frames that came out of bytes; the last one in out.
static int feed(vs_radio_decoder *decoder, const uint8_t *bytes, size_t size, vs_radio_frame *out) {
  int frames = 0;
  for (size_t i = 0; i < size; i++) frames += vs_radio_decode(decoder, bytes[i], out);
  return frames;
}

static void crc_is_ccitt_false(void **state) {
  (void)state;
  assert_int_equal(vs_radio_crc((const uint8_t *)"123456789", 9), 0x29B1); // the catalogue's check value
  assert_int_equal(vs_radio_crc(NULL, 0), 0xFFFF);
}

static void three_robots_take_24_bytes(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(1, 0);
  vs_radio_frame f = random_command(&rng, 3);
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  assert_int_equal(vs_radio_encode(&f, bytes), 24);
  f.as.command.n = VS_RADIO_ROBOTS_MAX + 1;
  assert_int_equal(vs_radio_encode(&f, bytes), 0);
}

static void speeds_round_and_saturate(void **state) {
  (void)state;
  assert_int_equal(vs_radio_counts(46.66), 4666);
  assert_int_equal(vs_radio_counts(-46.66), -4666);
  assert_int_equal(vs_radio_counts(0.0051), 1);
  assert_int_equal(vs_radio_counts(-0.0049), 0);
  assert_int_equal(vs_radio_counts(1e9), 32767);
  assert_int_equal(vs_radio_counts(-INFINITY), -32767);
  assert_int_equal(vs_radio_counts(NAN), 0);
  assert_near(vs_radio_radps(-4666), -46.66, 1e-12);
}

static int hex(const char *text, uint8_t *out) {
  int n = 0;
  unsigned value;
  while (sscanf(text + 2 * n, "%2x", &value) == 1) out[n++] = (uint8_t)value;
  return n;
}

static void golden_command(const char *text, vs_radio_frame *f) {
  long long seq;
  int flags, at, id, left, right, more;
  assert_int_equal(sscanf(text, "command %lld %d%n", &seq, &flags, &at), 2);
  f->type = VS_RADIO_COMMAND;
  f->as.command.seq = (uint8_t)seq;
  f->as.command.flags = (uint8_t)flags;
  for (; sscanf(text + at, "%d:%d:%d%n", &id, &left, &right, &more) == 3; at += more)
    f->as.command.robot[f->as.command.n++] = (vs_radio_robot){(uint8_t)id, (int16_t)left, (int16_t)right};
}

static void golden_telemetry(const char *text, vs_radio_frame *f) {
  int v[8];
  unsigned uptime;
  assert_int_equal(sscanf(text, "telemetry %d %d %d %d %d %d %d %d %u", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5], &v[6],
                          &v[7], &uptime),
                   9);
  f->type = VS_RADIO_TELEMETRY;
  f->as.telemetry = (vs_radio_telemetry){(uint8_t)v[0], (uint8_t)v[1],  (int16_t)v[2],  (int16_t)v[3], (uint16_t)v[4],
                                         (int8_t)v[5],  (uint16_t)v[6], (uint16_t)v[7], uptime};
}

// Every line of a golden file is written byte for byte and read back. The key line, where there is one, comes first.
static int check_golden(const char *name) {
  char path[512], line[512];
  assert_ok(vs_path_find(name, path, sizeof path, err));
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  int checked = 0;
  vs_radio_key key = {.set = false};
  while (fgets(line, sizeof line, file)) {
    if (line[0] == '#') continue;
    int team = 0;
    char digits[64];
    if (sscanf(line, "key %d %63s", &team, digits) == 2) {
      assert_true(vs_radio_key_parse(team, digits, &key));
      continue;
    }
    vs_radio_frame f, back;
    memset(&f, 0, sizeof f);
    memset(&back, 0, sizeof back);
    if (line[0] == 'c') {
      golden_command(line, &f);
      f.as.command.counter = strtoull(line + strlen("command "), NULL, 10);
    } else {
      golden_telemetry(line, &f);
    }
    uint8_t want[VS_RADIO_FRAME_MAX], got[VS_RADIO_FRAME_MAX];
    int n = hex(strchr(line, '=') + 2, want);
    assert_int_equal(vs_radio_encode_keyed(&f, &key, got), n);
    assert_memory_equal(got, want, (size_t)n);
    vs_radio_decoder decoder = {.key = key};
    assert_int_equal(feed(&decoder, want, (size_t)n, &back), 1);
    if (f.type == VS_RADIO_COMMAND) {
      assert_true(same_command(&f, &back));
      if (key.set) assert_true(f.as.command.counter == back.as.command.counter);
    } else {
      assert_int_equal(back.type, VS_RADIO_TELEMETRY);
      assert_int_equal(back.as.telemetry.id, f.as.telemetry.id);
      assert_int_equal(back.as.telemetry.rssi_dbm, f.as.telemetry.rssi_dbm);
      assert_int_equal(back.as.telemetry.right, f.as.telemetry.right);
      assert_int_equal(back.as.telemetry.uptime_ms, f.as.telemetry.uptime_ms);
    }
    checked++;
  }
  fclose(file);
  return checked;
}

static void golden_frames_are_written_and_read(void **state) {
  (void)state;
  assert_int_equal(check_golden("tests/golden/radio_v1.txt"), 9);
}

static void golden_frames_with_a_key_are_written_and_read(void **state) {
  (void)state;
  assert_int_equal(check_golden("tests/golden/radio_v2.txt"), 8);
}

static vs_radio_key key_of(int team, const char *digits) {
  vs_radio_key key;
  assert_true(vs_radio_key_parse(team, digits, &key));
  return key;
}

// What of the four forms each receiver takes: none set, our key, our number with another key, another number with our key.
static void a_frame_is_taken_only_by_those_of_the_same_key(void **state) {
  (void)state;
  const vs_radio_key keys[4] = {{.set = false},
                                key_of(7, "000102030405060708090a0b0c0d0e0f"),
                                key_of(7, "000102030405060708090a0b0c0d0e10"),
                                key_of(8, "000102030405060708090a0b0c0d0e0f")};
  vs_rng rng = vs_rng_make(7, 0);
  for (int round = 0; round < 200; round++)
    for (int from = 0; from < 4; from++)
      for (int to = 0; to < 4; to++) {
        vs_radio_frame f = random_command(&rng, 3), out;
        f.as.command.counter = (uint64_t)f.as.command.seq;
        f.as.command.flags = VS_RADIO_FLAG_STOP;
        uint8_t bytes[VS_RADIO_FRAME_MAX];
        size_t size = vs_radio_encode_keyed(&f, &keys[from], bytes);
        vs_radio_decoder decoder = {.key = keys[to]};
        assert_int_equal(feed(&decoder, bytes, size, &out), from == to);
        assert_int_equal(decoder.foreign, from != to);
      }
}

// With the CRC made to fit, so that the check alone stands against it.
static void a_changed_bit_fails_the_check(void **state) {
  (void)state;
  vs_radio_key key = key_of(7, "0102030405060708090a0b0c0d0e0f10");
  // A command for one robot in which no byte is zero: COBS adds one byte only.
  uint8_t payload[] = {0x21, 7, 9, 9, 9, 9, 9, 9, 2, 1, 3, 1, 1, 2, 2, 0, 0, 0, 0, 0, 0};
  size_t body = sizeof payload - 6;
  do {
    payload[2]++;
    uint32_t check = (uint32_t)vs_siphash(key.secret, payload, body);
    for (int i = 0; i < 4; i++) payload[body + (size_t)i] = (uint8_t)(check >> 8 * i);
    uint16_t crc = vs_radio_crc(payload, sizeof payload - 2);
    payload[body + 4] = (uint8_t)crc;
    payload[body + 5] = (uint8_t)(crc >> 8);
  } while (memchr(payload, 0, sizeof payload));
  int tried = 0;
  for (size_t bit = 0; bit <= 8 * (body + 4); bit++) { // the last: none
    uint8_t changed[sizeof payload], bytes[sizeof payload + 2];
    memcpy(changed, payload, sizeof payload);
    if (bit < 8 * (body + 4)) changed[bit / 8] ^= (uint8_t)(1 << bit % 8);
    uint16_t crc = vs_radio_crc(changed, sizeof changed - 2);
    changed[body + 4] = (uint8_t)crc;
    changed[body + 5] = (uint8_t)(crc >> 8);
    if (memchr(changed, 0, sizeof changed)) continue;
    bytes[0] = sizeof changed + 1;
    memcpy(bytes + 1, changed, sizeof changed);
    bytes[sizeof bytes - 1] = 0;
    vs_radio_decoder decoder = {.key = key};
    vs_radio_frame out;
    assert_int_equal(feed(&decoder, bytes, sizeof bytes, &out), bit == 8 * (body + 4));
    tried++;
  }
  assert_true(tried > 100);
}

static void a_key_is_32_hexadecimal_digits(void **state) {
  (void)state;
  vs_radio_key key;
  assert_true(vs_radio_key_parse(255, "0123456789abcdefABCDEF9876543210", &key));
  assert_int_equal(key.secret[0], 0x01);
  assert_int_equal(key.secret[8], 0xAB);
  assert_int_equal(key.secret[15], 0x10);
  assert_false(vs_radio_key_parse(256, "0123456789abcdefABCDEF9876543210", &key));
  assert_false(vs_radio_key_parse(0, "", &key));
  assert_false(vs_radio_key_parse(0, "0123456789abcdefABCDEF987654321", &key));
  assert_false(vs_radio_key_parse(0, "0123456789abcdefABCDEF98765432100", &key));
  assert_false(vs_radio_key_parse(0, "0123456789abcdefABCDEF987654321g", &key));
}

static void three_robots_with_a_key_fit_a_packet_of_32_bytes(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(8, 0);
  vs_radio_key key = key_of(1, "0102030405060708090a0b0c0d0e0f10");
  vs_radio_frame f = random_command(&rng, 3);
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  assert_int_equal(vs_radio_encode_keyed(&f, &key, bytes), 32 + 2); // with two delimiters
  f.as.command.n = VS_RADIO_ROBOTS_MAX;
  assert_true(vs_radio_encode_keyed(&f, &key, bytes) <= VS_RADIO_FRAME_MAX);
}

static void frame_cut_at_every_point_arrives_once(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(2, 0);
  vs_radio_frame f = random_command(&rng, 3), out;
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  size_t size = vs_radio_encode(&f, bytes);
  for (size_t cut = 0; cut <= size; cut++) {
    vs_radio_decoder decoder = {0};
    int first = feed(&decoder, bytes, cut, &out);
    assert_int_equal(first, cut == size);
    assert_int_equal(first + feed(&decoder, bytes + cut, size - cut, &out), 1);
    assert_true(same_command(&f, &out));
  }
}

static void every_single_bit_flip_is_rejected(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(3, 0);
  for (int round = 0; round < 2000; round++) {
    vs_radio_frame f = random_command(&rng, round % 4), out;
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    size_t size = vs_radio_encode(&f, bytes);
    for (size_t bit = 0; bit < 8 * size; bit++) {
      vs_radio_decoder decoder = {0};
      bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
      if (feed(&decoder, bytes, size, &out)) fail_msg("round %d: bit %zu flipped, frame taken", round, bit);
      bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
  }
}

static void garbage_before_a_frame_costs_nothing(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(4, 0);
  for (int length = 0; length < 200; length++) {
    vs_radio_decoder decoder = {0};
    vs_radio_frame f = random_command(&rng, 3), out;
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    size_t size = vs_radio_encode(&f, bytes);
    for (int i = 0; i < length; i++) vs_radio_decode(&decoder, (uint8_t)(1 + vs_rng_below(&rng, 255)), &out);
    assert_int_equal(feed(&decoder, bytes, size, &out), 1);
    assert_true(same_command(&f, &out));
    assert_int_equal(decoder.bad, length > 0);
  }
}

static void lost_bytes_cost_one_frame_and_a_lost_delimiter_none(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(5, 0);
  vs_radio_frame f = random_command(&rng, 3), out;
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  size_t size = vs_radio_encode(&f, bytes);
  for (size_t from = 0; from < size; from++)
    for (size_t to = from + 1; to <= size; to++) { // bytes [from, to) are lost out of the first of three frames
      vs_radio_decoder decoder = {0};
      int frames = feed(&decoder, bytes, from, &out) + feed(&decoder, bytes + to, size - to, &out);
      frames += feed(&decoder, bytes, size, &out) + feed(&decoder, bytes, size, &out);
      bool delimiter = to == from + 1 && (from == 0 || to == size);
      assert_int_equal(frames, delimiter ? 3 : 2);
    }
}

static void bytes_a_terminal_would_eat_survive(void **state) {
  (void)state;
  const uint8_t special[] = {0x00, 0x03, 0x0A, 0x0D, 0x11, 0x13, 0x1A, 0x7F, 0xFF};
  for (size_t i = 0; i < sizeof special; i++) {
    vs_radio_frame f = {.type = VS_RADIO_COMMAND}, out;
    uint8_t b = special[i];
    int16_t both = (int16_t)(b | b << 8);
    f.as.command = (vs_radio_command){b, b, 2, {{b, both, both}, {(uint8_t)(b + 1), both, both}}, 0};
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    size_t size = vs_radio_encode(&f, bytes);
    assert_null(memchr(bytes + 1, 0, size - 2));
    vs_radio_decoder decoder = {0};
    assert_int_equal(feed(&decoder, bytes, size, &out), 1);
    assert_true(same_command(&f, &out));
  }
}

static void other_versions_types_and_lengths_are_refused(void **state) {
  (void)state;
  // A command for one robot, written by hand with another first byte or count and a CRC that fits; unchanged, it passes.
  const uint8_t heads[] = {0x21, 0x01, 0x13, 0x10, 0xF1};
  for (size_t i = 0; i <= sizeof heads + 1; i++) {
    uint8_t payload[] = {0x11, 17, 1, 1, 3, 1, 1, 2, 2, 0, 0}, bytes[16], used = 0;
    if (i < sizeof heads) payload[0] = heads[i];
    if (i == sizeof heads) payload[3] = 2; // two robots announced, one there
    do {                                   // a seq with which no byte is zero, so that COBS adds one code byte only
      payload[1]++;
      uint16_t crc = vs_radio_crc(payload, 9);
      payload[9] = (uint8_t)crc;
      payload[10] = (uint8_t)(crc >> 8);
    } while (memchr(payload, 0, sizeof payload));
    bytes[used++] = sizeof payload + 1;
    memcpy(bytes + used, payload, sizeof payload);
    bytes[1 + sizeof payload] = 0;
    vs_radio_decoder decoder = {0};
    vs_radio_frame out;
    assert_int_equal(feed(&decoder, bytes, 2 + sizeof payload, &out), i > sizeof heads);
    assert_int_equal(decoder.bad, i <= sizeof heads);
  }
}

static void seq_wraps_around(void **state) {
  (void)state;
  assert_true(vs_radio_seq_newer(1, 0));
  assert_true(vs_radio_seq_newer(0, 255));
  assert_true(vs_radio_seq_newer(127, 0));
  assert_false(vs_radio_seq_newer(128, 0));
  assert_false(vs_radio_seq_newer(5, 5));
  assert_false(vs_radio_seq_newer(255, 0));
}

static void a_million_random_bytes_are_no_frame_and_the_next_frame_is(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(6, 0);
  vs_radio_decoder decoder = {0};
  vs_radio_frame out;
  for (int i = 0; i < 1000000 / 8; i++) {
    uint64_t eight = vs_rng_u64(&rng);
    assert_int_equal(feed(&decoder, (const uint8_t *)&eight, 8, &out), 0);
  }
  assert_true(decoder.bad > 1000); // about 3,900 zeros are among them
  vs_radio_decode(&decoder, 0, &out);
  vs_radio_frame f = random_command(&rng, 3);
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  assert_int_equal(feed(&decoder, bytes, vs_radio_encode(&f, bytes), &out), 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crc_is_ccitt_false),
      cmocka_unit_test(three_robots_take_24_bytes),
      cmocka_unit_test(speeds_round_and_saturate),
      cmocka_unit_test(golden_frames_are_written_and_read),
      cmocka_unit_test(golden_frames_with_a_key_are_written_and_read),
      cmocka_unit_test(a_frame_is_taken_only_by_those_of_the_same_key),
      cmocka_unit_test(a_changed_bit_fails_the_check),
      cmocka_unit_test(a_key_is_32_hexadecimal_digits),
      cmocka_unit_test(three_robots_with_a_key_fit_a_packet_of_32_bytes),
      cmocka_unit_test(frame_cut_at_every_point_arrives_once),
      cmocka_unit_test(every_single_bit_flip_is_rejected),
      cmocka_unit_test(garbage_before_a_frame_costs_nothing),
      cmocka_unit_test(lost_bytes_cost_one_frame_and_a_lost_delimiter_none),
      cmocka_unit_test(bytes_a_terminal_would_eat_survive),
      cmocka_unit_test(other_versions_types_and_lengths_are_refused),
      cmocka_unit_test(seq_wraps_around),
      cmocka_unit_test(a_million_random_bytes_are_no_frame_and_the_next_frame_is),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
