// Stable: part of libvsss (deploy/docs/library.md).
//
// The nouns: what every module passes on and none owns. One plain struct; the simulator or the tracker makes it, all
// others read it.
//
// Frames. Absolute: field.h's, blue attacks +x. Team view (vs_world_for_team): as absolute, but rotated by pi for
// yellow and with robot[0] = own team, robot[1] = adversaries, so that every team believes it attacks +x.
#ifndef VSSS_WORLD_H
#define VSSS_WORLD_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/api.h"
#include "vsss/division.h"
#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_TEAMS     2
#define VS_TEAM_SIZE 3 // of 3 against 3: what the policy plays and our team has; others: division.h

#define VS_CAMERA_HZ 30 // frames of the world per second, as the paper's camera gives them; policies see every third

typedef enum vs_team { VS_BLUE = 0, VS_YELLOW = 1 } vs_team;
// Indices of a team-view world.
enum { VS_OWN = 0, VS_ADVERSARY = 1 };

typedef struct vs_pose {
  double x_m, y_m;
  double theta_rad; // counter-clockwise from +x, (-pi, pi]
} vs_pose;

typedef struct vs_robot {
  vs_pose pose;
  double vx_mps, vy_mps, omega_radps;
  double left_radps, right_radps; // wheel speeds where known (truth, telemetry), else 0
  bool valid;                     // seen recently enough to act on
} vs_robot;

typedef struct vs_ball {
  double x_m, y_m, z_m; // z: of the centre
  double vx_mps, vy_mps, vz_mps;
  bool valid;
} vs_ball;

typedef struct vs_world {
  int64_t time_us; // of the measurement: simulated time, or mid-exposure on the monotonic clock
  uint32_t seq;    // counts frames
  vs_division division;
  vs_robot robot[VS_TEAMS][VS_TEAM_MOST]; // the division's team_size, then zeros
  vs_ball ball;
} vs_world;

typedef struct vs_wheels {
  double left_radps, right_radps; // positive drives forward
} vs_wheels;

// What the referee last said.
typedef enum vs_event_kind {
  VS_EVENT_NONE = 0,
  VS_EVENT_KICK_OFF,
  VS_EVENT_GOAL,
  VS_EVENT_PENALTY,
  VS_EVENT_FREE_BALL,
  VS_EVENT_GOAL_KICK,
  VS_EVENT_HALF_TIME,
  VS_EVENT_END,
  VS_EVENT_HALT, // from outside: everybody stands still
  VS_EVENT_FREE_KICK,
  VS_EVENT_SENT_OFF,   // a robot of team leaves the field; play goes on
  VS_EVENT_EXTRA_TIME, // a knockout match is tied: extra time begins
  VS_EVENT_SHOOT_OUT,  // team takes its next kick of the shoot-out
  VS_EVENT_KINDS
} vs_event_kind;

typedef struct vs_event {
  vs_event_kind kind;
  vs_team team;  // who scored, who takes the kick; blue where the kind has no team
  int quadrant;  // free ball and goal kick: 1 (+x +y) then counter-clockwise, in the absolute frame; else 0
                 // (a free ball in the middle of the field: 0)
  double time_s; // of the match
} vs_event;

// The match around the world: clock, score, last event. As seen by a team: score[0] is its own and
// last_event.team == VS_BLUE means "ours".
typedef struct vs_game {
  double time_s;     // played so far
  double duration_s; // of the match or training episode
  int score[VS_TEAMS];
  vs_event last_event;
} vs_game;

VSSS_API vs_pose vs_pose_rotate_pi(vs_pose pose);
VSSS_API void vs_world_for_team(const vs_world *absolute, vs_team team, vs_world *view); // its own inverse
VSSS_API void vs_game_for_team(const vs_game *absolute, vs_team team, vs_game *view);

// Where a robot that nobody has seen yet is taken to stand (absolute frame): in a corner of its own half beside its goal
// area, out of play and inside what a policy knows. A team that plays alone meets nobody there.
VSSS_API vs_pose vs_world_parked(vs_division division, vs_team team, int robot);

// Where a robot that was sent off stands: beside the field, out of everybody's reach (absolute frame). The simulator lets no
// wall touch a robot that is further than VS_BESIDE_M from the field.
#define VS_BESIDE_M 0.25
VSSS_API vs_pose vs_world_beside(vs_division division, vs_team team, int robot);

// All numbers finite and within 1 m outside the field; names the first that is not.
VSSS_API vs_status vs_world_check(const vs_world *world, vs_error *err);

// Whether every number is finite, every flag a flag and the time such that it can be reckoned with: false for worlds that
// only a damaged snapshot holds.
VSSS_API bool vs_world_ok(const vs_world *world);

// FNV-1a over the bits of every number (not the padding): equal worlds, equal hash. A division other than 3 against 3 counts too.
VSSS_API uint64_t vs_world_hash(uint64_t hash, const vs_world *world); // start with VS_HASH_START
#define VS_HASH_START UINT64_C(0xcbf29ce484222325)
VSSS_API uint64_t vs_hash_bytes(uint64_t hash, const void *data, unsigned long size);

// Robots a side.
static inline int vs_team_size(const vs_world *world) { return vs_pitch_of(world->division)->team_size; }

VSSS_API const char *vs_event_name(vs_event_kind kind); // "goal", "free ball", ...
VSSS_API const char *vs_team_name(vs_team team);        // "blue", "yellow"

#ifdef __cplusplus
}
#endif
#endif
