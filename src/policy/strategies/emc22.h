// VSSS-EMC as of 2022 (emc22:), restated from its behaviour: stronger than the 2019 one, with obstacle avoidance, the
// ball's velocity and the referee's commands. Frame: metres from the lower left corner of a 1.70 x 1.30 m field (goals
// included), own goal at x = 0.
//
// Files: emc22.c (the tick, roles, referee, the player), emc22_behave.c (defender and keeper),
// emc22_attack.c (attacker and its area guard), emc22_control.c (command -> wheels).
#ifndef VSSS_STRATEGIES_EMC22_H
#define VSSS_STRATEGIES_EMC22_H

#include "command.h"
#include "vsss/world.h"

typedef enum emc22_role { EMC22_ATTACKER, EMC22_KEEPER, EMC22_DEFENDER, EMC22_ROLES } emc22_role;
typedef enum emc22_uvf { EMC22_SEEK, EMC22_CLOSE, EMC22_HAS } emc22_uvf;

// The referee's commands. The last two sorts are no fouls: they restart the one-second windows, and nothing else.
typedef enum emc22_foul {
  EMC22_NO_FOUL,
  EMC22_KICKOFF,
  EMC22_PENALTY,
  EMC22_FREE_BALL,
  EMC22_FREE_KICK,
  EMC22_GOAL_KICK,
  EMC22_OTHER // game on, stop, halt
} emc22_foul;

#define EMC22_LENGTH_M   1.70
#define EMC22_WIDTH_M    1.30
#define EMC22_CENTRE_X_M 0.85
#define EMC22_CENTRE_Y_M 0.65
#define EMC22_SPEED_MPS  1.0
#define EMC22_ARRIVAL_M  0.02
#define EMC22_SIZE_M     0.08
#define EMC22_CONTACT_M  0.078

typedef struct emc22_robot {
  vs_point at;
  double theta_rad, omega_radps;
  emc_command command;
  bool spun;           // has had a spin or a stop since it last stood still as keeper
  double wheel_mps[2]; // its last output
} emc22_robot;

typedef struct emc22_state {
  emc22_robot robot[VS_TEAM_SIZE];
  int role[EMC22_ROLES]; // the robot that holds it
  emc22_uvf uvf;         // of the attacker's role
  emc22_foul foul;       // the last one
  bool foul_ours;        // ... which is ours to take
  double command_s;      // when the referee last said anything
  double now_s;
  vs_point ball, velocity_mps;
  vs_point adversary[VS_TEAM_SIZE];
  int adversaries;
  vs_event seen; // the last event that the player has passed on
} emc22_state;

typedef struct emc22_input {
  emc22_foul command; // received just before this tick; EMC22_NO_FOUL: nothing
  bool command_ours;
  double now_s; // the strategy counts from 0, the start of its program
  vs_point ball, velocity_mps;
  vs_point at[VS_TEAM_SIZE];
  double theta_rad[VS_TEAM_SIZE], omega_radps[VS_TEAM_SIZE];
  vs_point adversary[VS_TEAM_SIZE]; // those that are seen
  int adversaries;
} emc22_input;

void emc22_init(emc22_state *s);
void emc22_tick(emc22_state *s, const emc22_input *in, double wheel_mps[VS_TEAM_SIZE][2]);

void emc22_attack(emc22_state *s);  // emc22_attack.c
void emc22_defend(emc22_state *s);  // emc22_behave.c
void emc22_keep(emc22_state *s);    // emc22_behave.c
void emc22_control(emc22_state *s); // emc22_control.c: into robot[].wheel_mps

// Shared by the files above.
bool emc22_fresh(const emc22_state *s);           // within a second of a referee command
bool emc22_penalty_against(const emc22_state *s); // ... which was a penalty against us
vs_point emc22_ball_at(const emc22_state *s, double time_s);
void emc22_spin_kick(emc22_state *s, emc22_robot *r); // spins so that the ball goes towards their goal
void emc22_go_stop(emc22_robot *r, double x, double y);
bool emc22_our_area(vs_point p);
bool emc22_any_goal(vs_point p);

#endif
