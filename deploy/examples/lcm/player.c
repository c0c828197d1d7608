// A team in a process of its own, in plain C over LCM: every robot chases the ball. Answers each question of a match.
//
//   make && ./player yellow &
//   ../../../vsss sim --blue emc: --yellow lcm:yellow
//
// LCM has the same types for C++, Java, Python, Lua and C#: lcm-gen makes them from lcm_types, as the Makefile does for C.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <lcm/lcm.h>

#include "vsss_cmd_t.h"
#include "vsss_world_t.h"

static int team; // 0 blue, 1 yellow

// Wheel speeds in rad/s that turn robot i to the ball and drive there: 0.7 m/s at most, 30 mm wheels, 35 mm from the
// middle. Angles and positions are in the field's frame, so it makes no difference which way a team plays.
static void chase(const vsss_world_t *w, int i, double *left_radps, double *right_radps) {
  double dx = w->ball_x_m - w->robot_x_m[team][i], dy = w->ball_y_m - w->robot_y_m[team][i];
  double error = remainder(atan2(dy, dx) - w->robot_theta_rad[team][i], 2.0 * M_PI);
  double forward_mps = 0.7 * cos(error), turn_mps = 0.035 * 8.0 * error;
  *left_radps = (forward_mps - turn_mps) / 0.03;
  *right_radps = (forward_mps + turn_mps) / 0.03;
}

static void on_state(const lcm_recv_buf_t *buffer, const char *channel, const vsss_world_t *w, void *user) {
  (void)channel;
  if (w->asks_team != team) return; // a state for others, or one that asks nobody
  static int32_t seq;
  vsss_cmd_t c;
  memset(&c, 0, sizeof c);
  c.utime = buffer->recv_utime;
  c.utime_capture = w->utime_capture;
  c.seq = seq++;
  c.state_seq = w->seq; // which question this answers
  c.team = (int8_t)team;
  c.source = "examples/lcm";
  for (int i = 0; i < 3; i++) chase(w, i, &c.left_radps[i], &c.right_radps[i]);
  vsss_cmd_t_publish(user, "VSSS_CMD", &c);
}

int main(int argc, char **argv) {
  if (argc < 2 || (strcmp(argv[1], "blue") && strcmp(argv[1], "yellow"))) {
    fprintf(stderr, "usage: player blue|yellow [LCM-URL]\n");
    return 2;
  }
  team = !strcmp(argv[1], "yellow");
  lcm_t *lcm = lcm_create(argc > 2 ? argv[2] : NULL); // NULL: LCM_DEFAULT_URL, else LCM's default
  if (!lcm) return 1;
  vsss_world_t_subscribe(lcm, "VSSS_STATE", on_state, lcm);
  while (lcm_handle(lcm) == 0) {
  }
  return 1;
}
