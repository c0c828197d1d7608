// A scene for the tests of EMC-2022: robots 0, 1, 2 are attacker, keeper, defender; the referee has said nothing for a
// long time. A position left out takes its default.
#ifndef VSSS_TESTS_POLICY_EMC22_SCENE_H
#define VSSS_TESTS_POLICY_EMC22_SCENE_H

#include "commands.h"
#include "policy/strategies/emc22.h"

#define STORED_X 0.85 // target of everybody's last command
#define STORED_Y 0.65

typedef struct scene {
  vs_point ball, velocity;
  vs_point attacker, keeper, defender; // (1.0, 0.65), (0.5, 0.65), (0.6, 0.4)
  vs_point adversary[VS_TEAM_SIZE];
  int adversaries;
  emc22_foul foul;
  bool ours, fresh; // ... within a second
} scene;

static inline vs_point or_else(vs_point p, double x, double y) { return p.x == 0 && p.y == 0 ? (vs_point){x, y} : p; }

static inline emc22_state scene_state(const scene *c) {
  emc22_state s;
  emc22_init(&s);
  s.now_s = 100;
  s.command_s = c->fresh ? 99.5 : 98.5;
  s.foul = c->foul;
  s.foul_ours = c->ours;
  s.ball = c->ball;
  s.velocity_mps = c->velocity;
  s.robot[0].at = or_else(c->attacker, 1.0, 0.65);
  s.robot[1].at = or_else(c->keeper, 0.5, 0.65);
  s.robot[2].at = or_else(c->defender, 0.6, 0.4);
  s.adversaries = c->adversaries;
  for (int i = 0; i < c->adversaries; i++) s.adversary[i] = c->adversary[i];
  for (int i = 0; i < VS_TEAM_SIZE; i++) s.robot[i].command.target = (vs_point){STORED_X, STORED_Y};
  return s;
}

#define STORED ((vs_point){STORED_X, STORED_Y})

#endif
