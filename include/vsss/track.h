// Detections of one frame after the other -> the world: pixels to metres, one constant-velocity Kalman filter per
// object with real time steps from the capture stamps. A lost object is predicted for VS_TRACK_HOLD_US, then marked
// invalid: its last place stays readable, but nothing is ever passed on as fresh that is not.
#ifndef VSSS_TRACK_H
#define VSSS_TRACK_H

#include "vsss/calib.h"
#include "vsss/detect.h"
#include "vsss/field.h"
#include "vsss/kalman.h"
#include "vsss/unseen.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_TRACK_HOLD_US VS_UNSEEN_HOLD_US

typedef struct vs_track_def {
  vs_team team;       // ours: the robots with tags
  bool attack_plus_x; // ours attacks +x of the calibration's frame. The world is given in the absolute frame (world.h)
  vs_mark own, their; // what the teams wear: as in vs_detector_def
  int tag_id[VS_TEAM_SIZE];             // AprilTag of own robot 0, 1, 2; -1: not on the field
  int aruco_id[VS_TEAMS][VS_TEAM_SIZE]; // ArUco mark of robot 0, 1, 2: vs_aruco_league_id
  int plate_id[VS_TEAMS][VS_TEAM_SIZE]; // colour plate, by vs_plate_code
  double tag_yaw_rad[VS_TEAM_SIZE];     // from the robot's front to the pattern's top edge, counter-clockwise
  double tag_height_m;                  // VS_ROBOT_HEIGHT_M
  double patch_height_m;                // of the adversaries: VS_ROBOT_HEIGHT_M
  double ball_height_m;                 // of the point the blob's centre shows: VS_BALL_RADIUS_M
  double margin_m;                      // things further outside the field are not on it: 0.10
  double robot_acceleration_mps2, ball_acceleration_mps2, turn_acceleration_radps2; // deviations of the model
  double position_noise_m, ball_noise_m, patch_noise_m, heading_noise_rad;          // deviations of a measurement
} vs_track_def;
vs_track_def vs_track_def_default(void); // blue, attacks +x, tags 0 1 2

typedef struct vs_object {
  bool seen;       // since the start or the last restart
  bool ever;       // since the start; before it a robot is where vs_world_parked says
  int64_t seen_us; // capture time of the last measurement taken in
  int64_t time_us; // the filters are predicted to here
  vs_kalman x, y, theta;
  int outliers;                // measurements in a row that the gate refused
  double outlier_x, outlier_y; // the last of them: two that agree move the track
} vs_object;

// What happened to the measurements: counts since the start.
typedef struct vs_track_stats {
  uint64_t frames, lost[VS_TEAMS][VS_TEAM_SIZE], ball_lost; // frames in which the object was not measured
  uint64_t refused;                                         // measurements off the field or beyond the gate
  uint64_t late;                                            // frames not newer than the one before: ignored
} vs_track_stats;

// Plain data: a copy is a snapshot. robot[VS_OWN] by tag; robot[VS_ADVERSARY] by mark, too, where they wear one, then with
// its heading, else by slot.
typedef struct vs_tracker {
  vs_track_def def;
  vs_object robot[VS_TEAMS][VS_TEAM_SIZE];
  vs_object ball;
  int64_t time_us;
  uint32_t seq;
  vs_track_stats stats;
} vs_tracker;

void vs_track_init(vs_tracker *tracker, const vs_track_def *def);
// After robots were placed by hand or by the referee: the next sight of each is taken as it is.
void vs_track_restart(vs_tracker *tracker);
// Takes one frame in. The world (at the frame's capture time, absolute frame) is read with vs_track_world.
void vs_track_update(vs_tracker *tracker, const vs_calib *calib, const vs_detections *seen);
// The world predicted to time_us (0: the newest frame's). Objects not seen for VS_TRACK_HOLD_US before it are invalid.
void vs_track_world(const vs_tracker *tracker, int64_t time_us, vs_world *out);

#ifdef __cplusplus
}
#endif
#endif
