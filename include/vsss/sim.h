// Stable: part of libvsss (deploy/docs/library.md).
//
// The simulator: MuJoCo with one constant model shared by all matches and one state each. Knows nothing of rules.
//
// MuJoCo keeps its hooks in global variables of the process. This module owns four of them, and sets them once: its error
// and warning handlers when it first calls into MuJoCo (an error comes back as VS_FAIL; nothing is printed), and, when the
// first PLANAR model is loaded, the collision of boxes with planes and boxes in mjCOLLISIONFUNC: geoms that our model marks
// (user="1") get contacts of their own, all others go on to the functions that stood there before. A program that uses
// MuJoCo itself sets its own handlers before, and calls it outside of ours at its own risk of a handler that jumps.
#ifndef VSSS_SIM_H
#define VSSS_SIM_H

#include <stddef.h>

#include "vsss/api.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// CONTACT: free bodies on wheels that roll by friction (the reference). PLANAR: joints x, y, yaw per robot and a
// traction law outside MuJoCo (the fast twin).
typedef enum vs_drive { VS_DRIVE_CONTACT, VS_DRIVE_PLANAR } vs_drive;
VSSS_API const char *vs_drive_name(vs_drive drive); // "contact", "planar"
VSSS_API vs_status vs_drive_parse(const char *name, vs_drive *out, vs_error *err);

VSSS_API const char *vs_mujoco_version(void); // of the library that is running, such as "2.3.2"

typedef struct vs_model vs_model; // constant after loading, shared by threads

typedef struct vs_model_def {
  vs_drive drive;
  vs_division division;   // VS_3V3
  const char *path;       // MJCF; NULL: models/vsss_<drive>.xml, vsss_<drive>_5v5.xml, found by vs_path_find
  int substeps_per_frame; // physics steps per frame; 0: the drive's default
  int frame_hz;           // 0: VS_CAMERA_HZ, as everything above the simulator expects; others for bare simulations
} vs_model_def;

VSSS_API vs_model_def vs_model_def_default(vs_drive drive);
// Loads the MJCF and checks every size against field.h and division.h: a difference is VS_FAIL naming body, value and the expected one.
VSSS_API vs_status vs_model_load(const vs_model_def *def, vs_model **out, vs_error *err);
VSSS_API void vs_model_free(vs_model *model);
VSSS_API double vs_model_step_s(const vs_model *model);
VSSS_API int vs_model_frame_hz(const vs_model *model);
VSSS_API int vs_model_substeps(const vs_model *model);
VSSS_API vs_drive vs_model_drive(const vs_model *model);
VSSS_API vs_division vs_model_division(const vs_model *model);
VSSS_API const void *vs_model_mjmodel(const vs_model *model); // const mjModel *, for the renderer and the benchmarks

// Physical parameters of one episode (domain randomisation); the default is the nominal robot. Rows of robots that the
// model has not count for nothing.
typedef struct vs_sim_params {
  double wheel_gain[VS_TEAMS][VS_TEAM_MOST][2];      // left, right: reached speed / commanded speed; 1
  double wheel_radius_scale[VS_TEAMS][VS_TEAM_MOST]; // 1
  double track_scale[VS_TEAMS][VS_TEAM_MOST];        // 1
  double com_offset_m[VS_TEAMS][VS_TEAM_MOST][2];    // centre of mass off the middle: forward, left (planar:
                                                     // its effect on the wheels' loads only); 0
  double wheel_limit_scale;                          // battery: scales VS_WHEEL_LIMIT_RADPS; 1
  double motor_tau_s;                                // extra first-order lag of the wheel command; 0 = none
  double dead_zone_radps;                            // commands below this do nothing; 0
  double floor_friction_scale;                       // 1
  double robot_mass_scale;                           // 1
  double ball_mass_scale, ball_rolling_scale;        // 1, 1
  double ball_restitution;                           // at walls, and 2/3 of it at robots; 0.6
  double accelerate_mps2, brake_mps2;                // bounds of a wheel's rim speed, away from and towards 0; 0: none
  double servo_scale;                                // of the servo's gain and torque limit; 1
  double push_per_s, push_mps; // random shoves: how often each robot gets one, and its largest change of velocity; 0, 0
  uint64_t push_seed;
} vs_sim_params;
VSSS_API vs_sim_params vs_sim_params_default(void);

typedef struct vs_sim vs_sim; // one match's state
VSSS_API vs_status vs_sim_new(const vs_model *model, vs_sim **out, vs_error *err);
VSSS_API void vs_sim_free(vs_sim *sim);
VSSS_API void
vs_sim_reset(vs_sim *sim, const vs_sim_params *params /* NULL: default */); // time 0, everything at rest, kick-off line
// Puts robots and ball where world (of the model's division) says, robots at rest, wheels stopped, the ball rolling as fast as world says. Time goes on. No allocation, under 50 us.
VSSS_API void vs_sim_place(vs_sim *sim, const vs_world *world);
// Puts one robot at rest beside the field, where it touches no wall (vs_world_beside); nothing else changes.
VSSS_API void vs_sim_put_beside(vs_sim *sim, vs_team team, int robot);
// One frame (1/30 s, or the model's) with the commands held. VS_FAIL: MuJoCo reported a warning (NaN, too many contacts), by name.
VSSS_API vs_status vs_sim_frame(vs_sim *sim, const vs_wheels command[VS_TEAMS][VS_TEAM_MOST], vs_error *err);
VSSS_API void vs_sim_world(const vs_sim *sim, vs_world *out); // the truth
VSSS_API void *vs_sim_mjdata(vs_sim *sim);                    // mjData *, for the renderer

VSSS_API size_t vs_sim_state_size(const vs_sim *sim);
VSSS_API void vs_sim_save(const vs_sim *sim, void *state);
// Continues bit-identically. VS_FAIL: a number that cannot be; the simulator is then as it was.
VSSS_API vs_status vs_sim_restore(vs_sim *sim, const void *state, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
