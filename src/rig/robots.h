// The own team's electronics: a radio base behind a pseudo terminal, and the reference firmware of each robot.
#ifndef VSSS_RIG_ROBOTS_H
#define VSSS_RIG_ROBOTS_H

#include "vsss/firmware.h"
#include "vsss/radio_serial.h"
#include "vsss/world.h"

typedef struct vs_robots {
  vs_pty *pty;
  vs_firmware firmware[VS_TEAM_SIZE];
  int64_t telemetry_us[VS_TEAM_SIZE]; // when the next is due
  int64_t taken;                      // frames the robots took
} vs_robots;

vs_status vs_robots_open(vs_robots *robots, const uint8_t id[VS_TEAM_SIZE], const vs_radio_key *key, int64_t now_us,
                         vs_error *err);
void vs_robots_close(vs_robots *robots);

// Hands on what comes over the air, until wake_us. measured: the wheels as they turn, for the telemetry.
void vs_robots_serve(vs_robots *robots, const vs_wheels measured[VS_TEAM_SIZE], int64_t wake_us);
// What the motors are told now.
void vs_robots_wheels(vs_robots *robots, int64_t now_us, vs_wheels out[VS_TEAM_SIZE]);

#endif
