// A player in a process of its own. A keeper, forked while this process is still simple, forks the worker that opens and
// runs the player, and the next one when that ends.
#define _GNU_SOURCE // ppoll, close_range
#include "vsss/isolate.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "policy_internal.h"
#include "vsss/clock.h"

#define OPEN_MS          30000 // a large model on a slow disk
#define QUICK_LIFE_US    5000000
#define RESTART_PAUSE_US 50000 // after the second quick death in a row, then doubling
#define RESTART_MAX_US   1000000

typedef enum verb { HELLO, RESET, STEP, ACT } verb;

typedef struct request {
  verb verb;
  uint32_t seq;
  uint64_t seed;
  double dt_s;
  vs_world view;
  vs_game game;
  float obs[VS_TEAM_SIZE * VS_OBS_SIZE];
} request;

typedef struct reply {
  verb verb;
  uint32_t seq;
  vs_status status;
  vs_error error;
  vs_player_about about; // of HELLO
  vs_wheels wheels[VS_TEAM_MOST];
  float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
} reply;

typedef struct vs_player_process {
  char *uri;
  int talk; // packets with the worker, whichever lives
  int keep; // to the keeper: 'k' ends the worker; from it: the wait status of each that ended
  pid_t keeper;
  int patience_ms;
  bool ready;
  bool greeted; // a new worker has said hello
  bool late;    // the last call was given up, its worker still runs
  uint32_t seq;
  uint64_t seed;
  int64_t failures;
  request request;
  reply reply;
} vs_player_process;

// ---- the worker

static void answer(vs_player *player, const request *q, reply *a) {
  a->verb = q->verb;
  a->seq = q->seq;
  memset(&a->error, 0, sizeof a->error);
  if (q->verb == RESET) a->status = vs_player_reset(player, q->seed, &a->error);
  if (q->verb == STEP) a->status = vs_player_step(player, &q->view, &q->game, q->dt_s, a->wheels, &a->error);
  if (q->verb == ACT) a->status = vs_player_act(player, q->obs, VS_TEAM_SIZE, a->action, &a->error);
}

// Ends with its parent's interest: when nobody holds the other end any more.
static void work(const char *uri, int talk) {
  static request q;
  static reply a;
  vs_player *player = NULL;
  a.verb = HELLO;
  a.status = vs_player_open(uri, &player, &a.error);
  if (a.status == VS_OK) {
    a.about = (vs_player_about){
        .sees = vs_player_kind(player), .rate_hz = vs_player_rate_hz(player), .divisions = vs_player_divisions(player)};
    snprintf(a.about.name, sizeof a.about.name, "%s", vs_player_name(player));
  }
  while (send(talk, &a, sizeof a, MSG_NOSIGNAL) == (ssize_t)sizeof a && a.status == VS_OK) {
    ssize_t n;
    do n = recv(talk, &q, sizeof q, 0);
    while (n < 0 && errno == EINTR);
    if (n != (ssize_t)sizeof q) _exit(0);
    answer(player, &q, &a);
  }
  _exit(1);
}

// ---- the keeper

static pid_t fork_worker(const char *uri, int talk, int keep) {
  pid_t parent = getpid(), child = fork();
  if (child) return child;
  close(keep);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  work(uri, talk);
  return 0;
}

// The worker's end, or an order to bring it about; false: our own parent is gone.
static bool watch(pid_t worker, int keep, int *status) {
  for (bool killed = false;;) {
    if (waitpid(worker, status, WNOHANG) == worker) return true;
    struct pollfd wait = {.fd = keep, .events = POLLIN};
    // SIGCHLD, open during this call alone, ends it.
    sigset_t open;
    sigprocmask(SIG_SETMASK, NULL, &open);
    sigdelset(&open, SIGCHLD);
    if (ppoll(&wait, 1, NULL, &open) <= 0 || killed) continue;
    char order;
    ssize_t n = recv(keep, &order, 1, MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    kill(worker, SIGKILL); // not reaped yet: the number is still its own
    if (n <= 0) return false;
  }
}

static void on_child(int number) { (void)number; }

static void keep_alive(const char *uri, int talk, int keep) {
  sigset_t child;
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child, NULL);
  struct sigaction action = {.sa_handler = on_child};
  sigaction(SIGCHLD, &action, NULL);
  int64_t pause_us = 0;
  for (;;) {
    int64_t born_us = vs_clock_monotonic_us();
    int status = 0;
    pid_t worker = fork_worker(uri, talk, keep);
    if (worker > 0 && !watch(worker, keep, &status)) _exit(0);
    bool quick = vs_clock_monotonic_us() - born_us < QUICK_LIFE_US;
    if (send(keep, &status, sizeof status, MSG_NOSIGNAL) != (ssize_t)sizeof status) _exit(0);
    if (pause_us) usleep((useconds_t)pause_us);
    pause_us = !quick ? 0 : pause_us ? pause_us * 2 : RESTART_PAUSE_US;
    if (pause_us > RESTART_MAX_US) pause_us = RESTART_MAX_US;
  }
}

