// The stack of the last eight frames, kept as a ring so that a push copies nothing old.
#include <string.h>

#include "vsss/observe.h"

void vs_observer_init(vs_observer *observer, const int *adversary_order) {
  memset(observer, 0, sizeof *observer);
  for (int k = 0; k < VS_TEAM_SIZE; k++) observer->adversary_order[k] = adversary_order ? adversary_order[k] : k;
}

void vs_observer_restart(vs_observer *observer) { observer->filled = 0; }

void vs_observer_push(vs_observer *observer, const vs_world *view, const vs_game *game, const float *last_action) {
  int at = (observer->newest + 1) % VS_OBS_STACK;
  float(*frame)[VS_TEAM_SIZE][VS_OBS_FRAME] = &observer->frame[at];
  vs_observe_frame(view, game, last_action, observer->adversary_order, &(*frame)[0][0]);
  observer->newest = at;
  if (observer->filled) return;
  for (int k = 0; k < VS_OBS_STACK; k++)
    if (k != at) memcpy(observer->frame[k], *frame, sizeof *frame);
  observer->filled = VS_OBS_STACK;
}

void vs_observer_write(const vs_observer *observer, float *out) {
  int oldest = (observer->newest + 1) % VS_OBS_STACK;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_OBS_STACK; k++, out += VS_OBS_FRAME)
      memcpy(out, observer->frame[(oldest + k) % VS_OBS_STACK][i], VS_OBS_FRAME * sizeof *out);
}
