// The league's server: how punctually a client sees the world at real time, and how fast a match with two clients on the
// network goes when it waits for nobody but them. Server and clients are threads of this program, joined by loopback.
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "vsss/clock.h"
#include "vsss/realtime.h"
#include "vsss/serve.h"
#include "vsss/udp.h"

enum { REAL_TIME_S = 60, SYNC_S = 60, RUNS = 3 };

static void give_up(const vs_error *err) {
  fprintf(stderr, "%s\n", err->text);
  exit(1);
}

// A scripted team: every robot turns towards the ball and drives.
typedef struct client {
  vs_team team;
  vs_ports ports;
  atomic_bool stop;
  vs_histogram jitter; // |time between two worlds - period|
  int64_t period_us, worlds, lost;
} client;

static void *play(void *context) {
  client *c = context;
  vs_error err = {0};
  vs_udp in, out;
  if (vs_udp_join(VS_VISION_GROUP, c->ports.vision, NULL, &in, &err) != VS_OK ||
      vs_udp_sender("127.0.0.1", c->ports.command, NULL, &out, &err) != VS_OK)
    give_up(&err);
  vs_fira_packet p = {.commands = VS_TEAM_SIZE};
  const vs_udp *list[] = {&in};
  uint8_t bytes[1024];
  int64_t before_us = 0;
  uint32_t before_step = 0;
  for (bool first = true; !c->stop; first = false) {
    size_t size;
    vs_fira_environment e;
    if (!first && !vs_udp_wait(list, 1, vs_clock_monotonic_us() + 100000)) continue;
    bool got =
        vs_udp_receive(&in, bytes, sizeof bytes, &size) && vs_fira_environment_decode(bytes, size, &e, NULL) == VS_OK;
    if (!got && !first) continue;
    int64_t now_us = vs_clock_monotonic_us();
    if (got && before_us) {
      int64_t off_us = now_us - before_us - c->period_us;
      vs_histogram_add(&c->jitter, off_us < 0 ? -off_us : off_us, now_us);
      if (e.step - before_step > 17) c->lost++;
    }
    if (got) before_us = now_us, before_step = e.step, c->worlds++;
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      p.command[i].team = c->team;
      p.command[i].robot = i;
      if (!got) continue;
      const vs_robot *r = &e.world.robot[c->team][i];
      double left = (e.world.ball.y_m - r->pose.y_m) * 40, ahead = (e.world.ball.x_m - r->pose.x_m) * 40;
      p.command[i].wheels = (vs_wheels){ahead - left, ahead + left};
    }
    size = vs_fira_packet_encode(&p, true, bytes, sizeof bytes);
    vs_udp_send(&out, bytes, size);
  }
  vs_udp_close(&in);
  vs_udp_close(&out);
  return NULL;
}

// What the machine itself allows: a loop that only sleeps until the next of 60 moments a second.
typedef struct sleeper {
  atomic_bool stop;
  vs_histogram jitter;
} sleeper;

static void *sleep_on(void *context) {
  sleeper *s = context;
  int64_t period_us = 1000000 / 60, due_us = vs_clock_monotonic_us(), before_us = 0;
  vs_realtime_fine_timers();
  while (!s->stop) {
    vs_clock_sleep_until_us(due_us += period_us);
    int64_t now_us = vs_clock_monotonic_us(), off_us = now_us - before_us - period_us;
    if (before_us) vs_histogram_add(&s->jitter, off_us < 0 ? -off_us : off_us, now_us);
    before_us = now_us;
  }
  return NULL;
}

