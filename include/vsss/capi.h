// Stable: part of libvsss (deploy/docs/library.md).
//
// Flat functions for bindings of other languages (deploy/python is one): handles, numbers, arrays of the caller and
// texts, no structs to mirror but one. Everything else in include/vsss is for C.
//
// Every function that can fail returns VS_OK, VS_FAIL or VS_USAGE (status.h) and writes one line into error, which may be
// NULL. A handle belongs to the process that made it and to one call at a time: a call from a forked child, or while
// another is at work on the same handle, is VS_USAGE and changes nothing.
#ifndef VSSS_CAPI_H
#define VSSS_CAPI_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_CAPI_VERSION 1

// The handshake: sizes of everything that a binding lays out. Fields are only ever added at the end, and VS_CAPI_VERSION
// then grows.
typedef struct vs_capi_about {
  uint32_t size, version; // of this struct, VS_CAPI_VERSION
  int32_t team_size, observation, frame, action, reward_terms, event_kinds;
  int32_t world;                                    // doubles of vs_capi_world
  int32_t vss_observation, vss_action, vss_shaping; // of vs_capi_vss
  int32_t summary;                                  // doubles of vs_capi_sum_up
  int32_t decision_hz, vss_hz;
  double wheel_limit_radps;
  char contract[24]; // hash of the observation's layout (contract.h)
  char release[32];
} vs_capi_about;

// VS_USAGE where the caller was written for another version or size; about is then left alone.
VSSS_API int vs_capi_hello(uint32_t version, uint32_t size, vs_capi_about *about, char *error, size_t error_size);

// Name number index of a list, NULL past its end. Lists: "reward" and "event" (by their numbers), "observation" (the values
// of one frame), "setting" and "setting_help" (of vs_capi_vec_new), "vss_setting" and "vss_setting_help", "shaping" (of
// vs_capi_vss), "summary", "player" (schemes of URIs), "release" (one).
VSSS_API const char *vs_capi_name(const char *list, int index);

// The path of a file of ours, such as "models/policy/vsss.onnx".
VSSS_API int vs_capi_find(const char *relative, char *path, size_t path_size, char *error, size_t error_size);

// A seed for a part of a larger whole: match i of ./vsss eval --seed S is played from vs_capi_seed(S, i) (rng.h).
VSSS_API uint64_t vs_capi_seed(uint64_t seed, uint64_t part);

// Checks the rewards named by a text such as "dense,goal=5" and gives their weights, double[reward_terms].
VSSS_API int vs_capi_reward(const char *text, double *weights, char *error, size_t error_size);

// --- many matches (vecenv.h) ------------------------------------------------------------------------------------------
typedef struct vs_capi_vec vs_capi_vec;

// settings: "key=value" each, ending with NULL; keys are those of vs_capi_name("setting"). The value of realism is a path
// or, where it has a line break, the text of such a file.
VSSS_API int vs_capi_vec_new(const char *const *settings, vs_capi_vec **out, char *error, size_t error_size);
VSSS_API int vs_capi_vec_free(vs_capi_vec *vec, char *error, size_t error_size);
VSSS_API int vs_capi_vec_envs(const vs_capi_vec *vec);
VSSS_API int vs_capi_vec_rows(const vs_capi_vec *vec); // robots of the teams that have rows
VSSS_API int vs_capi_vec_duration(const vs_capi_vec *vec, double *duration_s);

// The caller's arrays, VS_CAPI_SETS sets of them, which stay its own and must outlive the handle. Every call that writes
// says into which set. bytes is checked. Names, each C-contiguous:
//   observation, final_observation  float32 [rows][observation]
//   action                          float32 [rows][action]
//   reward                          float32 [rows]: the weighted sum
//   reward_terms                    float64 [rows][reward_terms]
//   terminated, truncated           uint8   [rows]: the episode ended by the game, by its clock
//   done                            uint8   [envs]
//   score                           int32   [envs][2]: of the ended episode, where done
//   episode_s                       float32 [envs]: likewise
//   event                           int32   [envs][2]: kind, team or -1
#define VS_CAPI_SETS 2
VSSS_API int vs_capi_vec_bind(vs_capi_vec *vec, int set, const char *name, void *data, size_t bytes, char *error,
                              size_t error_size);

// seed NULL: go on to the next episodes; else uint64[1] for all matches or uint64[envs]. start: uint8[envs] or NULL: all.
VSSS_API int vs_capi_vec_reset(vs_capi_vec *vec, int set, const uint64_t *seed, int seeds, const uint8_t *start,
                               char *error, size_t error_size);
// One match begins the episode of exactly this seed (vs_vecenv_start_from).
VSSS_API int vs_capi_vec_start(vs_capi_vec *vec, int set, int env, uint64_t seed, char *error, size_t error_size);
// One decision of every match. An action that is not finite is VS_USAGE, and no match has moved.
VSSS_API int vs_capi_vec_step(vs_capi_vec *vec, int set, char *error, size_t error_size);
// The player of a team (0 blue, 1 yellow) of a match from its next episode on; "" an external one.
VSSS_API int vs_capi_vec_player(vs_capi_vec *vec, int env, int team, const char *uri, char *error, size_t error_size);
VSSS_API int vs_capi_vec_hash(vs_capi_vec *vec, uint64_t *hash, char *error, size_t error_size);

