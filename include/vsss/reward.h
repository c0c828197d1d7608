// Reward: terms first, then the weighted sum (paper, equations 6 to 16). Team view throughout.
#ifndef VSSS_REWARD_H
#define VSSS_REWARD_H

#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Every term is of the scale that the weight below expects. Terms of the paper first, then the dense individual ones
// that make learning start (annealed away by the training schedule).
typedef enum vs_reward_term {
  VS_REWARD_SPEED,    // clip((d[t-1] - d[t] - 0.05)/0.14, -1, 1), d = ball to adversary goal centre (0.75, 0)
  VS_REWARD_DISTANCE, // -min(1, smallest team-mate-to-ball distance)
  VS_REWARD_OFFENCE,  // psi/pi - 1 at the ball, robot - ball - their goal, the best of the team or as the paper says
  VS_REWARD_DEFENCE,  // psi/pi - 1 at the robot, ball - robot - own goal
  VS_REWARD_GOAL,     // +-(1 + (T-t)/T) when a goal ends the step; replaces the dense terms
  VS_REWARD_FOUL,     // -1 when this team caused a penalty; replaces the dense terms
  VS_REWARD_PROGRESS, // (d[t-1] - d[t])/0.14, without the offset, clipped to [-1, 1]
  VS_REWARD_APPROACH, // this robot's own progress towards the ball, metres per decision / 0.14, clipped to [-1, 1]
  VS_REWARD_OWN_DISTANCE, // -min(1, this robot's distance to the ball)
  VS_REWARD_TERMS
} vs_reward_term;

typedef struct vs_reward_weights {
  double weight[VS_REWARD_TERMS];
} vs_reward_weights;

vs_reward_weights vs_reward_paper(void); // 0.7, 0.1, 0.1, 0.1, goal 10, foul 1, the rest 0
const char *vs_reward_name(vs_reward_term term);

// Terms for the three robots of a team for one decision: previous and present true world in team view, the event that
// ended it (as seen by the team), game after it.
void vs_reward_terms(const vs_world *previous, const vs_world *view, const vs_event *event, const vs_game *game,
                     double terms[VS_TEAM_SIZE][VS_REWARD_TERMS]);
void vs_reward_sum(const double terms[VS_TEAM_SIZE][VS_REWARD_TERMS], const vs_reward_weights *weights,
                   float reward[VS_TEAM_SIZE]);

#ifdef __cplusplus
}
#endif
#endif
