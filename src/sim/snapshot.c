// Save and restore: exactly what mj_step reads, and the drive's own state, so that play continues bit-identically.
#include "sim_internal.h"

#include <stddef.h>
#include <string.h>

#include "vsss/check.h"

typedef struct snapshot {
  vs_sim_params params;
  uint32_t frame;
  vs_rng push_rng;
  wheel_state wheel[ROBOTS_MOST][SIDES];
  double time;
} snapshot; // followed by qpos, qvel, qacc_warmstart, qfrc_constraint

size_t vs_sim_state_size(const vs_sim *sim) {
  return sizeof(snapshot) + sizeof(double) * (size_t)(sim->mj->nq + 3 * sim->mj->nv);
}

void vs_sim_save(const vs_sim *sim, void *state) {
  snapshot head = {.params = sim->params, .frame = sim->frame, .push_rng = sim->push_rng, .time = sim->data->time};
  memcpy(head.wheel, sim->wheel, sizeof head.wheel);
  memcpy(state, &head, sizeof head);
  char *at = (char *)state + sizeof head;
  size_t nq = sizeof(double) * (size_t)sim->mj->nq, nv = sizeof(double) * (size_t)sim->mj->nv;
  memcpy(at, sim->data->qpos, nq);
  memcpy(at + nq, sim->data->qvel, nv);
  memcpy(at + nq + nv, sim->data->qacc_warmstart, nv);
  memcpy(at + nq + 2 * nv, sim->data->qfrc_constraint, nv);
}

static bool params_ok(const vs_sim_params *p) {
  // All but the seed at the end are doubles; what is divided by is above 0.
  return vs_all_finite((const double *)p, offsetof(vs_sim_params, push_seed) / sizeof(double)) &&
         p->floor_friction_scale > 0.0 && p->robot_mass_scale > 0.0 && p->ball_mass_scale > 0.0 &&
         p->ball_restitution >= 0.0 && p->motor_tau_s >= 0.0 && p->push_per_s >= 0.0;
}

vs_status vs_sim_restore(vs_sim *sim, const void *state, vs_error *err) {
  snapshot head;
  memcpy(&head, state, sizeof head);
  const void *after = (const char *)state + sizeof head;
  const double *numbers = after;
  size_t count = (size_t)(sim->mj->nq + 3 * sim->mj->nv);
  if (!params_ok(&head.params) || !vs_all_finite(&head.time, 1) ||
      !vs_all_finite(&head.wheel[0][0].target_radps, sizeof head.wheel / sizeof(double)) ||
      !vs_all_finite(numbers, count))
    return vs_fail(err, VS_FAIL, "the snapshot of the simulator is damaged");
  vs_sim_reset(sim, &head.params);
  sim->frame = head.frame;
  sim->push_rng = head.push_rng;
  sim->data->time = head.time;
  memcpy(sim->wheel, head.wheel, sizeof head.wheel);
  const char *at = after;
  size_t nq = sizeof(double) * (size_t)sim->mj->nq, nv = sizeof(double) * (size_t)sim->mj->nv;
  memcpy(sim->data->qpos, at, nq);
  memcpy(sim->data->qvel, at + nq, nv);
  memcpy(sim->data->qacc_warmstart, at + nq + nv, nv);
  memcpy(sim->data->qfrc_constraint, at + nq + 2 * nv, nv);
  return VS_OK;
}
