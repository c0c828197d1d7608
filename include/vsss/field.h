// Stable: part of libvsss (deploy/docs/library.md).
//
// Sizes of the 3 against 3 field (others: division.h), ball and robot (paper, Table 1 and section VI; IEEE VSSS rules 2008).
// The nominal robot's servo and the ball's rolling are the simulator's (src/sim/drive.h says whence).
// Origin in the field's centre, x towards the goal that blue attacks, y to blue's left, z up. Metres, kilograms.
#ifndef VSSS_FIELD_H
#define VSSS_FIELD_H

#define VS_FIELD_HALF_LENGTH_M 0.75
#define VS_FIELD_HALF_WIDTH_M  0.65
#define VS_WALL_HEIGHT_M       0.05
#define VS_GOAL_HALF_WIDTH_M   0.20
#define VS_GOAL_DEPTH_M        0.10
#define VS_CORNER_M            0.07 // legs of the corner triangles
#define VS_AREA_DEPTH_M        0.15
#define VS_AREA_HALF_WIDTH_M   0.35
#define VS_PENALTY_MARK_X_M    0.375
#define VS_FREE_BALL_MARK_X_M  0.375
#define VS_FREE_BALL_MARK_Y_M  0.40
#define VS_FREE_BALL_ROBOT_M   0.20 // robot to mark, along x
#define VS_CIRCLE_RADIUS_M     0.20
#define VS_GOAL_KICK_X_M       0.60
#define VS_GOAL_KICK_Y_M       0.35

#define VS_BALL_RADIUS_M 0.02135
#define VS_BALL_MASS_KG  0.046

#define VS_ROBOT_SIZE_M      0.08
#define VS_ROBOT_HEIGHT_M    0.08  // top of the cap over the floor
#define VS_ROBOT_MASS_KG     0.425 // block 396 g, four slabs and the cap 1 g each, two wheels 12 g each
#define VS_WHEEL_RADIUS_M    0.03
#define VS_WHEEL_WIDTH_M     0.006
#define VS_HALF_TRACK_M      0.035
#define VS_WHEEL_LIMIT_RADPS 46.66 // 1.4 m/s at the rim (paper, section VI)

#define VS_BALL_DECELERATION_MPS2 0.20 // rolling

// Each wheel's torque is the gain times (command - speed), within the limit.
#define VS_SERVO_GAIN_NMSPRAD 3.94e-3
#define VS_SERVO_LIMIT_NM     0.0303
#define VS_SERVO_TAU_S        0.055 // what comes of it within 0.23 m/s of the command, going straight

#endif
