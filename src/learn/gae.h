// Generalised advantage estimation (Schulman et al. 2016; paper, equations 3 and 4).
#ifndef VSSS_LEARN_GAE_H
#define VSSS_LEARN_GAE_H

#include <stdint.h>

// How a transition ended.
enum { VS_GOES_ON = 0, VS_ENDED = 1, VS_CUT = 2 };

// steps x rows transitions, step-major. value [steps + 1][rows]: the last row is of the state after the last step. end
// [steps][rows]: VS_ENDED, nothing follows (a goal); VS_CUT, the clock cut the episode short and cut_value [steps][rows]
// estimates what would have followed (read only there); else the next step's value follows. No advantage flows back
// over an end or a cut. Writes advantage and target (= advantage + value) [steps][rows].
void vs_gae(int steps, int rows, double gamma, double lambda, const float *reward, const float *value,
            const uint8_t *end, const float *cut_value, float *advantage, float *target);

#endif
