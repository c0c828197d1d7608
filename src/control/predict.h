// Measured worlds -> the world at the moment when a command given now acts.
//
// Velocities that were worked out from noisy poses are too rough and too late to predict with: robots change theirs within
// a frame. So each object has an alpha-beta filter of its own here, and that of an own robot knows what it was commanded.
#ifndef VSSS_CONTROL_PREDICT_H
#define VSSS_CONTROL_PREDICT_H

#include "vsss/world.h"

// A command is kept where it differs from the one before: half a second of a player that decides at 30 Hz.
#define VS_COMMANDS_KEPT 16

// What a team commanded lately, oldest first.
typedef struct vs_commands {
  int count;
  int64_t time_us[VS_COMMANDS_KEPT]; // moment of the world that it answered to
  vs_wheels wheels[VS_COMMANDS_KEPT][VS_TEAM_MOST];
} vs_commands;

// Plain data. All zeros: nothing was seen or commanded yet.
typedef struct vs_predictor {
  vs_commands commands;
  bool started;
  vs_world now; // as estimated at the moment of the newest measurement, absolute frame
} vs_predictor;

void vs_predictor_command(vs_predictor *predictor, int64_t time_us, const vs_wheels wheels[VS_TEAM_MOST]);

// Takes a measured world (absolute frame) in, each once: one that is not newer changes nothing. Commands of `team` reach
// its robots latency_s after the moment of the world they answered to.
void vs_predictor_see(vs_predictor *predictor, vs_team team, double latency_s, const vs_world *measured);

// The world latency_s after the newest measurement: robots of `team` obey the commands that are still on their way as the
// wheel servo lets them (without commands they stand), the other team's go on as they go, the ball rolls, rebounds at walls
// and is pushed by robots. What is not valid stays where it is.
void vs_predictor_ahead(const vs_predictor *predictor, vs_team team, double latency_s, vs_world *out);

#endif
