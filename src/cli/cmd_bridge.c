// vsss bridge: VSSS_CMD from the bus to the robots' radio, their telemetry back as VSSS_RADIO. For a radio on another computer
// than the camera's; vsss field holds its own. The same safety table and the same radio thread as the field's.
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "operator.h"
#include "vsss/bus.h"
#include "vsss/clock.h"
#include "vsss/safety.h"
#include "vsss/sender.h"

#define REPORT_US 100000  // telemetry on the bus: 10 Hz
#define STATUS_US 500000  // the line on the terminal
#define REST_US   1000000 // with --go a FAULT ends by itself after it

typedef struct bridge {
  vs_team team;
  const char *device;
  vs_bus *bus;
  vs_sender *sender;
  vs_safety safety;
  bool go, armed, rearm;
  vs_msg_cmd command; // the newest
  int64_t decided_us; // when; monotonic
  vs_radio_link link; // copies, renewed every turn
  vs_serial_stats serial;
  int64_t commands, report_us, status_us;
  int32_t reports;
} bridge;

// The table's word on the newest command; now: it came in this moment.
static void judge(bridge *b, bool now) {
  int64_t now_us = vs_clock_monotonic_us();
  bool fault = b->safety.state == VS_SAFETY_FAULT;
  bool again = fault && (b->rearm || (b->go && now_us - b->safety.since_us > REST_US));
  b->rearm = false;
  vs_safety_input in = {.now_us = now_us,
                        .armed = b->armed && !again,
                        .referee = b->command.stop ? VS_EVENT_HALT : VS_EVENT_NONE,
                        .team = b->team,
                        .seen_elsewhere = true,
                        .command_us = b->decided_us};
  memcpy(in.wheels, b->command.wheels, sizeof in.wheels);
  vs_safety_state before = b->safety.state;
  vs_wheels out[VS_TEAM_SIZE];
  bool stop = vs_safety_step(&b->safety, &in, out) != VS_SAFETY_RUNNING;
  if (now || b->safety.state != before)
    vs_sender_command(b->sender, out, stop, b->decided_us ? b->decided_us : now_us, true);
}

// Age by the sender's stamps; a sender whose clock runs ahead of ours counts as now.
static void on_command(const vs_message *m, void *user) {
  bridge *b = user;
  if (m->as.cmd.team != b->team) return;
  int64_t stamp_us = m->utime_capture_us > 0 && m->utime_capture_us < m->utime_us ? m->utime_capture_us : m->utime_us;
  int64_t age_us = vs_clock_wall_us() - stamp_us;
  b->command = m->as.cmd;
  b->decided_us = vs_clock_monotonic_us() - (age_us > 0 ? age_us : 0);
  b->commands++;
  judge(b, true);
}

static void send_report(bridge *b, int64_t now_us) {
  vs_message m = {.channel = VS_CH_RADIO, .seq = b->reports++};
  vs_radio_link_report(&b->link, b->device, &b->serial, now_us, &m.as.radio);
  int64_t newest_us = -1;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (b->link.robot[i].heard && b->link.robot[i].heard_us > newest_us) newest_us = b->link.robot[i].heard_us;
  if (newest_us >= 0) m.utime_capture_us = vs_clock_wall_us() - (now_us - newest_us);
  // A report that cannot be sent is lost; the next one comes in 0.1 s.
  (void)vs_bus_publish(b->bus, &m, NULL);
}

static void show_status(const bridge *b, vs_progress *line) {
  if (!line->terminal) return;
  const char *why = vs_safety_reason(b->safety.state);
  fprintf(stderr, "\r\033[K%s %s  %lld frames, %lld dropped  %s%s", b->device, b->serial.up ? "up" : "AWAY",
          (long long)b->serial.sent, (long long)b->serial.dropped, b->link.stopping ? "STOP " : "driving",
          b->link.stopping ? why : "");
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
  judge(b, false);
  vs_sender_state(b->sender, &b->link, &b->serial);
  if (now_us >= b->report_us) {
    b->report_us = now_us + REPORT_US;
    send_report(b, now_us);
  }
  if (now_us >= b->status_us) {
    b->status_us = now_us + STATUS_US;
    show_status(b, line);
  }
}

