// Reads a log through, prints what was asked for, and sums up.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "json_text.h"
#include "message_text.h"
#include "replay.h"

bool replay_wants(const vs_flag_list *wanted, const char *channel) {
  for (int i = 0; i < wanted->count; i++) {
    const char *name = wanted->value[i];
    if (!strcasecmp(name, channel)) return true;
    if (!strncmp(channel, "VSSS_", 5) && !strcasecmp(name, channel + 5)) return true;
  }
  return false;
}

static replay_channel *count(replay_summary *s, const vs_log_event *event) {
  int i = 0;
  while (i < s->n_channels && strcmp(s->channel[i].name, event->channel) != 0) i++;
  if (i == s->n_channels) {
    if (i == REPLAY_CHANNELS_MAX) i--; // the last row gathers what is too much
    if (i == s->n_channels) {
      snprintf(s->channel[i].name, sizeof s->channel[i].name, "%s", event->channel);
      s->n_channels++;
    }
  }
  replay_channel *c = &s->channel[i];
  c->messages++;
  c->bytes += (int64_t)event->size;
  s->bytes += (int64_t)event->size;
  if (!s->events++) s->first_us = event->utime_us;
  s->last_us = event->utime_us;
  return c;
}

static void learn(replay_summary *s, const vs_message *m) {
  switch (m->channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE:
    if (m->channel == VS_CH_TRUTH) s->have_truth = true;
    if (m->channel == VS_CH_STATE) s->have_state = true;
    s->game = m->as.world.game;
    s->division = m->as.world.world.division;
    s->have_game = true;
    break;
  case VS_CH_REFEREE:
    s->game.time_s = m->as.referee.event.time_s;
    s->game.duration_s = m->as.referee.duration_s;
    for (int t = 0; t < VS_TEAMS; t++) s->game.score[t] = m->as.referee.score[t];
    s->have_game = true;
    if (m->as.referee.event.kind == VS_EVENT_END) s->matches++;
    break;
  case VS_CH_CMD: {
    char *name = s->player[m->as.cmd.team];
    snprintf(name, VS_BUS_TEXT, "%s", m->as.cmd.source);
    break;
  }
  default: break;
  }
}

static void print_clock(double time_s) {
  double minutes = floor(time_s / 60.0);
  printf("%3.0f:%04.1f", minutes, time_s - 60.0 * minutes);
}

// Time stamps may be anything: their difference need not fit 64 bits.
static double between_s(int64_t from_us, int64_t to_us) { return ((double)to_us - (double)from_us) * 1e-6; }

static void print_message(const vs_message *m, double time_s, bool json, bool whole) {
  static char line[VS_MESSAGE_JSON_MAX];
  if (json) {
    vs_message_json(m, time_s, line, sizeof line);
    printf("%s\n", line);
  } else if (!whole) { // an event among events
    const vs_msg_referee *r = &m->as.referee;
    vs_event_text(&r->event, line, sizeof line);
    print_clock(r->event.time_s);
    printf("  %2d : %-2d  %s\n", r->score[VS_BLUE], r->score[VS_YELLOW], line);
  } else {
    vs_message_text(m, line, sizeof line);
    vs_text_clean(line);
    printf("%9.3f  %-15s  %s\n", time_s, vs_channel_name(m->channel), line);
  }
}

static void print_foreign(const vs_log_event *event, double time_s, bool json) {
  char name[512];
  if (json)
    vs_json_quote(event->channel, name, sizeof name);
  else
    vs_text_clean((snprintf(name, sizeof name, "%s", event->channel), name));
  if (json)
    printf("{\"t_s\": %.6f, \"channel\": %s, \"size\": %zu}\n", time_s, name, event->size);
  else
    printf("%9.3f  %-15s  %zu bytes\n", time_s, name, event->size);
}

