// vsss bridge: VSSS_CMD from the bus to the robots' radio at 50 Hz, their telemetry back as VSSS_RADIO. For a radio on
// another computer than the camera's; vsss field holds its own.
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "vsss/bus.h"
#include "vsss/clock.h"
#include "vsss/radio_link.h"
#include "vsss/radio_serial.h"

#define REPORT_US 100000 // telemetry on the bus: 10 Hz
#define STATUS_US 500000 // the line on the terminal

typedef struct bridge {
  vs_team team;
  vs_bus *bus;
  vs_serial *serial;
  vs_radio_link link;
  int64_t commands, report_us, status_us;
  int32_t reports;
} bridge;

// Age by the sender's stamps; a sender whose clock runs ahead of ours counts as now.
static void on_command(const vs_message *m, void *user) {
  bridge *b = user;
  if (m->as.cmd.team != b->team) return;
  int64_t stamp_us = m->utime_capture_us > 0 && m->utime_capture_us < m->utime_us ? m->utime_capture_us : m->utime_us;
  int64_t age_us = vs_clock_wall_us() - stamp_us;
  vs_radio_link_command(&b->link, m->as.cmd.wheels, m->as.cmd.stop,
                        vs_clock_monotonic_us() - (age_us > 0 ? age_us : 0));
  b->commands++;
}

static void send_report(bridge *b, int64_t now_us) {
  vs_message m = {.channel = VS_CH_RADIO, .seq = b->reports++};
  vs_serial_stats stats = vs_serial_get_stats(b->serial);
  vs_radio_link_report(&b->link, vs_serial_device(b->serial), &stats, now_us, &m.as.radio);
  int64_t newest_us = -1;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (b->link.robot[i].heard && b->link.robot[i].heard_us > newest_us) newest_us = b->link.robot[i].heard_us;
  if (newest_us >= 0) m.utime_capture_us = vs_clock_wall_us() - (now_us - newest_us);
  // A report that cannot be sent is lost; the next one comes in 0.1 s.
  (void)vs_bus_publish(b->bus, &m, NULL);
}

static void show_status(const bridge *b, vs_progress *line) {
  if (!line->terminal) return;
  vs_serial_stats s = vs_serial_get_stats(b->serial);
  fprintf(stderr, "\r\033[K%s %s  %lld frames, %lld dropped  %s", vs_serial_device(b->serial), s.up ? "up" : "AWAY",
          (long long)s.sent, (long long)s.dropped, b->link.stopping ? "STOP" : "driving");
  if (b->link.command_age_us >= 0) fprintf(stderr, ", command %.0f ms old", (double)b->link.command_age_us * 1e-3);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_radio_robot_state *r = &b->link.robot[i];
    if (r->heard)
      fprintf(stderr, "  #%d %.1f V %d dBm", b->link.id[i], r->last.battery_mv * 1e-3, r->last.rssi_dbm);
    else
      fprintf(stderr, "  #%d silent", b->link.id[i]);
  }
  fflush(stderr);
}

static void turn(bridge *b, vs_progress *line) {
  int64_t now_us = vs_clock_monotonic_us();
  uint8_t bytes[512];
  size_t size = vs_radio_link_due(&b->link, now_us, bytes);
  if (size) vs_serial_write(b->serial, bytes, size, now_us);
  while ((size = vs_serial_read(b->serial, bytes, sizeof bytes, now_us)) > 0)
    vs_radio_link_receive(&b->link, bytes, size, now_us);
  if (now_us >= b->report_us) {
    b->report_us = now_us + REPORT_US;
    send_report(b, now_us);
  }
  if (now_us >= b->status_us) {
    b->status_us = now_us + STATUS_US;
    show_status(b, line);
  }
}

static vs_status loop(bridge *b, vs_error *err) {
  vs_progress line;
  vs_progress_start(&line);
  while (!vs_cli_interrupted()) {
    turn(b, &line);
    int64_t wait_us = b->link.next_us - vs_clock_monotonic_us();
    // Telemetry is looked for at least every 5 ms, so that its round trip is true.
    int wait_ms = wait_us <= 0 ? 0 : wait_us < 5000 ? (int)(wait_us / 1000) + 1 : 5;
    vs_status s = vs_bus_handle(b->bus, wait_ms, NULL, err);
    if (s != VS_OK) return s;
  }
  vs_progress_clear(&line);
  return VS_OK;
}

