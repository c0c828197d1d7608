// deploy/firmware/esp32/robot.c on a fake SDK: commanded at 50 Hz it turns its wheels as fast as commanded, STOP and silence
// brake, telemetry comes.
#include <assert.h>
#include <math.h>

#include "../../deploy/firmware/esp32/config.h"
#include "fake_sdk.h"
#include "vsss/firmware.h"

fake_world fake;
void app_main(void);

static double speed[2]; // rad/s of the wheels
static int reports;
static vs_radio_telemetry report;

static const int in1[2] = {PIN_IN1_LEFT, PIN_IN1_RIGHT}, in2[2] = {PIN_IN2_LEFT, PIN_IN2_RIGHT};

static bool brakes(int i) { return fake.level[in1[i]] && fake.level[in2[i]]; }

// First order, 60 ms; 45 rad/s at full duty, where the firmware believes 50.
static void turn_wheels(double dt_s) {
  for (int i = 0; i < 2; i++) {
    double way = brakes(i) ? 0 : fake.level[in1[i]] - fake.level[in2[i]];
    speed[i] += (way * 45 * fake.duty[i] / 1023.0 - speed[i]) * dt_s / (brakes(i) ? 0.02 : 0.06);
    fake.count[i] += speed[i] * dt_s * COUNTS_PER_RAD;
  }
}

static void command(int seq, int left, int right, bool stop) {
  vs_radio_frame f = {.type = VS_RADIO_COMMAND};
  f.as.command = (vs_radio_command){.seq = (uint8_t)seq, .flags = stop ? VS_RADIO_FLAG_STOP : 0, .n = 2};
  f.as.command.robot[0] = (vs_radio_robot){ROBOT_ID + 1, -4000, 4000}; // another one's
  f.as.command.robot[1] = (vs_radio_robot){ROBOT_ID, (int16_t)left, (int16_t)right};
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  wifi_pkt_rx_ctrl_t control = {.rssi = -50};
  const esp_now_recv_info_t info = {.rx_ctrl = &control};
  fake.heard(&info, bytes, (int)vs_radio_encode(&f, bytes));
}

static void listen(void) {
  static int seen;
  vs_radio_decoder decoder = {0};
  vs_radio_frame f;
  if (fake.packets_sent == seen) return;
  seen = fake.packets_sent;
  for (size_t i = 0; i < fake.sent.size; i++)
    if (vs_radio_decode(&decoder, fake.sent.bytes[i], &f) && f.type == VS_RADIO_TELEMETRY) {
      report = f.as.telemetry;
      reports++;
    }
}

void fake_tick(void) {
  static int step;
  for (int i = 0; i < 5; i++) turn_wheels(1e-3);
  fake.now_us += 5000;
  listen();
  int ms = 5 * ++step;
  assert(fake.level[PIN_STANDBY] == 1);
  if (ms < 100) assert(brakes(0) && brakes(1)); // never commanded
  if (ms >= 100 && ms < 1500 && ms % 20 == 0) command(ms / 20, 1000, -500, false);
  if (ms == 1495) { // 10 and -5 rad/s, steady
    assert(fabs(speed[0] - 10) < 0.5 && fabs(speed[1] + 5) < 0.5);
    assert(reports >= 12 && abs(report.left - 1000) < 150 && report.id == ROBOT_ID && report.rssi_dbm == -50);
    assert(abs((int)report.battery_mv - 7600) < 50);
  }
  if (ms == 1600) assert(!brakes(0));             // 120 ms of silence
  if (ms == 1700) assert(brakes(0) && brakes(1)); // more than the watchdog's 150
  if (ms >= 1800 && ms < 2000 && ms % 20 == 0) command(ms / 20, 2000, 2000, false);
  if (ms == 1995) assert(!brakes(0) && speed[0] > 5);
  if (ms == 2000) command(100, 2000, 2000, true);
  if (ms == 2010) assert(brakes(0) && brakes(1)); // STOP, at once
  if (ms == 2300) {
    assert(fabs(speed[0]) < 0.1 && fabs(speed[1]) < 0.1);
    printf("robot: well\n");
    exit(0);
  }
}

int main(void) {
  app_main();
  fake.task(NULL);
  return 1;
}
