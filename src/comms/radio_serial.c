#include "vsss/radio_serial.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "vsss/clock.h"

#define FRAME_MAX    96
#define PAUSE_MIN_US 50000
#define PAUSE_MAX_US 200000

struct vs_serial {
  char device[256];
  speed_t speed;
  int fd;                  // -1 while away
  uint8_t rest[FRAME_MAX]; // of a frame that a full buffer cut
  size_t rest_size;
  int64_t pause_us, retry_us;
  vs_serial_stats stats;
};

static const struct {
  int baud;
  speed_t speed;
} speeds[] = {{9600, B9600},     {19200, B19200},   {38400, B38400},   {57600, B57600},   {115200, B115200},
              {230400, B230400}, {460800, B460800}, {500000, B500000}, {921600, B921600}, {1000000, B1000000}};

static vs_status find_speed(int baud, speed_t *out, vs_error *err) {
  for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++)
    if (speeds[i].baud == baud) {
      *out = speeds[i].speed;
      return VS_OK;
    }
  return vs_fail(err, VS_USAGE, "baud %d: allowed are 9600 to 1000000, such as 115200", baud);
}

static vs_status why_not(const char *device, int number, vs_error *err) {
  const char *fix = "";
  if (number == ENOENT) fix = "; is the radio plugged in? 'ls /dev/ttyUSB* /dev/ttyACM*' lists what there is";
  if (number == EACCES) fix = "; add yourself to its group ('sudo adduser $USER dialout') and log in again";
  if (number == EBUSY) fix = "; another program has it open";
  return vs_fail(err, VS_FAIL, "%.200s: %s%s", device, strerror(number), fix);
}

// Raw bytes, no modem lines, nothing waits. The device is ours alone: TIOCEXCL keeps others out, the lock also root.
static int open_device(const char *device, speed_t speed, vs_status *status, vs_error *err) {
  int fd = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  *status = VS_FAIL;
  if (fd < 0) {
    why_not(device, errno, err);
    return -1;
  }
  struct termios t;
  if (tcgetattr(fd, &t) != 0) {
    vs_fail(err, VS_FAIL, "%.200s: not a serial device", device);
    close(fd);
    return -1;
  }
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
    why_not(device, EBUSY, err);
    close(fd);
    return -1;
  }
  cfmakeraw(&t);
  t.c_cflag |= CLOCAL | CREAD;
  t.c_cflag &= ~(tcflag_t)(HUPCL | CSTOPB | CRTSCTS);
  cfsetispeed(&t, speed);
  cfsetospeed(&t, speed);
  if (tcsetattr(fd, TCSANOW, &t) != 0) {
    why_not(device, errno, err);
    close(fd);
    return -1;
  }
  ioctl(fd, TIOCEXCL);
  // Telemetry at once instead of after the driver's 16 ms; devices that cannot are as good without.
  struct serial_struct serial;
  if (ioctl(fd, TIOCGSERIAL, &serial) == 0) {
    serial.flags |= ASYNC_LOW_LATENCY;
    (void)ioctl(fd, TIOCSSERIAL, &serial);
  }
  tcflush(fd, TCIOFLUSH);
  *status = VS_OK;
  return fd;
}

vs_status vs_serial_open(const char *device, int baud, vs_serial **out, vs_error *err) {
  *out = NULL;
  speed_t speed = B115200;
  vs_status s = find_speed(baud, &speed, err);
  if (s != VS_OK) return s;
  if (strlen(device) >= sizeof((vs_serial *)0)->device)
    return vs_fail(err, VS_USAGE, "%.60s...: path too long", device);
  int fd = open_device(device, speed, &s, err);
  if (fd < 0) return s;
  vs_serial *serial = calloc(1, sizeof *serial);
  if (!serial) {
    close(fd);
    return vs_fail(err, VS_FAIL, "out of memory");
  }
  memcpy(serial->device, device, strlen(device) + 1);
  serial->speed = speed;
  serial->fd = fd;
  serial->pause_us = PAUSE_MIN_US;
  serial->stats.up = true;
  *out = serial;
  return VS_OK;
}