vs_status replay_scan(vs_bus_log *log, const replay_def *def, replay_summary *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  vs_message *message = malloc(sizeof *message);
  uint8_t *image = malloc(VS_BUS_IMAGE_MAX);
  vs_status s = message && image ? VS_OK : vs_fail(err, VS_FAIL, "out of memory");
  bool chosen = def->wanted.count > 0;
  vs_bus_log_rewind(log);
  while (s == VS_OK && !vs_cli_interrupted()) {
    vs_log_event event;
    bool end;
    s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) break;
    replay_channel *c = count(out, &event);
    double time_s = between_s(out->first_us, event.utime_us);
    bool wanted = replay_wants(&def->wanted, event.channel);
    out->found_wanted |= wanted;
    vs_channel channel;
    bool ours = vs_channel_parse(event.channel, &channel) && !strcmp(vs_channel_name(channel), event.channel);
    vs_error why;
    if (ours && vs_message_decode(channel, event.data, event.size, message, image, &why) != VS_OK) {
      c->refused++;
      ours = false;
    }
    if (ours) learn(out, message);
    bool show = def->show && (chosen ? wanted : ours && channel == VS_CH_REFEREE);
    if (show && ours) print_message(message, time_s, def->json, chosen);
    if (show && !ours) print_foreign(&event, time_s, def->json);
  }
  free(message);
  free(image);
  return s;
}

static void print_json(const char *path, const replay_summary *s) {
  char text[1024];
  vs_json_quote(path, text, sizeof text);
  printf("{\"summary\": {\"log\": %s, \"messages\": %lld, \"bytes\": %lld, \"seconds\": %.6f, \"matches\": %d, ", text,
         (long long)s->events, (long long)s->bytes, between_s(s->first_us, s->last_us), s->matches);
  if (s->have_game)
    printf("\"score\": [%d, %d], \"game_time_s\": %.3f, ", s->game.score[VS_BLUE], s->game.score[VS_YELLOW],
           s->game.time_s);
  printf("\"channels\": [");
  for (int i = 0; i < s->n_channels; i++) {
    const replay_channel *c = &s->channel[i];
    vs_json_quote(c->name, text, sizeof text);
    printf("%s{\"name\": %s, \"messages\": %lld, \"bytes\": %lld, \"refused\": %lld}", i ? ", " : "", text,
           (long long)c->messages, (long long)c->bytes, (long long)c->refused);
  }
  printf("]}}\n");
}

void replay_print_summary(const char *path, const replay_summary *s, bool json) {
  if (json) {
    print_json(path, s);
    return;
  }
  double seconds = between_s(s->first_us, s->last_us);
  printf("\n%s: %lld messages, %.1f s, %.2f MB\n", path, (long long)s->events, seconds, (double)s->bytes * 1e-6);
  if (s->have_game) {
    char blue[VS_BUS_TEXT], yellow[VS_BUS_TEXT];
    snprintf(blue, sizeof blue, "%s", s->player[VS_BLUE]);
    snprintf(yellow, sizeof yellow, "%s", s->player[VS_YELLOW]);
    vs_text_clean(blue);
    vs_text_clean(yellow);
    printf("blue %s%s%d : %d%s%s yellow after %.1f s", blue, *blue ? " " : "", s->game.score[VS_BLUE],
           s->game.score[VS_YELLOW], *yellow ? " " : "", yellow, s->game.time_s);
    if (s->matches > 1) printf(" (the last of %d matches)", s->matches);
    printf("\n");
  }
  printf("\n%-20s %10s %8s %8s\n", "channel", "messages", "Hz", "kB/s");
  for (int i = 0; i < s->n_channels; i++) {
    const replay_channel *c = &s->channel[i];
    char name[sizeof c->name];
    double per_second = seconds > 0.0 ? 1.0 / seconds : 0.0;
    snprintf(name, sizeof name, "%s", c->name);
    vs_text_clean(name);
    printf("%-20s %10lld %8.1f %8.2f", name, (long long)c->messages, (double)c->messages * per_second,
           (double)c->bytes * per_second * 1e-3);
    if (c->refused) printf("  %lld not readable: other version of lcm_types, or damaged", (long long)c->refused);
    printf("\n");
  }
}
