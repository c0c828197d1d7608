#include "robots.h"

#include <poll.h>
#include <string.h>

#include "vsss/clock.h"

#define TELEMETRY_US 100000 // 10 Hz a robot, each in its own slot
#define BATTERY_MV   7900
#define RSSI_DBM     -48

static uint32_t milliseconds(int64_t us) { return (uint32_t)(us / 1000); }

vs_status vs_robots_open(vs_robots *r, const uint8_t id[VS_TEAM_SIZE], const vs_radio_key *key, int64_t now_us,
                         vs_error *err) {
  memset(r, 0, sizeof *r);
  vs_status s = vs_pty_new(&r->pty, err);
  if (s != VS_OK) return s;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_firmware_init(&r->firmware[i], id[i], milliseconds(now_us));
    vs_firmware_set_key(&r->firmware[i], key);
    r->telemetry_us[i] = now_us + TELEMETRY_US + i * (TELEMETRY_US / VS_TEAM_SIZE);
  }
  return VS_OK;
}

void vs_robots_close(vs_robots *r) {
  vs_pty_free(r->pty);
  r->pty = NULL;
}

static void hear(vs_robots *r, int64_t now_us) {
  uint8_t bytes[256];
  size_t n;
  r->heard_us = now_us;
  while ((n = vs_pty_read(r->pty, bytes, sizeof bytes)) > 0)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_firmware before = r->firmware[i];
      vs_firmware_receive(&r->firmware[i], bytes, n, milliseconds(now_us));
      r->taken += (uint16_t)(r->firmware[i].rx_ok - before.rx_ok);
      if (r->firmware[i].left != before.left || r->firmware[i].right != before.right) r->came_us[i] = now_us;
    }
}

static void tell(vs_robots *r, const vs_wheels measured[VS_TEAM_SIZE], int64_t now_us) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (now_us < r->telemetry_us[i]) continue;
    r->telemetry_us[i] = now_us + TELEMETRY_US;
    uint8_t frame[VS_RADIO_FRAME_MAX];
    size_t n = vs_firmware_telemetry(&r->firmware[i], milliseconds(now_us), vs_radio_counts(measured[i].left_radps),
                                     vs_radio_counts(measured[i].right_radps), BATTERY_MV, RSSI_DBM, frame);
    vs_pty_write(r->pty, frame, n);
  }
}

void vs_robots_serve(vs_robots *r, const vs_wheels measured[VS_TEAM_SIZE], int64_t wake_us) {
  for (;;) {
    int64_t now_us = vs_clock_monotonic_us();
    hear(r, now_us);
    tell(r, measured, now_us);
    if (now_us >= wake_us) return;
    struct pollfd wait = {.fd = vs_pty_fd(r->pty), .events = POLLIN};
    int left_ms = (int)((wake_us - now_us + 999) / 1000);
    // While nobody has the other end open, poll(2) reports a hang-up at once: then only time wakes us.
    if (poll(&wait, 1, left_ms < 5 ? left_ms : 5) > 0 && !(wait.revents & POLLIN))
      vs_clock_sleep_until_us(now_us + 2000 < wake_us ? now_us + 2000 : wake_us);
  }
}

void vs_robots_wheels(vs_robots *r, int64_t now_us, vs_wheels out[VS_TEAM_SIZE]) {
  // A picture that is drawn late is of a moment before the last bytes: the firmware's clock does not run back.
  uint32_t clock_ms = milliseconds(now_us > r->heard_us ? now_us : r->heard_us);
  r->newest = (r->newest + 1) % VS_ROBOTS_LATE_MAX;
  int now = (r->newest + VS_ROBOTS_LATE_MAX - r->delay_frames) % VS_ROBOTS_LATE_MAX;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_firmware_drive drive = vs_firmware_tick(&r->firmware[i], clock_ms);
    r->late[r->newest][i] = (vs_wheels){vs_radio_radps(drive.left), vs_radio_radps(drive.right)};
    r->late_us[r->newest][i] = r->came_us[i];
    r->came_us[i] = 0;
    out[i] = r->late[now][i];
    if (!r->late_us[now][i]) continue;
    r->acted++;
    r->acted_us += now_us - r->late_us[now][i];
  }
}
