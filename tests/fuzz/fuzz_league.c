// Fuzzes src/league_net/messages.c and league_log.c: what vsss serve and field --camera firasim: hear, and the file of serve --replay.
// The first byte chooses, the others are the datagram or the file.
#include <math.h>

#include "fuzz.h"
#include "vsss/league_log.h"
#include "vsss/league_messages.h"

enum { PACKET_DEGREES, PACKET_RADIANS, ENVIRONMENT, CALL, PLACEMENT, MESSAGES, LOG = MESSAGES, CHOICES };

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  uint8_t bytes[1 + VS_LEAGUE_DATAGRAM_MAX];
  vs_fira_packet p = {.commands = 1, .places_ball = true, .robots = 1};
  p.command[0].wheels = (vs_wheels){10, -10};
  p.place[0].team = VS_YELLOW;
  p.place[0].pose = (vs_pose){0.1, 0.2, 1};
  vs_fira_environment e = {.step = 16, .goals = {1, 2}};
  e.world.ball = (vs_ball){.x_m = 0.1, .valid = true};
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    e.world.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE] = (vs_robot){.pose = {0.1 * i, 0.2, 0.3}, .valid = true};
  const vs_ref_command call = {VS_FOUL_FREE_BALL, -1, 3, 12.5, 2};
  const vs_ref_placement placement = {
      .team = VS_YELLOW, .given = {true, false, true}, .pose = {{0.6, 0, 3}, {0}, {0.2, 0.1, 3}}};
  for (int k = 0; k < MESSAGES; k++) {
    size_t size = k == ENVIRONMENT ? vs_fira_environment_encode(&e, bytes + 1, sizeof bytes - 1)
                  : k == CALL      ? vs_ref_command_encode(&call, bytes + 1, sizeof bytes - 1)
                  : k == PLACEMENT ? vs_ref_placement_encode(&placement, bytes + 1, sizeof bytes - 1)
                                   : vs_fira_packet_encode(&p, k == PACKET_DEGREES, bytes + 1, sizeof bytes - 1);
    char name[32];
    bytes[0] = (uint8_t)k;
    snprintf(name, sizeof name, "message%d", k);
    if (size) fuzz_seed(name, bytes, size + 1);
  }
  return 0;
}

static void check_pose(const vs_pose *p) {
  if (!isfinite(p->x_m) || !isfinite(p->y_m) || !(fabs(p->theta_rad) < 3.2)) abort();
}

static void check_packet(const vs_fira_packet *p) {
  if (p->commands < 0 || p->commands > VS_FIRA_ROWS || p->robots < 0 || p->robots > VS_FIRA_ROWS || p->dropped < 0)
    abort();
  for (int k = 0; k < p->commands; k++) {
    if (p->command[k].robot < 0 || p->command[k].robot >= VS_TEAM_SIZE || (unsigned)p->command[k].team >= VS_TEAMS)
      abort();
    if (!isfinite(p->command[k].wheels.left_radps) || !isfinite(p->command[k].wheels.right_radps)) abort();
  }
  for (int k = 0; k < p->robots; k++) {
    if (p->place[k].robot < 0 || p->place[k].robot >= VS_TEAM_SIZE || (unsigned)p->place[k].team >= VS_TEAMS) abort();
    check_pose(&p->place[k].pose);
  }
  if (p->places_ball && (!isfinite(p->ball.x_m) || !isfinite(p->ball.y_m) || !isfinite(p->ball.vx_mps))) abort();
}

static void read_log(const uint8_t *data, size_t size) {
  vs_league_log *log = NULL;
  vs_league_entry e;
  bool end = false;
  if (vs_league_log_open(fuzz_file(data, size), &log, NULL) != VS_OK) abort();
  for (size_t n = 0; vs_league_log_next(log, &e, &end, NULL) == VS_OK && !end; n++)
    if (e.size > sizeof e.data || (int)e.kind > VS_LEAGUE_VISION || n > size / 16) abort();
  vs_league_log_close(log, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_fira_packet p;
  vs_fira_environment e;
  vs_ref_command call;
  vs_ref_placement placement;
  if (size < 1) return 0;
  int what = data[0] % CHOICES;
  switch (what) {
  case LOG: read_log(data + 1, size - 1); return 0;
  case ENVIRONMENT:
    if (vs_fira_environment_decode(data + 1, size - 1, &e, NULL) == VS_OK && !vs_world_ok(&e.world)) abort();
    return 0;
  case CALL:
    if (vs_ref_command_decode(data + 1, size - 1, &call, NULL) != VS_OK) return 0;
    if ((int)call.foul < 0 || call.foul >= VS_FOULS || call.team < -1 || call.team >= VS_TEAMS || call.quadrant < 0 ||
        call.quadrant > 4 || !isfinite(call.timestamp_s))
      abort();
    return 0;
  case PLACEMENT:
    if (vs_ref_placement_decode(data + 1, size - 1, &placement, NULL) != VS_OK) return 0;
    if ((unsigned)placement.team >= VS_TEAMS) abort();
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      if (placement.given[i]) check_pose(&placement.pose[i]);
    return 0;
  default:
    if (vs_fira_packet_decode(data + 1, size - 1, what == PACKET_DEGREES, &p, NULL) == VS_OK) check_packet(&p);
    return 0;
  }
}
