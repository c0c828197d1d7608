#include "vsss/safety.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

// One transition: from any state of the set `from`, where all conditions of `if_all` hold and none of `if_none`. The
// first row that fits is taken, and the last always fits.
typedef struct row {
  unsigned from;
  unsigned if_all, if_none;
  vs_safety_state to;
} row;

#define IN(state) (1u << VS_SAFETY_##state)
#define IF(what)  VS_SAFETY_IF_##what
#define ANY       ((1u << VS_SAFETY_STATES) - 1)

static const row table[] = {
    // clang-format off
    {ANY,          IF(SHUTDOWN), 0,          VS_SAFETY_SHUTDOWN},
    {IN(SHUTDOWN), 0,            0,          VS_SAFETY_SHUTDOWN},
    {ANY,          0,            IF(ARMED),  VS_SAFETY_UNARMED},
    {IN(FAULT),    0,            0,          VS_SAFETY_FAULT},
    {ANY,          0,            IF(SANE),   VS_SAFETY_FAULT},
    {ANY,          IF(HALTED),   0,          VS_SAFETY_HALTED},
    {ANY,          0,            IF(CAMERA), VS_SAFETY_DARK},
    {ANY,          0,            IF(SEEN),   VS_SAFETY_BLIND},
    {ANY,          0,            IF(BALL),   VS_SAFETY_NO_BALL},
    {ANY,          0,            IF(PLAYER), VS_SAFETY_MINDLESS},
    {ANY,          0,            IF(FRESH),  VS_SAFETY_STALE},
    {ANY,          0,            0,          VS_SAFETY_RUNNING},
    // clang-format on
};

vs_safety_state vs_safety_next(vs_safety_state state, unsigned conditions) {
  const row *r = table;
  while (!((r->from >> state & 1) && (conditions & r->if_all) == r->if_all && !(conditions & r->if_none))) r++;
  return r->to;
}

void vs_safety_init(vs_safety *safety, int64_t now_us) {
  memset(safety, 0, sizeof *safety);
  safety->state = VS_SAFETY_UNARMED;
  safety->since_us = now_us;
}

static bool sane(const vs_safety_input *in) {
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (!isfinite(in->wheels[i].left_radps) || !isfinite(in->wheels[i].right_radps)) return false;
  return !in->world || vs_world_check(in->world, NULL) == VS_OK;
}

static bool seen(const vs_safety_input *in, int robot) {
  if (in->seen_elsewhere) return true;
  return in->world && in->world->robot[in->team][robot].valid;
}

// A command that was on its way when the robots were stopped does not start them again.
static bool fresh(const vs_safety *safety, const vs_safety_input *in) {
  int64_t age_us = in->now_us - in->command_us;
  bool newer = safety->state == VS_SAFETY_RUNNING || in->command_us > safety->since_us;
  return in->command_us > 0 && newer && age_us >= 0 && age_us <= VS_SAFETY_STALE_US;
}

static unsigned conditions_of(const vs_safety *safety, const vs_safety_input *in) {
  bool halted = in->referee == VS_EVENT_HALT || in->referee == VS_EVENT_END;
  bool any_seen = false;
  for (int i = 0; i < VS_TEAM_SIZE; i++) any_seen = any_seen || seen(in, i);
  return (in->shutdown ? IF(SHUTDOWN) : 0) | (in->armed ? IF(ARMED) : 0) | (halted ? IF(HALTED) : 0) |
         (sane(in) ? IF(SANE) : 0) | (any_seen ? IF(SEEN) : 0) | (fresh(safety, in) ? IF(FRESH) : 0) |
         (in->no_camera ? 0 : IF(CAMERA)) | (in->no_ball ? 0 : IF(BALL)) | (in->no_player ? 0 : IF(PLAYER));
}

vs_safety_state vs_safety_step(vs_safety *safety, const vs_safety_input *input, vs_wheels out[VS_TEAM_SIZE]) {
  vs_safety_state next = vs_safety_next(safety->state, conditions_of(safety, input));
  if (next != safety->state) {
    safety->state = next;
    safety->since_us = input->now_us;
    safety->entered[next]++;
  }
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    out[i] = (vs_wheels){0, 0};
    if (next != VS_SAFETY_RUNNING || !seen(input, i)) continue;
    out[i].left_radps = vs_clamp(input->wheels[i].left_radps, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
    out[i].right_radps = vs_clamp(input->wheels[i].right_radps, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
  }
  return next;
}

static const struct {
  const char *name, *reason;
} text[VS_SAFETY_STATES] = {
    [VS_SAFETY_UNARMED] = {"unarmed", "the robots have not been released"},
    [VS_SAFETY_RUNNING] = {"running", ""},
    [VS_SAFETY_HALTED] = {"halted", "the referee has stopped play"},
    [VS_SAFETY_DARK] = {"no camera", "the camera is gone; it is being looked for"},
    [VS_SAFETY_BLIND] = {"blind", "the camera sees none of our robots"},
    [VS_SAFETY_NO_BALL] = {"no ball", "the ball is not seen"},
    [VS_SAFETY_MINDLESS] = {"no player", "the player failed and is being started again"},
    [VS_SAFETY_STALE] = {"stale", "there is no command from a frame of the last 150 ms"},
    [VS_SAFETY_FAULT] = {"fault", "a position or a command was not a number; release the robots anew"},
    [VS_SAFETY_SHUTDOWN] = {"shutdown", "the program is ending"},
};

const char *vs_safety_name(vs_safety_state state) { return state < VS_SAFETY_STATES ? text[state].name : "unknown"; }
const char *vs_safety_reason(vs_safety_state state) { return state < VS_SAFETY_STATES ? text[state].reason : ""; }
