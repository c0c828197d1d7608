// vsss view: a match in the browser, from a log or live from LCM.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "message_text.h"
#include "vsss/bus.h"
#include "vsss/bus_log.h"
#include "vsss/clock.h"
#include "vsss/paths.h"
#include "vsss/view.h"

#define FRAME_STEP_S (1.0 / 31) // of a log: no more than 30 pictures a second

typedef struct view_command {
  const char *address, *lcm;
  int port;
  bool live, truth; // truth: it is heard, so that the measured state beside it is not shown
  double seconds;

  vs_view *view;
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
  char event[64];
  int64_t sent_us;
} view_command;

// Commands and events are kept for the next world.
static bool keep(view_command *c, const vs_message *m) {
  if (m->channel == VS_CH_CMD) memcpy(c->wheels[m->as.cmd.team], m->as.cmd.wheels, sizeof c->wheels[0]);
  if (m->channel == VS_CH_REFEREE) vs_event_text(&m->as.referee.event, c->event, sizeof c->event);
  return m->channel == VS_CH_TRUTH || m->channel == VS_CH_STATE;
}

// Every world of one channel: the truth where the log has it.
static vs_status write_frames(view_command *c, vs_bus_log *log, vs_channel channel, FILE *out, int *count,
                              vs_error *err) {
  static vs_message m;
  int64_t first_us = 0;
  double last_s = -1;
  vs_bus_log_rewind(log);
  for (*count = 0;;) {
    vs_log_event e;
    vs_channel of;
    bool end;
    char text[1024];
    vs_status s = vs_bus_log_next(log, &e, &end, err);
    if (s != VS_OK || end) return s;
    if (!vs_channel_parse(e.channel, &of) || of == VS_CH_IMAGE) continue;
    if (vs_message_decode(of, e.data, e.size, &m, NULL, NULL) != VS_OK || !keep(c, &m) || of != channel) continue;
    // The moment it belongs to; a match faster than real time is logged within a second.
    int64_t at_us = m.utime_capture_us ? m.utime_capture_us : e.utime_us;
    if (*count == 0) first_us = at_us;
    double time_s = 1e-6 * (double)(at_us - first_us);
    if (time_s < last_s + FRAME_STEP_S && time_s >= last_s && !*c->event) continue;
    int n = vs_view_frame(time_s, &m.as.world.world, &m.as.world.game, (const vs_wheels(*)[VS_TEAM_MOST])c->wheels,
                          c->event, text, sizeof text);
    c->event[0] = '\0';
    last_s = time_s;
    fprintf(out, "%s\n", *count ? "," : "");
    fwrite(text, 1, (size_t)n < sizeof text ? (size_t)n : sizeof text - 1, out);
    ++*count;
  }
}

static vs_status read_log(view_command *c, const char *path, char **data, size_t *size, vs_error *err) {
  vs_bus_log *log;
  int count = 0;
  vs_status s = vs_bus_log_open(path, &log, err);
  if (s != VS_OK) return s;
  for (vs_channel channel = VS_CH_TRUTH; channel <= VS_CH_STATE && s == VS_OK && count == 0; channel++) {
    free(*data);
    *data = NULL;
    FILE *out = open_memstream(data, size);
    if (!out) {
      s = vs_fail(err, VS_FAIL, "out of memory");
      break;
    }
    fprintf(out, "{\"live\": false, \"frames\": [");
    s = write_frames(c, log, channel, out, &count, err);
    fprintf(out, "]}");
    fclose(out);
    if (s != VS_OK && count > 0) { // cut off: what came before is good
      fprintf(stderr, "vsss view: %s; shown up to there\n", err->text);
      s = VS_OK;
    }
  }
  vs_bus_log_close(log);
  if (s == VS_OK && count == 0)
    s = vs_fail(err, VS_FAIL, "%s: no VSSS_TRUTH or VSSS_STATE in it: nothing to show", path);
  return s;
}

