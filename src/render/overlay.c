#include "overlay.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CAPTION_S 2.5 // how long an event is shown, match time

static const float ink[3] = {0.96f, 0.96f, 0.96f}, board[3] = {0.07f, 0.08f, 0.10f};
static const float team_rgb[VS_TEAMS][3] = {{0.10f, 0.28f, 0.90f}, {0.98f, 0.84f, 0.08f}};

typedef struct labels {
  const mjrContext *context;
  mjrRect *drawn;
  int count;
} labels;

static void label(labels *l, mjrRect at, const char *text, const float back[3], const float front[3]) {
  mjr_label(at, mjFONT_NORMAL, text, back[0], back[1], back[2], 1.0f, front[0], front[1], front[2], l->context);
  l->drawn[l->count++] = at;
}

// "GOAL - BLUE", "FREE BALL - QUADRANT 2", "" when nothing happened lately.
static void caption(const vs_game *game, char *text, size_t size) {
  const vs_event *e = &game->last_event;
  *text = '\0';
  if (e->kind == VS_EVENT_NONE) return;
  double age_s = game->time_s - e->time_s;
  if (e->kind != VS_EVENT_END && !(age_s >= 0.0 && age_s < CAPTION_S)) return;
  const char *name = vs_event_name(e->kind);
  if (e->kind == VS_EVENT_FREE_BALL && e->quadrant > 0)
    snprintf(text, size, "%s - quadrant %d", name, e->quadrant);
  else if (e->kind == VS_EVENT_HALT || e->kind == VS_EVENT_END || e->kind == VS_EVENT_HALF_TIME ||
           e->kind == VS_EVENT_FREE_BALL)
    snprintf(text, size, "%s", name);
  else
    snprintf(text, size, "%s - %s", name, vs_team_name(e->team));
  for (char *c = text; *c; c++) *c = (char)toupper((unsigned char)*c);
}

int vs_render_overlay(const mjrContext *context, mjrRect picture, const vs_game *game, const char *title,
                      mjrRect drawn[VS_OVERLAY_LABELS]) {
  labels l = {context, drawn, 0};
  int unit = picture.height / 18, middle = picture.width / 2, top = picture.height - unit - unit / 3;
  char text[96];
  int width = unit * 3 / 2, gap = 3 * unit;
  snprintf(text, sizeof text, "%d", game->score[VS_BLUE]);
  label(&l, (mjrRect){middle - gap / 2 - width, top, width, unit}, text, team_rgb[VS_BLUE], ink);
  snprintf(text, sizeof text, "%d", game->score[VS_YELLOW]);
  label(&l, (mjrRect){middle + gap / 2, top, width, unit}, text, team_rgb[VS_YELLOW], board);
  // As sports show it: the time played, which is a sum of frames and may lack some nanoseconds of a whole second.
  int played = (int)floor(game->time_s + 0.5 / VS_CAMERA_HZ);
  snprintf(text, sizeof text, "%d:%02d", played / 60, played % 60);
  label(&l, (mjrRect){middle - gap / 2, top, gap, unit}, text, board, ink);

  const char *versus = strstr(title, "  ");
  if (versus) {
    snprintf(text, sizeof text, "%.*s", (int)(versus - title), title);
    label(&l, (mjrRect){middle - gap / 2 - width - 5 * unit, top, 5 * unit, unit}, text, board, ink);
    label(&l, (mjrRect){middle + gap / 2 + width, top, 5 * unit, unit}, versus + 2, board, ink);
  }
  caption(game, text, sizeof text);
  if (*text) {
    vs_team team = game->last_event.team;
    bool coloured = game->last_event.kind == VS_EVENT_GOAL || game->last_event.kind == VS_EVENT_PENALTY;
    label(&l, (mjrRect){middle - 6 * unit, top - unit - unit / 4, 12 * unit, unit}, text,
          coloured ? team_rgb[team] : board, coloured && team == VS_YELLOW ? board : ink);
  }
  return l.count;
}
