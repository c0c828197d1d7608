// Stable: part of libvsss (deploy/docs/library.md).
//
// The divisions as data: how many robots a team has and how large their field is. What plays any division reads its numbers
// here; what is made for three robots (the policy's contract, our robots, the venue's camera) reads field.h, whose numbers are
// those of VS_3V3. Metres; frames as in field.h.
#ifndef VSSS_DIVISION_H
#define VSSS_DIVISION_H

#include "vsss/api.h"
#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_TEAM_MOST 5 // arrays have room for the largest team

// The numbers are kept in logs and snapshots; a world of zeros is of 3 against 3.
typedef enum vs_division { VS_3V3 = 0, VS_5V5 = 1, VS_DIVISIONS } vs_division;

// 3 against 3: field.h's. 5 against 5: 2.2 x 1.8 m, goal, area, circle and the penalty mark 37.5 cm before the goal line as
// FIRASim's Division A has them (8955749cb4c4), free ball marks at a quarter of the length and a third of the width with robots
// 25 cm from them as VSSReferee draws them (350a378df700); its wider area of 80 x 35 cm is not judged by either. Corners: no
// text gives any but the 7 cm of 3 against 3.
typedef struct vs_pitch {
  const char *name; // "3v3", "5v5"
  int team_size;
  double half_length_m, half_width_m;
  double goal_half_width_m, goal_depth_m;
  double corner_m; // legs of the corner triangles
  double area_depth_m, area_half_width_m;
  double penalty_mark_x_m;
  double free_ball_mark_x_m, free_ball_mark_y_m, free_ball_robot_m; // robot to mark, along x
  double circle_radius_m;
  double goal_kick_x_m, goal_kick_y_m; // the corner of the area, before the goal of who kicks
} vs_pitch;

VSSS_API const vs_pitch *vs_pitch_of(vs_division division); // of one that does not exist: 3 against 3's
VSSS_API vs_status vs_division_parse(const char *name, vs_division *out, vs_error *err); // "3v3", "5v5"

// VS_USAGE where division is not 3 against 3: what cannot play it, and what can. what: "the learned policy", "vsss train".
VSSS_API vs_status vs_division_wants_3v3(vs_division division, const char *what, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