// Keeper and workers hold nothing of the program but their sockets and its standard streams: devices must be seen to go.
static void become_keeper(const char *uri, int talk, int keep, pid_t parent) {
  int high_talk = fcntl(talk, F_DUPFD, 10), high_keep = fcntl(keep, F_DUPFD, 10);
  dup2(high_talk, 3);
  dup2(high_keep, 4);
  if (close_range(5, ~0U, 0) != 0)
    for (int fd = 5; fd < 1024; fd++) close(fd); // a kernel before 5.9
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  // A key in the terminal goes to all of its processes: it is the program's to end us.
  static const int theirs[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};
  for (size_t i = 0; i < sizeof theirs / sizeof *theirs; i++) signal(theirs[i], SIG_IGN);
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) signal(faults[i], SIG_DFL);
  keep_alive(uri, 3, 4);
}

// ---- the program

static const char *how_it_ended(int status, char *text, size_t size) {
  if (WIFSIGNALED(status))
    snprintf(text, size, "crashed (signal %d, %s)", WTERMSIG(status), strsignal(WTERMSIG(status)));
  else
    snprintf(text, size, "its process ended with status %d", WEXITSTATUS(status));
  return text;
}

static void fail_worker(vs_player_process *p) {
  p->failures += p->ready;
  p->ready = false;
}

// Takes in who died; false: nobody did.
static bool hear_of_death(vs_player_process *p, int *status) {
  bool any = false;
  int one;
  while (recv(p->keep, &one, sizeof one, MSG_DONTWAIT) == (ssize_t)sizeof one) {
    *status = one;
    any = true;
  }
  return any;
}

// Waits for the answer to what was asked last.
static vs_status await(vs_player_process *p, verb what, int timeout_ms, vs_error *err) {
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * timeout_ms;
  for (;;) {
    struct pollfd wait[2] = {{.fd = p->talk, .events = POLLIN}, {.fd = p->keep, .events = POLLIN}};
    int64_t left_us = until_us - vs_clock_monotonic_us();
    int ready = poll(wait, 2, left_us > 0 ? (int)((left_us + 999) / 1000) : 0);
    if (ready < 0 && errno == EINTR) continue;
    p->late = ready <= 0;
    if (p->late) return vs_fail(err, VS_FAIL, "player %s: no answer within %d ms", p->uri, timeout_ms);
    // A last word comes before the news that its speaker is dead.
    if (wait[0].revents & POLLIN) {
      if (recv(p->talk, &p->reply, sizeof p->reply, MSG_DONTWAIT) != (ssize_t)sizeof p->reply) continue;
      if (p->reply.verb == HELLO && what != HELLO) { // the one that was asked died, and another is there already
        int status = 0;
        char text[96];
        hear_of_death(p, &status);
        p->greeted = true;
        return vs_fail(err, VS_FAIL, "player %s: %s", p->uri, how_it_ended(status, text, sizeof text));
      }
      if (p->reply.verb != what || (what != HELLO && p->reply.seq != p->seq)) continue; // of one that was given up
      return p->reply.status == VS_OK ? VS_OK : vs_fail(err, p->reply.status, "%s", p->reply.error.text);
    }
    int status = 0;
    char text[96];
    if (hear_of_death(p, &status))
      return vs_fail(err, VS_FAIL, "player %s: %s", p->uri, how_it_ended(status, text, sizeof text));
    if (wait[1].revents & (POLLHUP | POLLERR)) return vs_fail(err, VS_FAIL, "player %s: its keeper is gone", p->uri);
  }
}

