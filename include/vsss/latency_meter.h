// How long a team's commands take to act, from what its robots are seen to do: mid-exposure to wheel, as
// vs_control_set_latency wants it.
//
// Of latencies from 0 to VS_LATENCY_METER_MAX_S the one is told under which the own robots were foretold best, one
// measurement to the next (control/predict.h), over the last 20 s or so in which it made a difference. What pushes robots
// about, or a servo unlike the simulator's, spoils all of them alike or is part of the answer: with it the prediction is at
// its best. Pure: the same worlds and commands, the same answer.
#ifndef VSSS_LATENCY_METER_H
#define VSSS_LATENCY_METER_H

#include <stdbool.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_LATENCY_METER_MAX_S 0.2

typedef struct vs_latency_meter vs_latency_meter;

vs_status vs_latency_meter_new(vs_team team, vs_latency_meter **out, vs_error *err);
void vs_latency_meter_free(vs_latency_meter *meter); // NULL is allowed

// What went to the robots, each time anew: time_us is the moment of the world that it answers to.
void vs_latency_meter_sent(vs_latency_meter *meter, int64_t time_us, const vs_wheels wheels[VS_TEAM_SIZE]);
// A measured world, absolute frame. True: *latency_s is a new answer; once a second at most, and only while the robots'
// motion tells latencies apart.
bool vs_latency_meter_see(vs_latency_meter *meter, const vs_world *measured, double *latency_s);

#ifdef __cplusplus
}
#endif
#endif
