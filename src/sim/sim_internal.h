// What the files of this module share: the constant model with the addresses of its parts, and one match's state.
#ifndef VSSS_SIM_INTERNAL_H
#define VSSS_SIM_INTERNAL_H

#include <mujoco/mujoco.h>

#include "vsss/rng.h"
#include "vsss/sim.h"

#define ROBOTS_MOST (VS_TEAMS * VS_TEAM_MOST)
#define PAIRS_MOST  256
enum { LEFT, RIGHT, SIDES };

// Addresses into qpos, qvel and ctrl, looked up by name once.
typedef struct robot_address {
  int body;
  int qpos, qvel;        // contact: free joint (7, 6). planar: x, y, yaw joints (3, 3)
  int wheel_qvel[SIDES]; // contact only
  int servo[SIDES];      // contact only
} robot_address;

// nearby.c: sets of what is near: one bit per body for "near a wall", one per couple of bodies for "near each other".
typedef struct near_bits {
  uint32_t walls;
  uint64_t couples;
} near_bits;

struct vs_model {
  mjModel *mj;
  vs_drive drive;
  int substeps, frame_hz;
  vs_division division;
  const vs_pitch *field; // of the division
  int robots;            // of both teams, numbered team * team_size + index
  robot_address robot[ROBOTS_MOST];
  int ball_body, ball_qpos, ball_qvel;
  near_bits pair_bits[PAIRS_MOST]; // what must be near for a contact pair to be worth a test
};

static inline int team_of(const vs_model *model, int robot) { return robot / model->field->team_size; }
static inline int index_in_team(const vs_model *model, int robot) { return robot % model->field->team_size; }

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
  near_bits view_bits;
  bool test_all_pairs; // for the test that compares
  mjData *data;
  vs_sim_params params;
  double lag; // share of the way to the commanded speed that target_radps goes in one step; 1: no lag
  uint32_t frame;
  vs_rng push_rng;
  bool out_of_memory; // of the last reset
  wheel_state wheel[ROBOTS_MOST][SIDES];
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
