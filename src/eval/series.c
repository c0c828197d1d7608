// Many matches over threads, each a function of its own seed.
#include "vsss/eval.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/pool.h"

void vs_match_count(vs_match_result *result, const vs_event *event) {
  result->events[event->team][event->kind]++;
  if (event->kind == VS_EVENT_GOAL) {
    vs_event_kind before = result->set_play == VS_EVENT_NONE ? VS_EVENT_KICK_OFF : result->set_play;
    bool soon = event->time_s - result->set_play_s <= VS_SET_PLAY_S;
    result->goals_from[event->team][soon ? before : VS_EVENT_NONE]++;
  }
  bool kick_off =
      event->kind == VS_EVENT_GOAL || event->kind == VS_EVENT_HALF_TIME || event->kind == VS_EVENT_EXTRA_TIME;
  if (!kick_off && event->kind != VS_EVENT_PENALTY && event->kind != VS_EVENT_FREE_BALL &&
      event->kind != VS_EVENT_GOAL_KICK && event->kind != VS_EVENT_FREE_KICK)
    return;
  result->set_play = kick_off ? VS_EVENT_KICK_OFF : event->kind;
  result->set_play_s = event->time_s;
}

void vs_match_watch(vs_match_result *result, vs_idle *idle, const vs_env *env, const vs_event *event) {
  vs_world judged;
  vs_match_count(result, event);
  vs_env_judged(env, &judged);
  vs_idle_step(idle, &judged, event, 1.0 / VS_CAMERA_HZ);
  if (hypot(judged.ball.vx_mps, judged.ball.vy_mps) < VS_LEAGUE_STUCK_MPS) result->still_s += 1.0 / VS_CAMERA_HZ;
  memcpy(result->idle_warnings, idle->warnings, sizeof result->idle_warnings);
  memcpy(result->idle_sent_off, idle->sent_off, sizeof result->idle_sent_off);
}

void vs_match_end(const vs_env *env, vs_match_result *result) {
  const vs_referee *referee = vs_env_referee(env);
  memcpy(result->score, referee->game.score, sizeof result->score);
  memcpy(result->shoot_out, referee->kicks_scored, sizeof result->shoot_out);
  result->half = referee->half;
  result->lot = referee->lot;
  result->time_s = referee->game.time_s;
  result->hash = vs_env_hash(env);
  result->played = referee->over;
}

int vs_match_winner(const vs_match_result *m) {
  int ahead = m->score[VS_BLUE] - m->score[VS_YELLOW];
  if (ahead == 0) ahead = m->shoot_out[VS_BLUE] - m->shoot_out[VS_YELLOW];
  if (ahead == 0) return m->lot - 1;
  return ahead > 0 ? VS_BLUE : VS_YELLOW;
}

vs_status vs_match_play(vs_env *env, uint64_t seed, bool (*go_on)(void *context), void *context, vs_match_result *out,
                        vs_error *err) {
  memset(out, 0, sizeof *out);
  out->seed = seed;
  vs_idle idle = {0};
  vs_status s = vs_env_reset(env, seed, err);
  if (s != VS_OK) return s;
  for (int frame = 1; !vs_env_over(env); frame++) {
    vs_event event;
    s = vs_env_frame(env, &event, err);
    if (s != VS_OK) return s;
    vs_match_watch(out, &idle, env, &event);
    if (go_on && frame % VS_CAMERA_HZ == 0 && !go_on(context)) return VS_OK;
  }
  vs_match_end(env, out);
  return VS_OK;
}

// What the threads of one series share.
typedef struct series {
  const vs_series_def *def;
  vs_match_result *results;
  pthread_mutex_t lock;
  int next; // match to take
  bool stop;
  vs_error error; // the first
} series;

static void stop_with(series *s, const vs_error *error) {
  pthread_mutex_lock(&s->lock);
  s->stop = true;
  if (error && s->error.status == VS_OK) s->error = *error;
  pthread_mutex_unlock(&s->lock);
}

static bool asked_to_go_on(void *context) {
  series *s = context;
  pthread_mutex_lock(&s->lock);
  if (!s->stop && s->def->go_on && !s->def->go_on(s->def->context)) s->stop = true;
  bool stop = s->stop;
  pthread_mutex_unlock(&s->lock);
  return !stop;
}

// The next match to play, or -1.
static int take(series *s) {
  pthread_mutex_lock(&s->lock);
  int index = s->stop || s->next == s->def->matches ? -1 : s->next++;
  pthread_mutex_unlock(&s->lock);
  return index;
}

static void report(series *s, int index) {
  pthread_mutex_lock(&s->lock);
  const vs_series_def *def = s->def;
  if (def->progress && !s->stop && !def->progress(def->context, index, &s->results[index])) s->stop = true;
  pthread_mutex_unlock(&s->lock);
}

// What one thread does: matches, in an env of its own, until none is left.
static void play(void *context, int piece, int thread) {
  (void)piece;
  (void)thread;
  series *s = context;
  vs_error error = {0};
  vs_env *env = NULL;
  if (vs_env_new(&s->def->env, &env, &error) != VS_OK) {
    stop_with(s, &error);
    return;
  }
  for (int index; (index = take(s)) >= 0;) {
    vs_match_result *result = &s->results[index];
    if (vs_match_play(env, vs_seed_mix(s->def->seed, (uint64_t)index), asked_to_go_on, s, result, &error) != VS_OK) {
      vs_fail_prefix(&error, "match %d of the series", index + 1);
      stop_with(s, &error);
      break;
    }
    if (result->played) report(s, index);
  }
  vs_env_free(env);
}

vs_status vs_series_play(const vs_series_def *def, vs_match_result *results, vs_error *err) {
  if (def->matches < 1) return vs_fail(err, VS_USAGE, "matches %d: at least 1", def->matches);
  if (def->threads < 1) return vs_fail(err, VS_USAGE, "threads %d: at least 1", def->threads);
  memset(results, 0, (size_t)def->matches * sizeof *results);
  int threads = def->threads < def->matches ? def->threads : def->matches;
  vs_pool *pool = NULL;
  vs_status status = vs_pool_new(threads, &pool, err);
  if (status != VS_OK) return status;
  series s = {.def = def, .results = results};
  pthread_mutex_init(&s.lock, NULL);
  vs_pool_run(pool, threads, play, &s);
  pthread_mutex_destroy(&s.lock);
  vs_pool_free(pool);
  return s.error.status == VS_OK ? VS_OK : vs_fail(err, s.error.status, "%s", s.error.text);
}