static vs_status ask(vs_player_process *p, verb what, vs_error *err) {
  p->request.verb = what;
  p->request.seq = ++p->seq;
  if (send(p->talk, &p->request, sizeof p->request, MSG_NOSIGNAL | MSG_DONTWAIT) != (ssize_t)sizeof p->request)
    return vs_fail(err, VS_FAIL, "player %s: cannot be asked: %s", p->uri, strerror(errno));
  return await(p, what, p->patience_ms, err);
}

// After a failure the worker goes, by itself or by force: what it holds cannot be known.
static vs_status call(vs_player_process *p, verb what, vs_error *err) {
  vs_status s = ask(p, what, err);
  if (s == VS_OK) return VS_OK;
  fail_worker(p);
  if (p->late) send(p->keep, "k", 1, MSG_NOSIGNAL | MSG_DONTWAIT);
  return s;
}

// A new worker that has said hello is reset and plays on; until then every call fails at once.
static vs_status revive(vs_player_process *p, vs_error *err) {
  if (p->ready) return VS_OK;
  if (!p->greeted && await(p, HELLO, 0, NULL) != VS_OK)
    return vs_fail(err, VS_FAIL, "player %s: is being started again", p->uri);
  int ignored;
  hear_of_death(p, &ignored);
  p->ready = true;
  p->greeted = false;
  p->request.seed = p->seed;
  return call(p, RESET, err);
}

static vs_status reset(void *handle, uint64_t seed, vs_error *err) {
  vs_player_process *p = handle;
  p->seed = seed;
  vs_status s = revive(p, err);
  if (s != VS_OK) return s;
  p->request.seed = seed;
  return call(p, RESET, err);
}

static vs_status step(void *handle, const vs_world *view, const vs_game *game, double dt_s, vs_wheels *out,
                      vs_error *err) {
  vs_player_process *p = handle;
  vs_status s = revive(p, err);
  if (s != VS_OK) return s;
  p->request.view = *view;
  p->request.game = *game;
  p->request.dt_s = dt_s;
  s = call(p, STEP, err);
  if (s == VS_OK) memcpy(out, p->reply.wheels, sizeof *out * (size_t)vs_team_size(view));
  return s;
}

static vs_status act(void *handle, const float *obs, float *action, vs_error *err) {
  vs_player_process *p = handle;
  vs_status s = revive(p, err);
  if (s != VS_OK) return s;
  memcpy(p->request.obs, obs, sizeof p->request.obs);
  s = call(p, ACT, err);
  if (s == VS_OK) memcpy(action, p->reply.action, sizeof p->reply.action);
  return s;
}

static int64_t failures(const void *handle) { return ((const vs_player_process *)handle)->failures; }

// The keeper ends its worker when it hears nothing of us any more.
static void close_process(void *handle) {
  vs_player_process *p = handle;
  if (p->talk >= 0) close(p->talk);
  if (p->keep >= 0) close(p->keep);
  if (p->keeper > 0) waitpid(p->keeper, NULL, 0);
  free(p->uri);
  free(p);
}

static vs_status start_keeper(vs_player_process *p, vs_error *err) {
  int talk[2] = {-1, -1}, keep[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, talk) ||
      socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, keep)) {
    if (talk[0] >= 0) close(talk[0]), close(talk[1]);
    return vs_fail(err, VS_FAIL, "player %s: no socket: %s", p->uri, strerror(errno));
  }
  pid_t parent = getpid();
  fflush(NULL); // what is buffered is printed once
  p->keeper = fork();
  if (p->keeper == 0) become_keeper(p->uri, talk[1], keep[1], parent);
  close(talk[1]);
  close(keep[1]);
  p->talk = talk[0];
  p->keep = keep[0];
  return p->keeper > 0 ? VS_OK : vs_fail(err, VS_FAIL, "player %s: no process for it: %s", p->uri, strerror(errno));
}

vs_status vs_player_open_isolated(const char *uri, int patience_ms, vs_player **out, vs_error *err) {
  static const vs_player_remote calls = {reset, step, act, failures, close_process};
  *out = NULL;
  vs_player_process *p = calloc(1, sizeof *p);
  if (!p) return vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  p->talk = p->keep = -1;
  p->patience_ms = patience_ms;
  p->uri = strdup(uri);
  vs_status s = p->uri ? start_keeper(p, err) : vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  if (s == VS_OK) s = await(p, HELLO, OPEN_MS, err);
  p->ready = s == VS_OK;
  if (s == VS_OK) s = vs_player_of_remote(uri, &calls, p, &p->reply.about, out, err);
  if (s != VS_OK) close_process(p);
  return s;
}
