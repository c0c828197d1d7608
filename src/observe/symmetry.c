// The 24 versions of an observation that mirror image and numbering make, the canonical one among them, and the view from
// a robot's other end.
#include <string.h>

#include "vsss/observe.h"

// Order k of the adversaries shows in place i the one numbered order[k][i]; the number of an order is
// 2 * (first one's number) + (the second one's number is above the third's).
static const int order[6][VS_TEAM_SIZE] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

typedef struct version {
  int mirrored, exchanged;
  const int *adversary;
} version;

static void plain(vs_symmetry_table *t, int s, int at, int from) { t->index[s][at] = from; }

static void pair(vs_symmetry_table *t, int s, const version *v, int at, int from) { // x, y
  t->index[s][at] = from;
  t->index[s][at + 1] = from + 1;
  if (v->mirrored) t->sign[s][at + 1] = -1;
}

static void triplet(vs_symmetry_table *t, int s, const version *v, int at, int from) { // sin, cos, angle/pi
  for (int k = 0; k < 3; k++) t->index[s][at + k] = from + k;
  if (v->mirrored) t->sign[s][at] = t->sign[s][at + 2] = -1;
}

static void wheels(vs_symmetry_table *t, int s, const version *v, int at, int from) { // left, right
  t->index[s][at] = from + v->mirrored;
  t->index[s][at + 1] = from + !v->mirrored;
}

static void fill(vs_symmetry_table *t, int s, const version *v) {
  for (int k = 0; k < VS_OBS_FRAME; k++) t->sign[s][k] = 1;
  pair(t, s, v, VS_OBS_OWN_XY, VS_OBS_OWN_XY);
  pair(t, s, v, VS_OBS_BALL_XY, VS_OBS_BALL_XY);
  triplet(t, s, v, VS_OBS_OWN_HEADING, VS_OBS_OWN_HEADING);
  for (int k = 0; k < 3; k++) triplet(t, s, v, VS_OBS_ANGLES + 3 * k, VS_OBS_ANGLES + 3 * k); // ball, goals to ball
  plain(t, s, VS_OBS_OWN_BALL_DISTANCE, VS_OBS_OWN_BALL_DISTANCE);
  for (int k = 0; k < 2; k++) plain(t, s, VS_OBS_BALL_GOAL_DISTANCES + k, VS_OBS_BALL_GOAL_DISTANCES + k);
  wheels(t, s, v, VS_OBS_OWN_ACTION, VS_OBS_OWN_ACTION);
  plain(t, s, VS_OBS_TIME_LEFT, VS_OBS_TIME_LEFT);
  for (int k = 0; k < VS_TEAM_SIZE - 1; k++) {
    int from = v->exchanged ? 1 - k : k;
    pair(t, s, v, VS_OBS_ALLIES_XY + 2 * k, VS_OBS_ALLIES_XY + 2 * from);
    triplet(t, s, v, VS_OBS_ANGLES + 9 + 3 * k, VS_OBS_ANGLES + 9 + 3 * from);
    plain(t, s, VS_OBS_ALLIES_BALL_DISTANCE + k, VS_OBS_ALLIES_BALL_DISTANCE + from);
    plain(t, s, VS_OBS_ALLIES_DISTANCE + k, VS_OBS_ALLIES_DISTANCE + from);
    wheels(t, s, v, VS_OBS_ALLIES_ACTION + 2 * k, VS_OBS_ALLIES_ACTION + 2 * from);
  }
  for (int k = 0; k < VS_TEAM_SIZE; k++) {
    int from = v->adversary[k];
    pair(t, s, v, VS_OBS_ADVERSARIES_XY + 2 * k, VS_OBS_ADVERSARIES_XY + 2 * from);
    triplet(t, s, v, VS_OBS_ANGLES + 15 + 3 * k, VS_OBS_ANGLES + 15 + 3 * from);
    plain(t, s, VS_OBS_ADVERSARIES_DISTANCE + k, VS_OBS_ADVERSARIES_DISTANCE + from);
  }
}

void vs_symmetry_table_init(vs_symmetry_table *table) {
  for (int s = 0; s < VS_SYMMETRIES; s++) {
    const version v = {s / 12, s / 6 % 2, order[s % 6]};
    fill(table, s, &v);
  }
}

int vs_symmetry_canonical(const float *observation) {
  const float *frame = observation + VS_OBS_SIZE - VS_OBS_FRAME, *d = frame + VS_OBS_ADVERSARIES_DISTANCE;
  int mirrored = frame[VS_OBS_BALL_XY + 1] < 0;
  int exchanged = frame[VS_OBS_ALLIES_BALL_DISTANCE] > frame[VS_OBS_ALLIES_BALL_DISTANCE + 1];
  // The nearest adversary; of equals the one with the lower number.
  int first = d[0] <= d[1] && d[0] <= d[2] ? 0 : d[1] <= d[2] ? 1 : 2;
  int low = first == 0, high = first == 2 ? 1 : 2; // the other two
  return (mirrored * 2 + exchanged) * 6 + 2 * first + (d[low] > d[high]);
}

void vs_symmetry_apply(const vs_symmetry_table *table, int version, const float *observation, float *out) {
  const int *index = table->index[version];
  const float *sign = table->sign[version];
  for (int frame = 0; frame < VS_OBS_STACK; frame++, observation += VS_OBS_FRAME, out += VS_OBS_FRAME)
    for (int k = 0; k < VS_OBS_FRAME; k++) out[k] = sign[k] * observation[index[k]];
}

int vs_observation_faces_back(const float *observation) {
  return observation[VS_OBS_SIZE - VS_OBS_FRAME + VS_OBS_OWN_HEADING + 1] < 0;
}

void vs_observation_reverse(const float *observation, float *out) {
  memcpy(out, observation, VS_OBS_SIZE * sizeof *out);
  for (int frame = 0; frame < VS_OBS_STACK; frame++, observation += VS_OBS_FRAME, out += VS_OBS_FRAME) {
    const float *heading = observation + VS_OBS_OWN_HEADING, *action = observation + VS_OBS_OWN_ACTION;
    out[VS_OBS_OWN_HEADING] = -heading[0];
    out[VS_OBS_OWN_HEADING + 1] = -heading[1];
    out[VS_OBS_OWN_HEADING + 2] = heading[2] > 0 ? heading[2] - 1 : heading[2] + 1;
    out[VS_OBS_OWN_ACTION] = -action[1];
    out[VS_OBS_OWN_ACTION + 1] = -action[0];
  }
}