void vs_serial_close(vs_serial *serial) {
  if (!serial) return;
  if (serial->fd >= 0) close(serial->fd);
  free(serial);
}

static void lose(vs_serial *serial, int64_t now_us) {
  close(serial->fd);
  serial->fd = -1;
  serial->rest_size = 0;
  serial->stats.up = false;
  serial->pause_us = PAUSE_MIN_US;
  serial->retry_us = now_us + serial->pause_us;
}

static bool ready(vs_serial *serial, int64_t now_us) {
  if (serial->fd >= 0) return true;
  if (now_us < serial->retry_us) return false;
  vs_status status;
  serial->fd = open_device(serial->device, serial->speed, &status, NULL);
  if (serial->fd >= 0) {
    serial->pause_us = PAUSE_MIN_US;
    serial->stats.up = true;
    serial->stats.reopened++;
    return true;
  }
  serial->pause_us = serial->pause_us * 2 > PAUSE_MAX_US ? PAUSE_MAX_US : serial->pause_us * 2;
  serial->retry_us = now_us + serial->pause_us;
  return false;
}

// Bytes taken; 0 where the buffer is full. A dead device is let go.
static size_t put(vs_serial *serial, const uint8_t *bytes, size_t size, int64_t now_us) {
  ssize_t n = write(serial->fd, bytes, size);
  if (n >= 0) return (size_t)n;
  if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) lose(serial, now_us);
  return 0;
}

bool vs_serial_write(vs_serial *serial, const uint8_t *bytes, size_t size, int64_t now_us) {
  if (size > FRAME_MAX || !ready(serial, now_us)) {
    serial->stats.dropped++;
    return false;
  }
  if (serial->rest_size) {
    size_t n = put(serial, serial->rest, serial->rest_size, now_us);
    if (serial->fd >= 0) {
      serial->rest_size -= n;
      memmove(serial->rest, serial->rest + n, serial->rest_size);
    }
  }
  size_t n = serial->fd >= 0 && !serial->rest_size ? put(serial, bytes, size, now_us) : 0;
  if (n == 0) {
    serial->stats.dropped++;
    return false;
  }
  serial->rest_size = size - n;
  memcpy(serial->rest, bytes + n, serial->rest_size);
  serial->stats.sent++;
  return true;
}

size_t vs_serial_read(vs_serial *serial, uint8_t *bytes, size_t size, int64_t now_us) {
  if (!ready(serial, now_us)) return 0;
  ssize_t n = read(serial->fd, bytes, size);
  if (n > 0) return (size_t)n;
  // 0 is a hang-up: with VMIN 1, as cfmakeraw sets, an idle line answers EAGAIN.
  if (n == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) lose(serial, now_us);
  return 0;
}

void vs_serial_drain(vs_serial *serial, int timeout_ms) {
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * timeout_ms;
  for (;;) {
    int64_t now_us = vs_clock_monotonic_us();
    if (serial->fd < 0 || now_us > until_us) return;
    if (serial->rest_size) {
      size_t n = put(serial, serial->rest, serial->rest_size, now_us);
      if (serial->fd < 0) return;
      serial->rest_size -= n;
      memmove(serial->rest, serial->rest + n, serial->rest_size);
    }
    int waiting = 0;
    if (!serial->rest_size && (ioctl(serial->fd, TIOCOUTQ, &waiting) != 0 || waiting == 0)) return;
    vs_clock_sleep_until_us(now_us + 1000);
  }
}

int vs_serial_fd(const vs_serial *serial) { return serial->fd; }
const char *vs_serial_device(const vs_serial *serial) { return serial->device; }
vs_serial_stats vs_serial_get_stats(const vs_serial *serial) { return serial->stats; }
