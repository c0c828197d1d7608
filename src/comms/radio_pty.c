// A pseudo terminal: what the rig's robots and the tests hold instead of a radio.
#include <errno.h>
#include <fcntl.h>
#include <pty.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "vsss/radio_serial.h"

struct vs_pty {
  int master;
  char path[64];
};

vs_status vs_pty_new(vs_pty **out, vs_error *err) {
  *out = NULL;
  vs_pty *pty = calloc(1, sizeof *pty);
  if (!pty) return vs_fail(err, VS_FAIL, "out of memory");
  struct termios raw = {0};
  cfmakeraw(&raw);
  raw.c_cflag |= CREAD | CLOCAL;
  int slave;
  if (openpty(&pty->master, &slave, pty->path, &raw, NULL) != 0) {
    int number = errno;
    free(pty);
    return vs_fail(err, VS_FAIL, "pseudo terminal: %s (is /dev/pts mounted?)", strerror(number));
  }
  close(slave);
  fcntl(pty->master, F_SETFL, O_NONBLOCK);
  fcntl(pty->master, F_SETFD, FD_CLOEXEC);
  *out = pty;
  return VS_OK;
}

void vs_pty_free(vs_pty *pty) {
  if (!pty) return;
  close(pty->master);
  free(pty);
}

const char *vs_pty_path(const vs_pty *pty) { return pty->path; }
int vs_pty_fd(const vs_pty *pty) { return pty->master; }

// While nobody has the other end open, reading answers EIO: nothing there.
size_t vs_pty_read(vs_pty *pty, uint8_t *bytes, size_t size) {
  ssize_t n = read(pty->master, bytes, size);
  return n > 0 ? (size_t)n : 0;
}

size_t vs_pty_write(vs_pty *pty, const uint8_t *bytes, size_t size) {
  ssize_t n = write(pty->master, bytes, size);
  return n > 0 ? (size_t)n : 0;
}
