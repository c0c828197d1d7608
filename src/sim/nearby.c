// Which of the model's contact pairs can touch at all in this step. MuJoCo tests every listed pair in every step, a
// quarter of the planar drive's time; here flat distances switch off whatever is out of reach, exactly: play is bit for
// bit the same with all pairs tested (tests/sim/test_nearby.c).
#include "sim_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/field.h"

// A robot's hull lies within this of its place on the floor: half its diagonal, 5.7 cm, and 2.5 cm for tilting in a crash.
#define ROBOT_REACH_M (0.057 + 0.025)
#define BALL_REACH_M  (VS_BALL_RADIUS_M + 0.002)
#define BODIES_MOST   (ROBOTS_MOST + 1)   // the ball is last: 11 bodies, 55 couples
#define ALWAYS        (UINT32_C(1) << 31) // a bit of `walls` that no body has: pairs that are always near

static const near_bits everything = {UINT32_MAX, UINT64_MAX};

static int couple_bit(int a, int b) {
  int low = a < b ? a : b, high = a < b ? b : a;
  return high * (high - 1) / 2 + low;
}

static int body_index(const vs_model *model, int body) {
  for (int i = 0; i < model->robots; i++) {
    if (model->robot[i].body == body) return i;
  }
  return body == model->ball_body ? model->robots : -1;
}

// Floor and lid are always near, so are bodies that this file does not follow (wheels).
void vs_nearby_bind(vs_model *model) {
  const mjModel *mj = model->mj;
  int floor = mj_name2id(mj, mjOBJ_GEOM, "floor"), lid = mj_name2id(mj, mjOBJ_GEOM, "lid");
  for (int pair = 0; pair < mj->npair; pair++) {
    int geom[2] = {mj->pair_geom1[pair], mj->pair_geom2[pair]}, body[2];
    for (int k = 0; k < 2; k++) body[k] = body_index(model, mj->geom_bodyid[geom[k]]);
    bool of_world = mj->geom_bodyid[geom[0]] == 0 || mj->geom_bodyid[geom[1]] == 0;
    int moving = body[0] >= 0 ? body[0] : body[1];
    near_bits bits = everything;
    if (body[0] >= 0 && body[1] >= 0) {
      bits = (near_bits){0, UINT64_C(1) << couple_bit(body[0], body[1])};
    } else if (of_world && moving >= 0 && geom[0] != floor && geom[1] != floor && geom[0] != lid && geom[1] != lid) {
      bits = (near_bits){UINT32_C(1) << moving, 0};
    }
    model->pair_bits[pair] = bits;
  }
}

// The pairs of sim->mj whose bits are set, copied together for MuJoCo's loop over them.
static void select_pairs(vs_sim *sim, near_bits bits) {
  const mjModel *from = sim->mj;
  mjModel *to = &sim->view;
  int n = 0;
  for (int pair = 0; pair < from->npair; pair++) {
    const near_bits *needs = &sim->model->pair_bits[pair];
    if (!(needs->walls & bits.walls) && !(needs->couples & bits.couples)) continue;
    to->pair_dim[n] = from->pair_dim[pair];
    to->pair_geom1[n] = from->pair_geom1[pair];
    to->pair_geom2[n] = from->pair_geom2[pair];
    to->pair_signature[n] = from->pair_signature[pair];
    to->pair_margin[n] = from->pair_margin[pair];
    to->pair_gap[n] = from->pair_gap[pair];
    memcpy(to->pair_solref + n * mjNREF, from->pair_solref + pair * mjNREF, sizeof(double) * mjNREF);
    memcpy(to->pair_solimp + n * mjNIMP, from->pair_solimp + pair * mjNIMP, sizeof(double) * mjNIMP);
    memcpy(to->pair_friction + n * 5, from->pair_friction + pair * 5, sizeof(double) * 5);
    n++;
  }
  to->npair = n;
  sim->view_bits = bits;
}

bool vs_nearby_new(vs_sim *sim) {
  size_t pairs = (size_t)sim->model->mj->npair;
  sim->view_numbers = calloc(pairs, sizeof(double) * (mjNREF + mjNIMP + 2 + 5) + sizeof(int) * 4);
  return sim->view_numbers != NULL;
}

void vs_nearby_reset(vs_sim *sim) {
  size_t pairs = (size_t)sim->mj->npair;
  mjModel *view = &sim->view;
  *view = *sim->mj;
  view->pair_solref = sim->view_numbers;
  view->pair_solimp = view->pair_solref + pairs * mjNREF;
  view->pair_margin = view->pair_solimp + pairs * mjNIMP;
  view->pair_gap = view->pair_margin + pairs;
  view->pair_friction = view->pair_gap + pairs;
  view->pair_dim = (int *)(view->pair_friction + pairs * 5);
  view->pair_geom1 = view->pair_dim + pairs;
  view->pair_geom2 = view->pair_geom1 + pairs;
  view->pair_signature = view->pair_geom2 + pairs;
  select_pairs(sim, everything);
}

// Walls are half spaces: who stands there for good was sent off.
static bool beside(const vs_pitch *field, double x, double y) {
  return fabs(x) > field->half_length_m + VS_BESIDE_M || fabs(y) > field->half_width_m + VS_BESIDE_M;
}

static bool near_wall(const vs_pitch *field, double x, double y, double reach) {
  double ax = fabs(x), ay = fabs(y);
  // The corner triangle's side, in 3 against 3: x + y = 0.75 + 0.65 - 0.07.
  double corner = field->half_length_m + field->half_width_m - field->corner_m;
  return ax > field->half_length_m - reach || ay > field->half_width_m - reach || ax + ay > corner - 1.4143 * reach;
}

const mjModel *vs_nearby_view(vs_sim *sim) {
  const vs_model *model = sim->model;
  const int ball = model->robots;
  double x[BODIES_MOST], y[BODIES_MOST], reach[BODIES_MOST];
  near_bits bits = {ALWAYS, 0};
  for (int i = 0; i <= ball; i++) {
    const double *place = sim->data->qpos + (i == ball ? model->ball_qpos : model->robot[i].qpos);
    x[i] = place[0];
    y[i] = place[1];
    reach[i] = i == ball ? BALL_REACH_M : ROBOT_REACH_M;
    if (near_wall(model->field, x[i], y[i], reach[i]) && (i == ball || !beside(model->field, x[i], y[i])))
      bits.walls |= UINT32_C(1) << i;
    for (int k = 0; k < i; k++) {
      double dx = x[i] - x[k], dy = y[i] - y[k], both = reach[i] + reach[k];
      if (dx * dx + dy * dy < both * both) bits.couples |= UINT64_C(1) << couple_bit(i, k);
    }
  }
  if (sim->test_all_pairs) bits = everything;
  if (bits.walls != sim->view_bits.walls || bits.couples != sim->view_bits.couples) select_pairs(sim, bits);
  return &sim->view;
}
