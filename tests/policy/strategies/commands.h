// What a row of a behaviour table wants of a robot's command. Frame and units of command.h.
#ifndef VSSS_TESTS_POLICY_COMMANDS_H
#define VSSS_TESTS_POLICY_COMMANDS_H

#include "assert_near.h"
#include "policy/strategies/command.h"
#include "rows.h"

typedef struct wanted {
  emc_kind kind;
  vs_point target;
  double angle_rad, speed_mps, spin_radps;
  bool new_target; // else the stored target is the old one
  bool at_target;  // the angle is the one from the robot to the target
} wanted;

#define SPINS(radps)                                                                                                   \
  { .kind = EMC_SPIN, .spin_radps = (radps) }
#define STOPS SPINS(0)
#define GOES(x_m, y_m, mps)                                                                                            \
  { .kind = EMC_POSITION, .target = {x_m, y_m}, .speed_mps = (mps), .new_target = true }
#define DRIVES(x_m, y_m, mps)                                                                                          \
  { .kind = EMC_VECTOR, .target = {x_m, y_m}, .speed_mps = (mps), .new_target = true, .at_target = true }
#define HEADS(rad, mps)                                                                                                \
  { .kind = EMC_VECTOR, .angle_rad = (rad), .speed_mps = (mps) }
#define FACES(rad, mps)                                                                                                \
  { .kind = EMC_ORIENTATION, .angle_rad = (rad), .speed_mps = (mps) }
#define ARRIVES(x_m, y_m, rad, mps)                                                                                    \
  { .kind = EMC_UVF, .target = {x_m, y_m}, .angle_rad = (rad), .speed_mps = (mps), .new_target = true }

static inline void assert_command(const emc_command *c, const wanted *w, vs_point robot, vs_point old_target) {
  assert_int_equal(c->kind, w->kind);
  vs_point target = w->new_target ? w->target : old_target;
  assert_near(c->target.x, target.x, 1e-12);
  assert_near(c->target.y, target.y, 1e-12);
  assert_near(c->speed_mps, w->speed_mps, 1e-12);
  if (w->kind == EMC_SPIN) assert_near(c->spin_radps, w->spin_radps, 0);
  if (w->kind == EMC_ORIENTATION || w->kind == EMC_UVF) assert_near(c->angle_rad, w->angle_rad, 1e-12);
  if (w->kind == EMC_VECTOR)
    assert_near(c->angle_rad, w->at_target ? atan2(target.y - robot.y, target.x - robot.x) : w->angle_rad, 1e-12);
}

#endif
