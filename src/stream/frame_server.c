#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "frame_wire.h"
#include "vsss/frame_stream.h"

#define LOOK_NS 50000000 // between looks for a client that left while there was no picture: the next one waits for it

struct vs_frame_server {
  char path[108];
  ino_t inode; // of the socket at path
  vs_wire_hello hello;
  size_t bytes;
  int listener, wake[2]; // wake: a byte tells the sender to look at stop
  pthread_t sender;
  pthread_mutex_t lock; // of all below
  pthread_cond_t put;
  bool stop, fresh;
  vs_wire_frame head;
  uint8_t *newest; // what put left; sender swaps it with sending
  uint8_t *sending;
  vs_frame_server_stats stats;
};

// Sends all of it, however slowly the other end reads; false: it is gone, or we stop.
static bool send_all(vs_frame_server *s, int client, const void *data, size_t size) {
  const uint8_t *bytes = data;
  while (size > 0) {
    struct pollfd wait[2] = {{.fd = client, .events = POLLOUT}, {.fd = s->wake[0], .events = POLLIN}};
    if (poll(wait, 2, -1) < 0 && errno != EINTR) return false;
    if (wait[1].revents) return false;
    ssize_t n = send(client, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return false;
    if (n > 0) bytes += n, size -= (size_t)n;
  }
  return true;
}

// The next picture into sending; false: we stop, or the client left while there was none.
static bool take(vs_frame_server *s, int client, vs_wire_frame *head) {
  pthread_mutex_lock(&s->lock);
  while (!s->fresh && !s->stop) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += LOOK_NS;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&s->put, &s->lock, &until);
    char byte;
    if (!s->fresh && recv(client, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) break;
  }
  bool got = s->fresh && !s->stop;
  if (got) {
    uint8_t *swap = s->sending;
    s->sending = s->newest;
    s->newest = swap;
    s->fresh = false;
    *head = s->head;
  }
  pthread_mutex_unlock(&s->lock);
  return got;
}

static void serve(vs_frame_server *s, int client) {
  vs_wire_frame head;
  if (!send_all(s, client, &s->hello, sizeof s->hello)) return;
  pthread_mutex_lock(&s->lock);
  s->stats.connected = true;
  s->stats.clients++;
  s->fresh = false; // pictures from before are nobody's
  pthread_mutex_unlock(&s->lock);
  while (take(s, client, &head)) {
    if (!send_all(s, client, &head, sizeof head) || !send_all(s, client, s->sending, s->bytes)) break;
    pthread_mutex_lock(&s->lock);
    s->stats.sent++;
    pthread_mutex_unlock(&s->lock);
  }
  pthread_mutex_lock(&s->lock);
  s->stats.connected = false;
  pthread_mutex_unlock(&s->lock);
}

static void *send_loop(void *server) {
  vs_frame_server *s = server;
  for (;;) {
    struct pollfd wait[2] = {{.fd = s->listener, .events = POLLIN}, {.fd = s->wake[0], .events = POLLIN}};
    if (poll(wait, 2, -1) < 0 && errno != EINTR) return NULL;
    if (wait[1].revents) return NULL;
    int client = wait[0].revents ? accept(s->listener, NULL, NULL) : -1;
    if (client < 0) continue;
    serve(s, client);
    close(client);
  }
}

// A socket of ours that nobody listens to is left over from a crash. Anything else is not ours to take away.
static vs_status bind_to(vs_frame_server *s, const char *path, vs_error *err) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  if (strlen(path) >= sizeof address.sun_path - 8)
    return vs_fail(err, VS_USAGE, "%s: too long for a socket, at most %zu characters", path,
                   sizeof address.sun_path - 9);
  snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
  s->listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (s->listener < 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (connect(s->listener, (struct sockaddr *)&address, sizeof address) == 0)
    return vs_fail(err, VS_FAIL, "%s: in use by another rig; stop it or give another --dir", path);
  bool refused = errno == ECONNREFUSED;
  struct stat info;
  close(s->listener);
  if (lstat(path, &info) == 0) {
    if (!refused || !S_ISSOCK(info.st_mode) || info.st_uid != geteuid())
      return vs_fail(err, VS_FAIL, "%s: is already there and no rig left it; move it away or give another --dir", path);
    unlink(path);
  }
  s->listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (s->listener < 0 || bind(s->listener, (struct sockaddr *)&address, sizeof address) || listen(s->listener, 4))
    return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (lstat(path, &info) == 0) {
    snprintf(s->path, sizeof s->path, "%s", path); // ours to remove from here on
    s->inode = info.st_ino;
  }
  return VS_OK;
}

vs_status vs_frame_server_new(const char *path, int width_px, int height_px, double fps, vs_frame_server **out,
                              vs_error *err) {
  *out = NULL;
  vs_frame_server *s = calloc(1, sizeof *s);
  if (!s) return vs_fail(err, VS_FAIL, "out of memory");
  s->listener = s->wake[0] = s->wake[1] = -1;
  s->hello = (vs_wire_hello){VS_WIRE_HELLO, (uint32_t)width_px, (uint32_t)height_px, 0, fps};
  s->bytes = (size_t)width_px * (size_t)height_px * 3;
  pthread_mutex_init(&s->lock, NULL);
  pthread_cond_init(&s->put, NULL);
  s->newest = malloc(s->bytes);
  s->sending = malloc(s->bytes);
  vs_status status = s->newest && s->sending ? VS_OK : vs_fail(err, VS_FAIL, "out of memory");
  if (status == VS_OK) status = bind_to(s, path, err);
  if (status == VS_OK && (pipe(s->wake) || pthread_create(&s->sender, NULL, send_loop, s))) {
    status = vs_fail(err, VS_FAIL, "%s: no thread to serve it: %s", path, strerror(errno));
    if (s->wake[0] >= 0) close(s->wake[0]), close(s->wake[1]);
    s->wake[0] = -1;
  }
  if (status != VS_OK) {
    vs_frame_server_free(s);
    return status;
  }
  *out = s;
  return VS_OK;
}

void vs_frame_server_free(vs_frame_server *s) {
  if (!s) return;
  if (s->wake[0] >= 0) { // the thread runs
    pthread_mutex_lock(&s->lock);
    s->stop = true;
    pthread_cond_signal(&s->put);
    pthread_mutex_unlock(&s->lock);
    while (write(s->wake[1], "x", 1) < 0 && errno == EINTR)
      ;
    pthread_join(s->sender, NULL);
    close(s->wake[0]);
    close(s->wake[1]);
  }
  if (s->listener >= 0) close(s->listener);
  struct stat info;
  if (*s->path && lstat(s->path, &info) == 0 && info.st_ino == s->inode) unlink(s->path);
  pthread_mutex_destroy(&s->lock);
  pthread_cond_destroy(&s->put);
  free(s->newest);
  free(s->sending);
  free(s);
}

void vs_frame_server_put(vs_frame_server *s, const uint8_t *rgb, int64_t capture_us, uint32_t seq) {
  pthread_mutex_lock(&s->lock);
  if (s->stats.connected) {
    if (s->fresh) s->stats.dropped++;
    memcpy(s->newest, rgb, s->bytes);
    s->head = (vs_wire_frame){VS_WIRE_FRAME, seq, capture_us};
    s->fresh = true;
    pthread_cond_signal(&s->put);
  }
  pthread_mutex_unlock(&s->lock);
}

vs_frame_server_stats vs_frame_server_get_stats(vs_frame_server *s) {
  pthread_mutex_lock(&s->lock);
  vs_frame_server_stats stats = s->stats;
  pthread_mutex_unlock(&s->lock);
  return stats;
}
