// VSSS-EMC as of 2019 (emc:), a rule-based team of three roles, restated from its behaviour. Frame: metres from the
// field's lower left corner as the strategy's camera saw it (goals included, 1.62 x 1.26 m), own goal at x = 0.
//
// Files: emc.c (the tick, roles and their swaps, the player), emc_behave.c (what each role does),
// emc_control.c (command -> wheel speeds).
#ifndef VSSS_STRATEGIES_EMC_H
#define VSSS_STRATEGIES_EMC_H

#include "command.h"
#include "vsss/world.h"

typedef enum emc_role_name { EMC_ATTACKER, EMC_DEFENDER, EMC_KEEPER, EMC_ROLES } emc_role_name;
typedef enum emc_uvf { EMC_SEEK, EMC_CLOSE, EMC_HAS } emc_uvf;

#define EMC_CENTRE_X_M 0.81
#define EMC_CENTRE_Y_M 0.63
#define EMC_SPEED_MPS  1.4
#define EMC_CONTACT_M  0.08
#define EMC_SAMPLES    15

typedef struct emc_pid {
  double integral, last_error;
} emc_pid;

// What belongs to a role. A swap exchanges robot (and with it the pose), nothing else.
typedef struct emc_role {
  int robot;
  vs_point at;
  double theta_rad;
  emc_command command;
  emc_pid pid[2]; // left, right
} emc_role;

typedef struct emc_state {
  emc_role role[EMC_ROLES];
  emc_uvf uvf;
  vs_point sample[EMC_SAMPLES]; // ball, oldest first
  vs_point ball;                // of this tick
  vs_point ahead;               // where the ball will be 11 samples on
  double clock_s, swap_s;       // now; the last swap or collision
  bool running;                 // the clock has started
  bool use_pid;
} emc_state;

// Exactly what one tick reads and writes, in the strategy's frame and in robot order.
typedef struct emc_input {
  vs_point ball;
  vs_point at[VS_TEAM_SIZE];
  double theta_rad[VS_TEAM_SIZE];
  double wheel_mps[VS_TEAM_SIZE][2]; // measured: left, right
  double dt_s;
} emc_input;

typedef struct emc_output {
  double target_mps[VS_TEAM_SIZE][2]; // wheel targets, not clipped
  double pid_mps[VS_TEAM_SIZE][2];    // what the wheel PID makes of them, within +-2
} emc_output;

void emc_init(emc_state *s);
void emc_tick(emc_state *s, const emc_input *in, emc_output *out);

// emc_behave.c: keeper, defender, attacker, then the overrides.
void emc_behave(emc_state *s);

// emc_control.c
void emc_control(const emc_role *role, double wheel_mps[2]);
double emc_pid_step(emc_pid *pid, double target_mps, double measured_mps, double dt_s);

// Regions that more than one file asks for.
bool emc_their_corner(vs_point p); // corners beside their area

#endif
