// Stable: part of libvsss (deploy/docs/library.md).
//
// Reward: terms first, then the weighted sum (paper, equations 6 to 16). Team view throughout.
//
// Universal terms are the same for the three robots of a team (speed, distance, goal, foul, progress, still), specific ones are
// each robot's own (offence, defence, approach, own distance). A goal or a penalty foul replaces all others, for every
// robot of the team.
#ifndef VSSS_REWARD_H
#define VSSS_REWARD_H

#include "vsss/api.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Terms of the paper first, then the dense individual ones that make learning start (annealed away by the training
// schedule). G is the adversary goal's centre (0.75, 0), O the own goal's (-0.75, 0), d the distance from the ball to G,
// psi(a, b, c) the angle at b between the directions to a and to c (0 where two of the points coincide).
typedef enum vs_reward_term {
  VS_REWARD_SPEED,    // clip((d[t-1] - d[t] - 0.05)/0.14, -1, 1): the 0.05 is inside the division; a still ball -0.357
  VS_REWARD_DISTANCE, // -min(1, smallest team-mate-to-ball distance in m)
  VS_REWARD_OFFENCE,  // psi(robot, ball, G)/pi - 1: 0 with the robot straight behind the ball
  VS_REWARD_DEFENCE,  // psi(ball, robot, O)/pi - 1: 0 with the robot straight between ball and own goal
  VS_REWARD_GOAL,     // (1 + (T-t)/T) when this team scores, minus that when it concedes; t is the event's time
  VS_REWARD_FOUL,     // -1 when this team's foul gave the adversary a penalty
  VS_REWARD_PROGRESS, // (d[t-1] - d[t])/0.14: a potential, what the ball gains it loses on its way back
  VS_REWARD_APPROACH, // this robot's way towards the ball in this decision, m / 0.14, clipped to [-1, 1]
  VS_REWARD_OWN_DISTANCE, // -min(1, this robot's distance to the ball in m)
  VS_REWARD_STILL,        // -1 while the ball moves less than VS_REWARD_STILL_M in a decision
  VS_REWARD_TERMS
} vs_reward_term;

// Way of ball or robot in one decision that counts as full speed: 1.4 m/s x 0.1 s (paper, equation 6).
#define VS_REWARD_STEP_M   0.14
#define VS_REWARD_OFFSET_M 0.05
#define VS_REWARD_GOAL_X_M 0.75
// A ball slower than 0.1 m/s is one that the league's referee calls stuck (VS_LEAGUE_STUCK_MPS).
#define VS_REWARD_STILL_M 0.01

typedef struct vs_reward_weights {
  double weight[VS_REWARD_TERMS];
} vs_reward_weights;

VSSS_API vs_reward_weights vs_reward_paper(void);         // 0.7, 0.1, 0.1, 0.1, goal 10, foul 1, the rest 0
VSSS_API const char *vs_reward_name(vs_reward_term term); // "speed", ... as in logs and settings

// Terms for the three robots of a team for one decision: the true world in team view at its start and at its end (where
// the referee whistled: as it was before any placement), the event that ended it (as seen by the team; NONE or any
// other kind than GOAL and PENALTY leaves the dense terms) and the game.
VSSS_API void vs_reward_terms(const vs_world *previous, const vs_world *view, const vs_event *event,
                              const vs_game *game, double terms[VS_TEAM_SIZE][VS_REWARD_TERMS]);
VSSS_API void vs_reward_sum(const double terms[VS_TEAM_SIZE][VS_REWARD_TERMS], const vs_reward_weights *weights,
                            float reward[VS_TEAM_SIZE]);

#ifdef __cplusplus
}
#endif
#endif
