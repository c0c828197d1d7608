// PY-VSSS-INF (inf:), a rule-based team with three roles, six states and nine tactics, restated from its behaviour.
// Frame: pixels of a 640 x 480 picture, own goal at x = 0, y up; orientation = -heading. Speeds are fractions of 30
// rad/s.
//
// Files: inf.c (the tick, roles, states, the player), inf_tactics.c (which tactic, and robots that
// are stuck), inf_act.c (tactic -> command), inf_control.c (command -> wheels).
#ifndef VSSS_STRATEGIES_INF_H
#define VSSS_STRATEGIES_INF_H

#include "point.h"
#include "vsss/world.h"

typedef enum inf_role { INF_ATTACKER, INF_MIDFIELDER, INF_KEEPER, INF_ROLES } inf_role;
typedef enum inf_phase { INF_ADVANCE, INF_PUSH, INF_RECOVER, INF_PASS, INF_RETURN, INF_DANGER } inf_phase;
typedef enum inf_tactic {
  INF_CATCH,
  INF_SIDE,
  INF_BLOCK,
  INF_OPENING,
  INF_PUSHB,
  INF_SPIN,
  INF_WAIT,
  INF_KICK,
  INF_UNLOCK,
  INF_TACTICS
} inf_tactic;

#define INF_WIDTH_PX       640.0
#define INF_HEIGHT_PX      480.0
#define INF_ROBOT_PX       30.0
#define INF_SPIN_PX        36.0
#define INF_PAST_GOAL_X_PX 696.0
#define INF_MIDDLE_X_PX    320.0
#define INF_MIDDLE_Y_PX    240.0
#define INF_GOAL_LOW_PX    164.5
#define INF_GOAL_HIGH_PX   315.5
#define INF_AREA_LOW_PX    89.5
#define INF_AREA_HIGH_PX   390.5
#define INF_AREA_X_PX      124.0
#define INF_SPEED          0.8
#define INF_SAMPLES        10

typedef enum inf_kind { INF_GOTO, INF_LOOK, INF_TURN } inf_kind;

// Keeps what a tactic does not set.
typedef struct inf_command {
  inf_kind kind;
  vs_point target;
  bool toward_angle; // the orientation is angle_rad, not the point `toward`
  vs_point toward;
  double angle_rad;
  double speed;
  bool clockwise; // INF_TURN
} inf_command;

typedef struct inf_robot {
  vs_point at, before; // now and at the last tick
  double o_rad;        // orientation = -heading
  inf_tactic tactic;
  inf_command command;
  bool locked;              // stands still on purpose
  double timer_s, locked_s; // how long its tactic stays; how long it has been stuck
  int front;                // +1: drives forwards, -1: backwards
  bool has_moved;           // has driven to a target before
} inf_robot;

typedef struct inf_state {
  inf_robot robot[VS_TEAM_SIZE];
  int role[INF_ROLES]; // the robot that holds it
  double role_timer_s;
  inf_phase phase;
  double unlock_sign;
  bool hold; // one call of grace for a robot's direction, shared by all three
  vs_point ball;
  vs_point sample[INF_SAMPLES]; // ball, oldest first
  int samples;
} inf_state;

typedef struct inf_input {
  vs_point ball;
  vs_point at[VS_TEAM_SIZE];
  double o_rad[VS_TEAM_SIZE];
  double dt_s;
} inf_input;

void inf_init(inf_state *s);
void inf_tick(inf_state *s, const inf_input *in, double command[VS_TEAM_SIZE][2] /* left, right, in [-1, 1] */);

bool inf_can_kick(const inf_state *s, int robot);             // inf.c
void inf_choose_tactics(inf_state *s, double dt_s);           // inf_tactics.c
void inf_act(inf_state *s, int robot);                        // inf_act.c
void inf_control(inf_state *s, int robot, double command[2]); // inf_control.c

static inline double inf_ball_distance(const inf_state *s, int robot) {
  return vs_point_distance(s->robot[robot].at, s->ball);
}

#endif
