// The own team's electronics: a radio base behind a pseudo terminal, and the reference firmware of each robot.
#ifndef VSSS_RIG_ROBOTS_H
#define VSSS_RIG_ROBOTS_H

#include "vsss/firmware.h"
#include "vsss/radio_serial.h"
#include "vsss/world.h"

enum { VS_ROBOTS_LATE_MAX = 16 };
typedef struct vs_robots {
  vs_pty *pty;
  vs_firmware firmware[VS_TEAM_SIZE];
  int64_t telemetry_us[VS_TEAM_SIZE]; // when the next is due
  int64_t taken;                      // frames the robots took
  int delay_frames;                   // a command acts so many pictures later than it would
  vs_wheels late[VS_ROBOTS_LATE_MAX][VS_TEAM_SIZE];
  int64_t late_us[VS_ROBOTS_LATE_MAX][VS_TEAM_SIZE]; // when its bytes came, of commands that are new there; else 0
  int newest;                                        // row of late
  int64_t came_us[VS_TEAM_SIZE];                     // of a command that no motor was told yet; 0: none
  int64_t heard_us;                                  // when the air was last listened to
  int64_t acted, acted_us; // commands that acted, and the sum of the time from their bytes to that
} vs_robots;

vs_status vs_robots_open(vs_robots *robots, const uint8_t id[VS_TEAM_SIZE], const vs_radio_key *key, int64_t now_us,
                         vs_error *err);
void vs_robots_close(vs_robots *robots);

// Hands on what comes over the air, until wake_us. measured: the wheels as they turn, for the telemetry.
void vs_robots_serve(vs_robots *robots, const vs_wheels measured[VS_TEAM_SIZE], int64_t wake_us);
// What the motors are told at now_us, the moment of the picture; it may lie before what was served last.
void vs_robots_wheels(vs_robots *robots, int64_t now_us, vs_wheels out[VS_TEAM_SIZE]);

#endif
