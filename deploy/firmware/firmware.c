// The robots' side of the radio, for the robot's controller and for the rig. The contract is in vsss/firmware.h.
#include "vsss/firmware.h"

void vs_firmware_init(vs_firmware *firmware, uint8_t id, uint32_t now_ms) {
  const vs_firmware stopped = {.id = id, .stopped = true, .start_ms = now_ms};
  *firmware = stopped;
}

void vs_firmware_set_key(vs_firmware *firmware, const vs_radio_key *key) { firmware->decoder.key = *key; }

static int16_t limit(int16_t counts) {
  if (counts > VS_FIRMWARE_LIMIT) return VS_FIRMWARE_LIMIT;
  if (counts < -VS_FIRMWARE_LIMIT) return -VS_FIRMWARE_LIMIT;
  return counts;
}

// After the watchdog there is no last frame to be newer than: a PC that starts anew is heard at once.
static void check_watchdog(vs_firmware *firmware, uint32_t now_ms) {
  if (firmware->running && (uint32_t)(now_ms - firmware->last_ms) > VS_FIRMWARE_WATCHDOG_MS) firmware->running = false;
}

static const vs_radio_robot *mine(const vs_firmware *firmware, const vs_radio_command *command) {
  for (int i = 0; i < command->n; i++)
    if (command->robot[i].id == firmware->id) return &command->robot[i];
  return 0;
}

static void take(vs_firmware *firmware, const vs_radio_command *command, uint32_t now_ms) {
  const vs_radio_robot *target = mine(firmware, command);
  bool stop = command->flags & VS_RADIO_FLAG_STOP;
  if (!target && !stop) return;
  check_watchdog(firmware, now_ms);
  bool again = firmware->decoder.key.set ? command->counter <= firmware->counter
                                         : firmware->running && !vs_radio_seq_newer(command->seq, firmware->last_seq);
  if (again) {
    firmware->rx_bad++;
    return;
  }
  firmware->running = true;
  firmware->counter = command->counter;
  firmware->last_seq = command->seq;
  firmware->last_ms = now_ms;
  firmware->stopped = stop;
  firmware->left = stop ? 0 : limit(target->left);
  firmware->right = stop ? 0 : limit(target->right);
  firmware->rx_ok++;
}

void vs_firmware_receive(vs_firmware *firmware, const uint8_t *bytes, size_t size, uint32_t now_ms) {
  for (size_t i = 0; i < size; i++) {
    vs_radio_frame frame;
    uint32_t bad = firmware->decoder.bad;
    if (vs_radio_decode(&firmware->decoder, bytes[i], &frame) && frame.type == VS_RADIO_COMMAND)
      take(firmware, &frame.as.command, now_ms);
    firmware->rx_bad = (uint16_t)(firmware->rx_bad + (firmware->decoder.bad - bad));
  }
}

vs_firmware_drive vs_firmware_tick(vs_firmware *firmware, uint32_t now_ms) {
  check_watchdog(firmware, now_ms);
  const vs_firmware_drive brake = {.brake = true};
  if (!firmware->running || firmware->stopped) return brake;
  const vs_firmware_drive drive = {.left = firmware->left, .right = firmware->right};
  return drive;
}

size_t vs_firmware_telemetry(const vs_firmware *firmware, uint32_t now_ms, int16_t measured_left,
                             int16_t measured_right, uint16_t battery_mv, int8_t rssi_dbm,
                             uint8_t out[VS_RADIO_FRAME_MAX]) {
  vs_radio_frame frame = {.type = VS_RADIO_TELEMETRY};
  frame.as.telemetry.id = firmware->id;
  frame.as.telemetry.seq_echo = firmware->last_seq;
  frame.as.telemetry.left = measured_left;
  frame.as.telemetry.right = measured_right;
  frame.as.telemetry.battery_mv = battery_mv;
  frame.as.telemetry.rssi_dbm = rssi_dbm;
  frame.as.telemetry.rx_ok = firmware->rx_ok;
  frame.as.telemetry.rx_bad = firmware->rx_bad;
  frame.as.telemetry.uptime_ms = now_ms - firmware->start_ms;
  return vs_radio_encode_keyed(&frame, &firmware->decoder.key, out);
}