static vs_status loop(bridge *b, vs_operator *operator_, vs_error *err) {
  vs_progress line;
  vs_progress_start(&line);
  while (!vs_cli_interrupted()) {
    char unknown[24];
    vs_order order = vs_operator_poll(operator_, unknown);
    if (order == VS_ORDER_QUIT) break;
    if (order != VS_ORDER_NONE) b->armed = b->rearm = order == VS_ORDER_GO;
    turn(b, &line);
    vs_status s = vs_bus_handle(b->bus, 5, NULL, err);
    if (s != VS_OK) return s;
  }
  vs_progress_clear(&line);
  return VS_OK;
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

static vs_status run(bridge *b, const vs_sender_def *radio, const char *url, bool remote, vs_error *err) {
  vs_operator operator_;
  vs_safety_init(&b->safety, vs_clock_monotonic_us());
  vs_status s = vs_sender_new(radio, &b->sender, err);
  if (s == VS_OK) s = vs_bus_open(url, &b->bus, err);
  if (s == VS_OK)
    s = remote ? vs_bus_subscribe(b->bus, VS_CH_CMD, false, on_command, b, err)
               : vs_bus_subscribe_near(b->bus, VS_CH_CMD, on_command, b, err);
  if (s == VS_OK) s = vs_operator_open(NULL, &operator_, err);
  if (s == VS_OK) {
    printf("bridge: %s commands from %s to %s; Ctrl-C stops the robots and ends\n", vs_team_name(b->team),
           vs_bus_url(b->bus), b->device);
    if (radio->wire && radio->wire->lacks) printf("warning: wire %s: %s\n", radio->wire->name, radio->wire->lacks);
    if (!b->go) printf("the robots stand until they are told to go; keys: %s\n", VS_OPERATOR_KEYS);
    fflush(stdout);
    vs_cli_catch_interrupts();
    vs_cli_before_the_end(vs_sender_last_stop);
    vs_sender_stop_at_crash();
    s = loop(b, &operator_, err);
    vs_operator_close(&operator_);
    vs_sender_state(b->sender, &b->link, &b->serial);
  }
  bool began = b->sender != NULL && b->bus != NULL;
  vs_sender_free(b->sender); // stops the robots whatever happened before
  if (began)
    printf("%lld commands, %lld frames sent, %lld dropped, %u telemetry frames, %u bad, device reopened %lld times\n",
           (long long)b->commands, (long long)b->serial.sent, (long long)b->serial.dropped, b->link.decoder.ok,
           b->link.decoder.bad, (long long)b->serial.reopened);
  if (began && vs_bus_far(b->bus))
    printf("%lld messages of other machines were not obeyed; --lcm-remote hears them\n", (long long)vs_bus_far(b->bus));
  vs_bus_close(b->bus);
  return s;
}

int cmd_bridge(int argc, char **argv) {
  const char *device = NULL, *url = NULL, *team = "blue", *ids = NULL, *path = NULL, *wire = NULL;
  int baud = 0;
  bool remote = false;
  static vs_field_config config;
  bridge b = {.team = VS_BLUE};
  const vs_flag flags[] = {
      {"radio", VS_FLAG_TEXT, &device, "DEV", "serial device, such as /dev/ttyUSB0", 0, 0},
      {"baud", VS_FLAG_INT, &baud, "N", "its speed; default: the configuration's", 0, 0},
      {"team", VS_FLAG_TEXT, &team, "TEAM", "whose commands: blue or yellow", 0, 0},
      {"ids", VS_FLAG_TEXT, &ids, "A,B,C", "the robots' numbers on the air; default: the configuration's", 0, 0},
      {"wire", VS_FLAG_TEXT, &wire, "NAME",
       "what they speak: vsss, pequi-xbee, sysmic, sysmic-vw, neon, unball; default: the configuration's", 0, 0},
      {"config", VS_FLAG_TEXT, &path, "FILE", "its [radio] has numbers and key; default: deploy/config/field.ini", 0,
       0},
      {"lcm-remote", VS_FLAG_SWITCH, &remote, NULL, "obey commands that another machine sends, too", 0, 0},
      {"go", VS_FLAG_SWITCH, &b.go, NULL, "the robots may move at once, and after a fault by themselves", 0, 0},
      {"lcm", VS_FLAG_TEXT, &url, "URL", "the bus (LCM_DEFAULT_URL, else " VS_BUS_DEFAULT_URL ")", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_error err = {0};
  bool help;
  vs_status s =
      vs_args_parse(argc, argv, "bridge --radio DEV [flags]",
                    "Carries VSSS_CMD to the robots at 50 Hz; a command older than 150 ms stops them. They stand\n"
                    "until they are told to go (keys: " VS_OPERATOR_KEYS ").",
                    flags, NULL, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s == VS_OK && !device) s = vs_fail(&err, VS_USAGE, "--radio is needed, such as --radio /dev/ttyUSB0");
  if (s == VS_OK && strcmp(team, "blue") != 0 && strcmp(team, "yellow") != 0)
    s = vs_fail(&err, VS_USAGE, "--team %s: allowed are blue and yellow", team);
  if (s == VS_OK) s = vs_field_config_load(path, &config, &err);
  vs_sender_def radio = {
      .device = device, .baud = baud ? baud : config.def.baud, .key = config.def.key, .wire = config.def.wire};
  if (s == VS_OK && wire && vs_wire_find(wire, &radio.wire, &err) != VS_OK) s = vs_fail_prefix(&err, "--wire");
  memcpy(radio.id, config.def.radio_id, sizeof radio.id);
  if (s == VS_OK && ids) s = parse_ids(ids, radio.id, &err);
  b.team = strcmp(team, "yellow") ? VS_BLUE : VS_YELLOW;
  b.device = device;
  b.armed = b.go;
  if (s == VS_OK) s = run(&b, &radio, url, remote, &err);
  return s == VS_OK ? 0 : vs_cli_error("bridge", &err);
}
