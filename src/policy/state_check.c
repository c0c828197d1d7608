// Whether a snapshot of a built-in player holds what its code can go on from: indices and enumerations in their ranges.
// Other numbers only lead to other wheel speeds, which policy.c checks.
#include "policy_internal.h"
#include "policy/strategies/emc.h"
#include "policy/strategies/emc22.h"
#include "policy/strategies/inf.h"
#include "vsss/check.h"

// As integers: an enumeration of any value may be read so.
static bool in(int number, int first, int last) { return number >= first && number <= last; }

static bool command_ok(const emc_command *c) { return in((int)c->kind, EMC_NONE, EMC_SPIN); }

static bool emc_ok(const void *state) {
  const emc_state *s = state;
  int robot[EMC_ROLES];
  bool ok = in((int)s->uvf, EMC_SEEK, EMC_HAS) && vs_are_bools(&s->running, 1) && vs_are_bools(&s->use_pid, 1);
  for (int r = 0; r < EMC_ROLES; r++) {
    robot[r] = s->role[r].robot;
    ok &= command_ok(&s->role[r].command);
  }
  return ok && vs_is_permutation(robot, EMC_ROLES);
}

static bool inf_ok(const void *state) {
  const inf_state *s = state;
  bool ok = vs_is_permutation(s->role, INF_ROLES) && in((int)s->phase, INF_ADVANCE, INF_DANGER) &&
            in(s->samples, 0, INF_SAMPLES) && vs_are_bools(&s->hold, 1);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const inf_robot *r = &s->robot[i];
    ok &= in((int)r->tactic, 0, INF_TACTICS - 1) && in((int)r->command.kind, INF_GOTO, INF_TURN) &&
          vs_are_bools(&r->command.toward_angle, 1) && vs_are_bools(&r->command.clockwise, 1) &&
          vs_are_bools(&r->locked, 1) && vs_are_bools(&r->has_moved, 1) && in(r->front, -1, 1);
  }
  return ok;
}

static bool emc22_ok(const void *state) {
  const emc22_state *s = state;
  bool ok = vs_is_permutation(s->role, EMC22_ROLES) && in((int)s->uvf, EMC22_SEEK, EMC22_HAS) &&
            in((int)s->foul, EMC22_NO_FOUL, EMC22_OTHER) && vs_are_bools(&s->foul_ours, 1) &&
            in(s->adversaries, 0, VS_TEAM_SIZE) && in((int)s->seen.kind, 0, VS_EVENT_KINDS - 1) &&
            in((int)s->seen.team, VS_BLUE, VS_YELLOW) && in(s->seen.quadrant, 0, 4);
  for (int i = 0; i < VS_TEAM_SIZE; i++) ok &= command_ok(&s->robot[i].command) && vs_are_bools(&s->robot[i].spun, 1);
  return ok;
}

bool vs_player_state_ok(const vsss_player_api *api, const void *state) {
  if (api == &vs_player_emc) return emc_ok(state);
  if (api == &vs_player_inf) return inf_ok(state);
  if (api == &vs_player_emc22) return emc22_ok(state);
  return true; // random: and zero: take any; a plugin sees to itself
}