static double thread_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Returns times real time; *busy: by the processor's time that the server's thread took, whatever else the machine does.
static double run(const vs_model *model, bool sync, double seconds, client client[VS_TEAMS], double *busy) {
  vs_error err = {0};
  vs_serve_def def = vs_serve_def_default();
  def.match.model = model;
  def.match.mode = VS_REFEREE_NONE;
  def.sync = sync;
  char shift[16];
  snprintf(shift, sizeof shift, "+%d", 30000 + (int)(getpid() % 600) * 15);
  if (vs_ports_parse(shift, &def.ports, &err) != VS_OK ||
      vs_robot_preset_find("firasim", &def.match.robot, &err) != VS_OK)
    give_up(&err);
  vs_serve *server;
  if (vs_serve_new(&def, &server, &err) != VS_OK) give_up(&err);
  pthread_t thread[VS_TEAMS];
  for (int t = 0; t < VS_TEAMS; t++) {
    memset(&client[t], 0, sizeof client[t]);
    client[t].team = (vs_team)t;
    client[t].ports = def.ports;
    client[t].period_us = 1000000 / 60;
    pthread_create(&thread[t], NULL, play, &client[t]);
  }
  vs_hosted_said said;
  while (!vs_serve_everybody_here(server))
    if (vs_serve_frame(server, &said, NULL, 0, &err) != VS_OK) give_up(&err);
  int64_t start_us = vs_clock_monotonic_us();
  double start_s = thread_s();
  for (int k = 0; k < 60 * seconds; k++)
    if (vs_serve_frame(server, &said, NULL, 0, &err) != VS_OK) give_up(&err);
  double wall_s = 1e-6 * (double)(vs_clock_monotonic_us() - start_us);
  *busy = seconds / (thread_s() - start_s);
  for (int t = 0; t < VS_TEAMS; t++) client[t].stop = true;
  for (int t = 0; t < VS_TEAMS; t++) pthread_join(thread[t], NULL);
  vs_serve_free(server);
  return seconds / wall_s;
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void print_jitter(const char *what, const char *suffix, const vs_histogram *jitter) {
  printf("bench %s%s_p50 %.3f ms\n", what, suffix, 1e-3 * vs_histogram_quantile_us(jitter, 0.5));
  printf("bench %s%s_p99 %.3f ms\n", what, suffix, 1e-3 * vs_histogram_quantile_us(jitter, 0.99));
  printf("bench %s%s_max %.3f ms\n", what, suffix, 1e-3 * (double)jitter->max_us);
}

// The load of the machine is in the figures: a sleeping loop beside the server tells how much of it is not the server's.
static void real_time(const vs_model *model, const char *suffix) {
  static client client[VS_TEAMS];
  static sleeper sleeper;
  double busy;
  pthread_t thread;
  memset(&sleeper, 0, sizeof sleeper);
  pthread_create(&thread, NULL, sleep_on, &sleeper);
  run(model, false, REAL_TIME_S, client, &busy);
  sleeper.stop = true;
  pthread_join(thread, NULL);
  const struct client *c = &client[VS_BLUE];
  print_jitter("serve_jitter", suffix, &c->jitter);
  print_jitter("sleep_jitter", suffix, &sleeper.jitter);
  printf("bench serve_lost_datagrams%s %lld of_%lld\n", suffix, (long long)c->lost, (long long)c->worlds);
}

int main(void) {
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    fprintf(stderr, "%s\n", err.text);
    return 0;
  }
  vs_model_def def = vs_model_def_default(VS_DRIVE_CONTACT);
  def.frame_hz = 60;
  def.substeps_per_frame = 3;
  vs_model *model;
  if (vs_model_load(&def, &model, &err) != VS_OK) give_up(&err);
  client client[VS_TEAMS];
  double speed[RUNS], busy[RUNS];
  for (int k = 0; k < RUNS; k++) speed[k] = run(model, true, SYNC_S, client, &busy[k]);
  qsort(speed, RUNS, sizeof *speed, compare);
  qsort(busy, RUNS, sizeof *busy, compare);
  printf("bench serve_sync_two_clients %.1f times_real_time\n", speed[RUNS / 2]);
  printf("bench serve_sync_server_alone %.1f times_real_time_of_its_processor\n", busy[RUNS / 2]);
  real_time(model, "");
  // As with --rt 50, where the machine allows it.
  if (vs_realtime_try(50, &err) != VS_OK)
    fprintf(stderr, "without real-time priority: %s\n", err.text);
  else
    real_time(model, "_rt");
  vs_model_free(model);
  return 0;
}