// Stops the robots whatever happened before.
static void stop(bridge *b) {
  for (int i = 0; i < VS_RADIO_STOP_FRAMES; i++) {
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    int64_t now_us = vs_clock_monotonic_us();
    vs_serial_write(b->serial, bytes, vs_radio_link_stop(&b->link, now_us, bytes), now_us);
    vs_clock_sleep_until_us(now_us + 5000);
  }
  vs_serial_drain(b->serial, 200);
}

static vs_status parse_ids(const char *text, uint8_t id[VS_TEAM_SIZE], vs_error *err) {
  int value[VS_TEAM_SIZE], end = 0;
  if (sscanf(text, "%d,%d,%d%n", &value[0], &value[1], &value[2], &end) != VS_TEAM_SIZE || text[end])
    return vs_fail(err, VS_USAGE, "--ids %s: expected three numbers, such as 0,1,2", text);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (value[i] < 0 || value[i] > 255) return vs_fail(err, VS_USAGE, "--ids %s: allowed are 0 to 255", text);
    id[i] = (uint8_t)value[i];
  }
  return VS_OK;
}

static vs_status run(bridge *b, const char *device, int baud, const char *url, vs_error *err) {
  vs_status s = vs_serial_open(device, baud, &b->serial, err);
  if (s == VS_OK) s = vs_bus_open(url, &b->bus, err);
  if (s == VS_OK) s = vs_bus_subscribe(b->bus, VS_CH_CMD, false, on_command, b, err);
  if (s == VS_OK) {
    printf("bridge: %s commands from %s to %s; Ctrl-C stops the robots and ends\n", vs_team_name(b->team),
           vs_bus_url(b->bus), vs_serial_device(b->serial));
    fflush(stdout);
    vs_cli_catch_interrupts();
    s = loop(b, err);
    stop(b);
    vs_serial_stats stats = vs_serial_get_stats(b->serial);
    printf("%lld commands, %lld frames sent, %lld dropped, %u telemetry frames, %u bad, device reopened %lld times\n",
           (long long)b->commands, (long long)stats.sent, (long long)stats.dropped, b->link.decoder.ok,
           b->link.decoder.bad, (long long)stats.reopened);
  }
  vs_bus_close(b->bus);
  vs_serial_close(b->serial);
  return s;
}

int cmd_bridge(int argc, char **argv) {
  const char *device = NULL, *url = NULL, *team = "blue", *ids = "0,1,2";
  int baud = VS_SERIAL_BAUD;
  const vs_flag flags[] = {
      {"radio", VS_FLAG_TEXT, &device, "DEV", "serial device, such as /dev/ttyUSB0", 0, 0},
      {"baud", VS_FLAG_INT, &baud, "N", "its speed", 0, 0},
      {"team", VS_FLAG_TEXT, &team, "TEAM", "whose commands: blue or yellow", 0, 0},
      {"ids", VS_FLAG_TEXT, &ids, "A,B,C", "the robots' numbers on the air", 0, 0},
      {"lcm", VS_FLAG_TEXT, &url, "URL", "the bus (LCM_DEFAULT_URL, else " VS_BUS_DEFAULT_URL ")", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_error err = {0};
  bool help;
  vs_status s = vs_args_parse(argc, argv, "bridge --radio DEV [flags]",
                              "Carries VSSS_CMD to the robots at 50 Hz; a command older than 150 ms stops them.", flags,
                              NULL, &help, &err);
  if (s == VS_OK && help) return 0;
  bridge b = {.team = VS_BLUE};
  uint8_t id[VS_TEAM_SIZE] = {0};
  if (s == VS_OK && !device) s = vs_fail(&err, VS_USAGE, "--radio is needed, such as --radio /dev/ttyUSB0");
  if (s == VS_OK && strcmp(team, "blue") != 0 && strcmp(team, "yellow") != 0)
    s = vs_fail(&err, VS_USAGE, "--team %s: allowed are blue and yellow", team);
  if (s == VS_OK) s = parse_ids(ids, id, &err);
  if (s == VS_OK) s = vs_radio_link_init(&b.link, id, &err);
  b.team = strcmp(team, "yellow") ? VS_BLUE : VS_YELLOW;
  if (s == VS_OK) s = run(&b, device, baud, url, &err);
  return s == VS_OK ? 0 : vs_cli_error("bridge", &err);
}