static void on_message(const vs_message *m, void *user) {
  view_command *c = user;
  char text[1100];
  if (!keep(c, m)) return;
  if (m->channel == VS_CH_TRUTH) c->truth = true;
  if (m->channel == VS_CH_STATE && c->truth) return;
  int64_t now_us = vs_clock_monotonic_us();
  if (now_us - c->sent_us < 25000 && !*c->event) return;
  c->sent_us = now_us;
  int n = vs_view_frame(1e-6 * (double)now_us, &m->as.world.world, &m->as.world.game,
                        (const vs_wheels(*)[VS_TEAM_MOST])c->wheels, c->event, text, sizeof text);
  c->event[0] = '\0';
  if (n < 1 || (size_t)n + 24 > sizeof text) return;
  // The frame's last field: how old it is, from its capture to here.
  n += snprintf(text + n - 1, sizeof text - (size_t)n + 1, ",%.1f]",
                1e-3 * (double)(vs_clock_wall_us() - m->utime_capture_us)) -
       1;
  vs_view_send(c->view, text, (size_t)n);
}

static vs_status follow(view_command *c, vs_error *err) {
  vs_bus *bus = NULL;
  vs_status s = vs_bus_open(c->lcm, &bus, err);
  const vs_channel channels[] = {VS_CH_TRUTH, VS_CH_STATE, VS_CH_CMD, VS_CH_REFEREE};
  for (int k = 0; k < 4 && s == VS_OK; k++) s = vs_bus_subscribe(bus, channels[k], false, on_message, c, err);
  int64_t until_us = vs_clock_monotonic_us() + (int64_t)(1e6 * c->seconds);
  while (s == VS_OK && !vs_cli_interrupted() && (c->seconds == 0 || vs_clock_monotonic_us() < until_us))
    s = vs_bus_handle(bus, 100, NULL, err);
  vs_bus_close(bus);
  return s;
}

int cmd_view(int argc, char **argv) {
  view_command c = {.address = "127.0.0.1", .port = 8080};
  const vs_flag flags[] = {
      {"live", VS_FLAG_SWITCH, &c.live, NULL, "what is on LCM now: sim --realtime, field, rig", 0, 0},
      {"lcm", VS_FLAG_TEXT, &c.lcm, "URL", "where to listen (LCM_DEFAULT_URL, else " VS_BUS_DEFAULT_URL ")", 0, 0},
      {"port", VS_FLAG_INT, &c.port, "N", "of the page", 1, 65535},
      {"address", VS_FLAG_TEXT, &c.address, "IP", "0.0.0.0 shows it to the network too", 0, 0},
      {"seconds", VS_FLAG_REAL, &c.seconds, "S", "then end; 0: until Ctrl-C", 0, 864000},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  vs_flag_list words = {0};
  bool help;
  vs_error err = {0};
  char page[512], *data = NULL;
  size_t size = 0;
  vs_status s =
      vs_args_parse(argc, argv, "view LOG | --live",
                    "A page in the browser: field, robots, ball, trails, score, referee, commands. A log (serve\n"
                    "--record, league, lcm-logger) with scrubbing and speed, or live.",
                    flags, &words, &help, &err);
  if (help) return 0;
  if (s == VS_OK && words.count != (c.live ? 0 : 1)) s = vs_fail(&err, VS_USAGE, "give a log, or --live without one");
  if (s == VS_OK) s = vs_path_find("deploy/view/index.html", page, sizeof page, &err);
  if (s == VS_OK && !c.live) s = read_log(&c, words.value[0], &data, &size, &err);
  static char nothing[] = "{\"live\": true, \"frames\": []}";
  const char *shown = c.live ? nothing : data;
  vs_cli_catch_interrupts(); // before anyone can see the page
  if (s == VS_OK) s = vs_view_open(page, shown, c.live ? strlen(nothing) : size, c.address, c.port, &c.view, &err);
  if (s == VS_OK) {
    printf("the page is on port %d of %s (Ctrl-C ends)\n", c.port, c.address);
    fflush(stdout);
    int64_t until_us = vs_clock_monotonic_us() + (int64_t)(1e6 * c.seconds);
    if (c.live) s = follow(&c, &err);
    while (!c.live && !vs_cli_interrupted() && (c.seconds == 0 || vs_clock_monotonic_us() < until_us))
      vs_clock_sleep_until_us(vs_clock_monotonic_us() + 50000);
  }
  vs_view_close(c.view);
  free(data);
  return s == VS_OK ? 0 : vs_cli_error("view", &err);
}
