// A log as a video: every 1/fps of the world's own time one picture of the newest world.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "replay.h"
#include "video.h"
#include "vsss/render.h"

enum { WIDTH = 1280, HEIGHT = 720 };
#define GAP_US 2000000 // a longer silence, or time that runs backwards: another match begins

typedef struct movie {
  vs_render *render;
  vs_video *video;
  uint8_t *rgb;
  int64_t next_us, last_us; // of the next picture and the last world, in the world's time
  int64_t pictures;
} movie;

static vs_status picture(movie *m, const vs_msg_world *world, vs_error *err) {
  vs_status s = vs_render_world(m->render, &world->world, &world->game, m->rgb, err);
  if (s == VS_OK) s = vs_video_frame(m->video, m->rgb, err);
  m->pictures++;
  return s;
}

static vs_status add(movie *m, const vs_msg_world *world, int64_t period_us, vs_error *err) {
  int64_t time_us = world->world.time_us;
  bool anew = !m->pictures || time_us < m->last_us || time_us > m->last_us + GAP_US;
  if (anew) m->next_us = time_us;
  m->last_us = time_us;
  vs_status s = VS_OK;
  // Worlds come at most a few times slower than pictures: each is repeated until its successor's time.
  for (; s == VS_OK && m->next_us <= time_us; m->next_us += period_us) s = picture(m, world, err);
  return s;
}

static vs_status draw_all(vs_bus_log *log, vs_channel channel, int fps, movie *m, vs_error *err) {
  vs_message *message = malloc(sizeof *message);
  if (!message) return vs_fail(err, VS_FAIL, "out of memory");
  vs_progress progress;
  vs_progress_start(&progress);
  vs_status s = VS_OK;
  vs_bus_log_rewind(log);
  while (s == VS_OK && !vs_cli_interrupted()) {
    vs_log_event event;
    bool end;
    s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) break;
    if (strcmp(event.channel, vs_channel_name(channel)) != 0) continue;
    if (vs_message_decode(channel, event.data, event.size, message, NULL, NULL) != VS_OK) continue;
    s = add(m, &message->as.world, 1000000 / fps, err);
    vs_progress_show(&progress, vs_bus_log_fraction(log), "video");
  }
  vs_progress_clear(&progress);
  free(message);
  return s;
}

vs_status replay_video(vs_bus_log *log, const replay_summary *summary, const char *path, int fps, vs_error *err) {
  if (!summary->have_truth && !summary->have_state)
    return vs_fail(err, VS_FAIL, "the log has neither VSSS_TRUTH nor VSSS_STATE: there is no world to draw");
  char title[64];
  snprintf(title, sizeof title, "%.28s  %.28s", summary->player[VS_BLUE], summary->player[VS_YELLOW]);
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.width_px = WIDTH;
  def.height_px = HEIGHT;
  def.title = title;
  def.division = summary->division;
  movie m = {0};
  vs_status s = vs_render_new(&def, &m.render, err);
  if (s != VS_OK) return s;
  m.rgb = malloc((size_t)WIDTH * HEIGHT * 3);
  s = m.rgb ? vs_video_open(path, WIDTH, HEIGHT, fps, &m.video, err) : vs_fail(err, VS_FAIL, "out of memory");
  if (s == VS_OK) {
    s = draw_all(log, summary->have_truth ? VS_CH_TRUTH : VS_CH_STATE, fps, &m, err);
    // The file is closed in any case; the first failure is the one to tell.
    vs_status closed = vs_video_close(m.video, s == VS_OK ? err : NULL);
    if (s == VS_OK) s = closed;
  }
  if (s == VS_OK) printf("%s: %lld pictures, %.1f s\n", path, (long long)m.pictures, (double)m.pictures / fps);
  free(m.rgb);
  vs_render_free(m.render);
  return s;
}
