// What the files of this module share: the constant model with the addresses of its parts, and one match's state.
#ifndef VSSS_SIM_INTERNAL_H
#define VSSS_SIM_INTERNAL_H

#include <mujoco/mujoco.h>

#include "vsss/rng.h"
#include "vsss/sim.h"

#define ROBOTS     (VS_TEAMS * VS_TEAM_SIZE) // numbered team * VS_TEAM_SIZE + index
#define PAIRS_MOST 256
enum { LEFT, RIGHT, SIDES };

// Addresses into qpos, qvel and ctrl, looked up by name once.
typedef struct robot_address {
  int body;
  int qpos, qvel;        // contact: free joint (7, 6). planar: x, y, yaw joints (3, 3)
  int wheel_qvel[SIDES]; // contact only
  int servo[SIDES];      // contact only
} robot_address;

struct vs_model {
  mjModel *mj;
  vs_drive drive;
  int substeps, frame_hz;
  robot_address robot[ROBOTS];
  int ball_body, ball_qpos, ball_qvel;
  uint32_t pair_bits[PAIRS_MOST]; // nearby.c: what must be near for a contact pair to be worth a test
};

// The planar drive's wheels and what both drives remember of the commands. Plain data.
typedef struct wheel_state {
  double target_radps;        // command after limit, gain, dead zone and lag
  double speed_radps;         // planar only, as all below; the contact drive's wheels are joints
  double along_n, sideways_n; // the floor's friction on it in the last step
} wheel_state;

struct vs_sim {
  const vs_model *model;
  const mjModel *mj;    // model->mj, or own where this episode's masses or frictions are not the nominal ones
  mjModel *own;         // NULL until first needed
  mjModel view;         // mj with only the contact pairs that are near in this step; shares all other arrays with mj
  double *view_numbers; // its pairs
  uint32_t view_bits;
  bool test_all_pairs; // for the test that compares
  mjData *data;
  vs_sim_params params;
  double lag; // share of the way to the commanded speed that target_radps goes in one step; 1: no lag
  uint32_t frame;
  vs_rng push_rng;
  bool out_of_memory; // of the last reset
  wheel_state wheel[ROBOTS][SIDES];
};

// Of the contact laws ball_wall in models/field.xml; ball_robot's is 2/3 of it.
#define NOMINAL_RESTITUTION 0.6

// randomize.c: makes sim->mj fit sim->params. False: out of memory, sim->mj is the nominal model.
bool vs_randomize_apply(vs_sim *sim);

// outline.c: gives MuJoCo our contacts for robots that cannot tilt. Process-wide, before the first step.
void vs_outline_install(void);

// nearby.c
void vs_nearby_bind(vs_model *model);       // at load
bool vs_nearby_new(vs_sim *sim);            // false: out of memory
void vs_nearby_reset(vs_sim *sim);          // after sim->mj changed
const mjModel *vs_nearby_view(vs_sim *sim); // the model to step with from the present positions

#endif
