// vsss replay: what a log of lcm-logger holds, as text, as JSON, as a video, or sent once more.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "replay.h"
#include "vsss/clock.h"

vs_status replay_publish(vs_bus_log *log, const vs_flag_list *wanted, const char *url, double speed, vs_error *err) {
  vs_bus *bus;
  vs_status s = vs_bus_open(url, &bus, err);
  if (s != VS_OK) return s;
  vs_progress progress;
  vs_progress_start(&progress);
  int64_t start_us = vs_clock_monotonic_us(), first_us = 0, sent = 0;
  vs_bus_log_rewind(log);
  while (s == VS_OK && !vs_cli_interrupted()) {
    vs_log_event event;
    bool end;
    s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) break;
    if (event.number == 0) first_us = event.utime_us;
    if (wanted->count && !replay_wants(wanted, event.channel)) continue;
    // Time stamps may be anything: at most ten years from now.
    double after_us = ((double)event.utime_us - (double)first_us) / speed;
    int64_t due_us = start_us + (int64_t)fmax(fmin(after_us, 3e14), -3e14);
    // In short sleeps, so that Ctrl-C is heard in a long pause.
    for (int64_t now_us; !vs_cli_interrupted() && (now_us = vs_clock_monotonic_us()) < due_us;)
      vs_clock_sleep_until_us(due_us < now_us + 100000 ? due_us : now_us + 100000);
    if (vs_cli_interrupted()) break;
    s = vs_bus_publish_raw(bus, event.channel, event.data, event.size, err);
    sent++;
    vs_progress_show(&progress, vs_bus_log_fraction(log), event.channel);
  }
  vs_progress_clear(&progress);
  if (s == VS_OK)
    printf("%lld messages sent to %s in %.1f s\n", (long long)sent, vs_bus_url(bus),
           (double)(vs_clock_monotonic_us() - start_us) * 1e-6);
  vs_bus_close(bus);
  return s;
}

int cmd_replay(int argc, char **argv) {
  replay_def def = {.show = true};
  const char *video = NULL, *url = NULL, *mcap = NULL;
  bool publish = false, check = false;
  double speed = 1.0;
  int fps = 30;
  const vs_flag flags[] = {
      {"channel", VS_FLAG_LIST, &def.wanted, "NAME", "show every message of this channel; repeatable", 0, 0},
      {"json", VS_FLAG_SWITCH, &def.json, NULL, "one JSON object per line, the summary last", 0, 0},
      {"video", VS_FLAG_TEXT, &video, "FILE", "draw it into a video, such as out.mp4", 0, 0},
      {"mcap", VS_FLAG_TEXT, &mcap, "FILE", "export worlds, commands and events for Foxglove-like tools, as out.mcap",
       0, 0},
      {"fps", VS_FLAG_INT, &fps, "N", "pictures per second of the video", 1, 120},
      {"publish", VS_FLAG_SWITCH, &publish, NULL, "send the messages again, as they came", 0, 0},
      {"check", VS_FLAG_SWITCH, &check, NULL, "of 'field --record': compute all again; the same commands, bit for bit?",
       0, 0},
      {"speed", VS_FLAG_REAL, &speed, "X", "times faster than they came", 0.01, 1000},
      {"lcm", VS_FLAG_TEXT, &url, "URL", "where to send to (LCM_DEFAULT_URL, else " VS_BUS_DEFAULT_URL ")", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_flag_list words = {0};
  vs_error err = {0};
  bool help;
  vs_status s = vs_args_parse(
      argc, argv, "replay LOG [flags]",
      "Shows a log of lcm-logger or of 'field --record': the referee's events, the score and what it holds.", flags,
      &words, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s == VS_OK && (video != NULL) + (mcap != NULL) + publish + check > 1)
    s = vs_fail(&err, VS_USAGE, "--video, --mcap, --publish, --check: choose one");
  if (s == VS_OK && words.count != 1)
    s = vs_fail(&err, VS_USAGE, "expected one log file, such as 'vsss replay lcmlog-2026-11-22.00'");
  vs_bus_log *log = NULL;
  if (s == VS_OK) s = vs_bus_supported(&err);
  if (s == VS_OK) s = vs_bus_log_open(words.value[0], &log, &err);
  if (s != VS_OK) return vs_cli_error("replay", &err);

  vs_cli_catch_interrupts();
  if (check) {
    s = replay_check(log, words.value[0], &err);
    vs_bus_log_close(log);
    return s == VS_OK ? 0 : vs_cli_error("replay", &err);
  }
  replay_summary *summary = calloc(1, sizeof *summary);
  def.show = !publish && !video && !mcap;
  s = summary ? replay_scan(log, &def, summary, &err) : vs_fail(&err, VS_FAIL, "out of memory");
  // What came before a damaged place is used all the same; the passes below stop there with the same error.
  if (summary && summary->events) {
    if (def.wanted.count && !summary->found_wanted && s == VS_OK)
      s = vs_fail(&err, VS_FAIL, "%.200s: no messages of channel %s; without --channel its channels are listed",
                  words.value[0], def.wanted.value[0]);
    else if (video)
      s = replay_video(log, summary, video, fps, &err);
    else if (mcap)
      s = replay_mcap(log, summary, mcap, &err);
    else if (publish)
      s = replay_publish(log, &def.wanted, url, speed, &err);
    else
      replay_print_summary(words.value[0], summary, def.json);
  }
  fflush(stdout);
  free(summary);
  vs_bus_log_close(log);
  return s == VS_OK ? 0 : vs_cli_error("replay", &err);
}
