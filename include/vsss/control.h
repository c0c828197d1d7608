// Stable: part of libvsss (deploy/docs/library.md).
//
// One team at its own rate: observe -> policy -> wheels. The only path from a world to a wheel, the same in
// simulation and on the field.
#ifndef VSSS_CONTROL_H
#define VSSS_CONTROL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/api.h"
#include "vsss/observe.h"
#include "vsss/policy.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_control vs_control;

// Takes the player over where it succeeds (vs_control_free closes it). player NULL: an external team, whose actions the
// caller gives with vs_control_set_action and whose observations it reads through vs_control_observer. VS_FAIL: a rate
// that is not VS_CAMERA_HZ divided by a whole number. Call vs_control_reset before the first step.
VSSS_API vs_status vs_control_new(vs_player *player, vs_control **out, vs_error *err);
VSSS_API void vs_control_free(vs_control *control);

// Start of a match or an episode: forgets the past, reseeds the player. shuffle_adversaries: training's random order.
VSSS_API vs_status vs_control_reset(vs_control *control, uint64_t seed, bool shuffle_adversaries, vs_error *err);
// After the referee placed the robots: history and last action start anew, the next call decides, the player goes on.
VSSS_API void vs_control_restart(vs_control *control);

// VS_USAGE with the reason where it cannot play a division: learned policies and external teams play 3 against 3 alone.
VSSS_API vs_status vs_control_plays(const vs_control *control, vs_division division, vs_error *err);

// How long after the moment that a world shows a command given on it reaches the wheels (camera, decision and radio
// together; measure it). Before anything is shown to the player, the world is moved on by so much: own robots by the
// commands that are on their way, the other objects as they go. So a player that knows no delay plays as if there were
// none, but for what the prediction cannot know. 0 at first; kept by reset and restart. VS_USAGE: not in
// [0, VS_CONTROL_LATENCY_MAX_S].
#define VS_CONTROL_LATENCY_MAX_S 0.3
VSSS_API vs_status vs_control_set_latency(vs_control *control, double latency_s, vs_error *err);

// Called for every camera frame with the measured absolute world and game, dt_s since the last call. Lets the player
// decide when its rate says so (the first call decides, lost frames are skipped, never made up for) and writes the
// wheels to apply until the next call; where it fails, zeros. decided (may be NULL) tells whether this frame was a
// decision. In 3 against 3 a scripted team is observed at VS_DECISION_HZ all the same, so that it can be recorded and
// imitated. out: [the world's team_size].
VSSS_API vs_status vs_control_step(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game,
                                   double dt_s, vs_wheels *out, bool *decided, vs_error *err);

// External teams: observe (push a frame at a decision time), read, act. The action is held until the next; one that is
// not finite is VS_FAIL and changes nothing.
VSSS_API void vs_control_observe(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game);
VSSS_API vs_status vs_control_set_action(vs_control *control, const float *action /* [3][2] */, vs_error *err);

// The observer as it would be after observing this world; the control is not changed.
VSSS_API void vs_control_peek(const vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game,
                              vs_observer *out);

// The world that the player would be shown, in the absolute frame: moved on by the latency. The control is not changed.
VSSS_API void vs_control_ahead(const vs_control *control, vs_team team, const vs_world *absolute, vs_world *out);

VSSS_API const vs_observer *vs_control_observer(const vs_control *control);
VSSS_API const float *vs_control_action(const vs_control *control); // the last, [3][2] in [-1, 1]
VSSS_API vs_player *vs_control_player(vs_control *control);         // NULL for an external team

// Snapshots: state is a block of vs_control_state_size bytes of the caller. Size 0: its player cannot be snapshotted.
VSSS_API size_t vs_control_state_size(const vs_control *control);
VSSS_API void vs_control_save(const vs_control *control, void *state);
// VS_FAIL: a number that cannot be; the control is then as it was, its player perhaps reset.
VSSS_API vs_status vs_control_restore(vs_control *control, const void *state, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
