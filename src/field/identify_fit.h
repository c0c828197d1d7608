// The robot that explains what a camera saw: the unknowns of vsss/identify.h, and the search for them. Pure.
#ifndef VSSS_FIELD_IDENTIFY_FIT_H
#define VSSS_FIELD_IDENTIFY_FIT_H

#include "vsss/identify.h"

enum { VS_FIT_STRAIGHT, VS_FIT_TURN, VS_FIT_MODES };

// TIGHTNESS: 1 / the gap to the command, in rad/s, at which a motor's torque stops growing; 0: it never does. ROCK: a robot
// that speeds up tips onto its other skid, so that its mark is seen so many metres further ahead for each m/s2.
enum {
  VS_FIT_DELAY,
  VS_FIT_TAU_STRAIGHT,
  VS_FIT_TAU_TURN,
  VS_FIT_GAIN_LEFT,
  VS_FIT_GAIN_RIGHT,
  VS_FIT_TIGHTNESS,
  VS_FIT_ROCK,
  VS_FIT_UNKNOWNS
};

// One sight. Way and angle count from the middle of its span, a stretch of sights without a gap: where a span as a whole
// lies says nothing, so a camera's error of one sight is one row's error and no other's.
typedef struct vs_fit_row {
  double time_s;
  int span;
  double moved[VS_FIT_MODES], expected[VS_FIT_MODES]; // m forward, rad
  double change[VS_FIT_UNKNOWNS][VS_FIT_MODES];       // of what is expected, with each unknown
  bool used;
} vs_fit_row;

typedef struct vs_fit {
  const vs_motion_command *command;
  int commands;
  int64_t zero_us; // time 0 of the rows
  vs_fit_row *row; // in the order of time
  int rows;
  double weight[VS_FIT_MODES]; // 1 / variance; 0: not asked
  bool held[VS_FIT_UNKNOWNS];  // stay as they are
} vs_fit;

// Makes values of a span count from their mean. which: moved or expected.
void vs_fit_centre(vs_fit *fit, bool expected);

// From anywhere to the best unknowns; expectations and changes of these stay in the rows.
void vs_fit_search(vs_fit *fit, double x[VS_FIT_UNKNOWNS]);
// From x on.
void vs_fit_descend(vs_fit *fit, double x[VS_FIT_UNKNOWNS]);

// a: how well the used rows tell each unknown (inverse covariance); b: which way what is left pulls.
void vs_fit_normal_equations(const vs_fit *fit, double a[VS_FIT_UNKNOWNS][VS_FIT_UNKNOWNS], double b[VS_FIT_UNKNOWNS]);

#endif
