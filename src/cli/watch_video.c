// A match as a video: one picture a camera frame, and the moment of an event held for people to see.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "video.h"
#include "vsss/contract.h"
#include "vsss/render.h"
#include "watch.h"

#define GOAL_HOLD_FRAMES  (VS_CAMERA_HZ * 3 / 2)
#define EVENT_HOLD_FRAMES (VS_CAMERA_HZ / 2)

typedef struct video_watch {
  vs_render *render;
  vs_video *video;
  uint8_t *rgb;
  char title[128];
} video_watch;

// In a shoot-out the kicks scored stand behind the names.
static void show_shoot_out(video_watch *w, const vs_referee *referee) {
  const char *yellow = strstr(w->title, "  ");
  char text[192];
  if (referee->half == VS_HALF_SHOOT_OUT && yellow)
    snprintf(text, sizeof text, "%.*s (%d)  %s (%d)", (int)(yellow - w->title), w->title,
             referee->kicks_scored[VS_BLUE], yellow + 2, referee->kicks_scored[VS_YELLOW]);
  else
    snprintf(text, sizeof text, "%s", w->title);
  vs_render_set_title(w->render, text);
}

static vs_status draw(video_watch *w, const vs_env *env, const vs_world *world, int times, vs_error *err) {
  show_shoot_out(w, vs_env_referee(env));
  vs_status s = vs_render_world(w->render, world, vs_env_game(env), w->rgb, err);
  for (int i = 0; i < times && s == VS_OK; i++) s = vs_video_frame(w->video, w->rgb, err);
  return s;
}

static vs_status frame(void *state, const vs_watch_view *view, vs_error *err) {
  video_watch *w = state;
  vs_world world;
  vs_event_kind kind = view->event->kind;
  if (kind != VS_EVENT_NONE && kind != VS_EVENT_KICK_OFF) {
    vs_env_judged(view->env, &world);
    vs_status s = draw(w, view->env, &world, kind == VS_EVENT_GOAL ? GOAL_HOLD_FRAMES : EVENT_HOLD_FRAMES, err);
    if (s != VS_OK || vs_env_over(view->env)) return s;
  }
  vs_env_truth(view->env, &world);
  return draw(w, view->env, &world, 1, err);
}

static vs_status close_video(void *state, vs_error *err) {
  video_watch *w = state;
  vs_status s = w->video ? vs_video_close(w->video, err) : VS_OK;
  vs_render_free(w->render);
  free(w->rgb);
  free(w);
  return s;
}

vs_status vs_watch_video(const char *path, const char *title, vs_division division, vs_watcher *out, vs_error *err) {
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.title = title;
  def.division = division;
  video_watch *w = calloc(1, sizeof *w);
  if (!w) return vs_fail(err, VS_FAIL, "out of memory for pictures");
  snprintf(w->title, sizeof w->title, "%s", title ? title : "");
  w->rgb = malloc((size_t)def.width_px * (size_t)def.height_px * 3);
  vs_status s = w->rgb ? VS_OK : vs_fail(err, VS_FAIL, "out of memory for pictures");
  if (s == VS_OK) s = vs_render_new(&def, &w->render, err);
  if (s == VS_OK) s = vs_video_open(path, def.width_px, def.height_px, VS_CAMERA_HZ, &w->video, err);
  if (s != VS_OK) {
    close_video(w, NULL);
    return s;
  }
  *out = (vs_watcher){w, frame, close_video};
  return VS_OK;
}
