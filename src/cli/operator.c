#include "operator.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

static struct termios before;
static int changed; // the terminal is to be given back

static void give_back(void) {
  if (changed) tcsetattr(STDIN_FILENO, TCSANOW, &before);
  changed = 0;
}

// A program in the background may not touch the terminal: it would be stopped.
static int in_foreground(void) { return isatty(STDIN_FILENO) && tcgetpgrp(STDIN_FILENO) == getpgrp(); }

static void take_keys(void) {
  static int registered;
  struct termios now;
  if (!in_foreground() || tcgetattr(STDIN_FILENO, &before) != 0) return;
  now = before;
  now.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
  changed = tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0;
  if (!registered++) atexit(give_back);
}

vs_status vs_operator_open(const char *words, vs_operator *o, vs_error *err) {
  *o = (vs_operator){.keys = STDIN_FILENO, .words = -1};
  if (words) {
    // Both ends of a pipe: it stays open when its writer leaves and another one comes.
    o->words = open(words, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (o->words < 0) return vs_fail(err, VS_FAIL, "--referee %s: %s", words, strerror(errno));
  }
  take_keys();
  return VS_OK;
}

void vs_operator_close(vs_operator *o) {
  give_back();
  if (o->words >= 0) close(o->words);
  o->words = -1;
}

// Bytes that are there; 0: none, -1: there will be none.
static int read_some(int fd, char *out, int size) {
  struct pollfd wait = {.fd = fd, .events = POLLIN};
  if (fd < 0 || poll(&wait, 1, 0) <= 0) return 0;
  ssize_t n = read(fd, out, (size_t)size);
  return n > 0 ? (int)n : n < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

static vs_order stronger(vs_order a, vs_order b) { return a > b ? a : b; }

static vs_order key(char c) {
  if (c == '\n' || c == '\r') return VS_ORDER_NONE; // for those who type Enter after it
  return c == 'g' ? VS_ORDER_GO : c == 'q' ? VS_ORDER_QUIT : VS_ORDER_STOP;
}

static vs_order end_word(vs_operator *o, char *unknown) {
  o->word[o->used] = '\0';
  o->used = 0;
  if (!*o->word) return VS_ORDER_NONE;
  if (!strcmp(o->word, "go")) return VS_ORDER_GO;
  if (strcmp(o->word, "stop") && strcmp(o->word, "halt")) snprintf(unknown, 24, "%s", o->word);
  return VS_ORDER_STOP; // what is not understood stops, too
}

vs_order vs_operator_poll(vs_operator *o, char *unknown) {
  vs_order order = VS_ORDER_NONE;
  char bytes[64];
  unknown[0] = '\0';
  int n = read_some(o->keys, bytes, sizeof bytes);
  if (n < 0) o->keys = -1;
  for (int i = 0; i < n; i++) order = stronger(order, key(bytes[i]));
  n = read_some(o->words, bytes, sizeof bytes);
  for (int i = 0; i < n; i++) {
    if (bytes[i] == '\n')
      order = stronger(order, end_word(o, unknown));
    else if (bytes[i] > ' ' && bytes[i] < 127 && o->used < (int)sizeof o->word - 1)
      o->word[o->used++] = bytes[i];
  }
  return order;
}

int vs_operator_typed(vs_operator *o, char *out, int size) {
  if (o->keys < 0 || !in_foreground()) return 0;
  int n = read_some(o->keys, out, size);
  if (n < 0) o->keys = -1;
  return n > 0 ? n : 0;
}