// A snapshot without the arrays. It fits a handle made with the same settings, threads and seed apart.
VSSS_API int vs_capi_vec_state_size(vs_capi_vec *vec, size_t *size, char *error, size_t error_size);
VSSS_API int vs_capi_vec_save(vs_capi_vec *vec, void *state, size_t size, char *error, size_t error_size);
VSSS_API int vs_capi_vec_restore(vs_capi_vec *vec, const void *state, size_t size, char *error, size_t error_size);

// A world as numbers: time_s, duration_s, score own, score of the adversaries, ball x, y, vx, vy (m, m/s), then for the
// three own and the three adversary robots x, y, theta, vx, vy, omega. team 0 or 1: in that team's view (it attacks +x, own
// robots first); -1: absolute, blue first. measured != 0: as the teams see it; else the truth.
#define VS_CAPI_WORLD (8 + 2 * 3 * 6)
VSSS_API int vs_capi_vec_world(vs_capi_vec *vec, int env, int team, int measured, double *out, char *error,
                               size_t error_size);

// --- rSoccer's VSS-v0 task --------------------------------------------------------------------------------------------
// Many single robots (blue 0) among five that drive at random, steps of 25 ms; see vss_v0.c. Arrays as above, one row per
// environment: observation [envs][vss_observation], final_observation, action [envs][vss_action], reward, terminated,
// truncated, shaping float64 [envs][vss_shaping], final_shaping likewise.
typedef struct vs_capi_vss vs_capi_vss;
VSSS_API int vs_capi_vss_new(const char *const *settings, vs_capi_vss **out, char *error, size_t error_size);
VSSS_API int vs_capi_vss_free(vs_capi_vss *vss, char *error, size_t error_size);
VSSS_API int vs_capi_vss_envs(const vs_capi_vss *vss);
VSSS_API int vs_capi_vss_bind(vs_capi_vss *vss, int set, const char *name, void *data, size_t bytes, char *error,
                              size_t error_size);
VSSS_API int vs_capi_vss_reset(vs_capi_vss *vss, int set, const uint64_t *seed, int seeds, const uint8_t *start,
                               char *error, size_t error_size);
VSSS_API int vs_capi_vss_step(vs_capi_vss *vss, int set, char *error, size_t error_size);
VSSS_API int vs_capi_vss_state_size(vs_capi_vss *vss, size_t *size, char *error, size_t error_size);
VSSS_API int vs_capi_vss_save(vs_capi_vss *vss, void *state, size_t size, char *error, size_t error_size);
VSSS_API int vs_capi_vss_restore(vs_capi_vss *vss, const void *state, size_t size, char *error, size_t error_size);

// --- pictures (render.h) ----------------------------------------------------------------------------------------------
typedef struct vs_capi_render vs_capi_render;
VSSS_API int vs_capi_render_new(int width_px, int height_px, const char *title, vs_capi_render **out, char *error,
                                size_t error_size);
VSSS_API int vs_capi_render_free(vs_capi_render *render, char *error, size_t error_size);
// rgb: uint8[height][width][3], top row first; bytes is checked.
VSSS_API int vs_capi_render_vec(vs_capi_render *render, vs_capi_vec *vec, int env, uint8_t *rgb, size_t bytes,
                                char *error, size_t error_size);
VSSS_API int vs_capi_render_vss(vs_capi_render *render, vs_capi_vss *vss, int env, uint8_t *rgb, size_t bytes,
                                char *error, size_t error_size);

// --- players that are functions of the caller -------------------------------------------------------------------------
// Registers the scheme SCHEME: (once): "SCHEME:7" is a team that think plays with player = 7. instance numbers the team's
// matches: a new one begins with every match. think gets the world in the team's view (VS_CAPI_WORLD doubles) 30 times a
// second, from any thread, and writes left, right of the three robots in rad/s; not 0 fails the match. begin and end may
// be NULL.
typedef int (*vs_capi_think)(int64_t player, uint64_t instance, const double *world, double dt_s, double *wheels);
typedef int (*vs_capi_begin)(int64_t player, uint64_t instance, uint64_t seed);
typedef void (*vs_capi_end)(int64_t player, uint64_t instance);
VSSS_API int vs_capi_players(const char *scheme, vs_capi_begin begin, vs_capi_think think, vs_capi_end end, char *error,
                             size_t error_size);

// --- the table of ./vsss eval -----------------------------------------------------------------------------------------
// n matches as seen from blue: length, score [n][2], events [n][2][event_kinds] (by the team that each names) -> summary:
// mean, low, high of the 95 % interval of win, draw, loss, goals for, goals against, score; then penalties for, against,
// free balls, goal kicks, mean time (vs_capi_name("summary")).
VSSS_API int vs_capi_sum_up(int n, const double *time_s, const int32_t *score, const int32_t *events, double *summary,
                            char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
