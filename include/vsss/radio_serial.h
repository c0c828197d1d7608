// The serial device the robots' radio hangs on: /dev/ttyUSB0, or a pseudo terminal of the rig. Never blocks; a device that
// goes away is looked for again with a growing pause. Bytes only: what they mean is radio_codec.h.
#ifndef VSSS_RADIO_SERIAL_H
#define VSSS_RADIO_SERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_SERIAL_BAUD 115200

typedef struct vs_serial vs_serial;

typedef struct vs_serial_stats {
  bool up;
  int64_t sent, dropped; // writes taken whole; writes lost (device away or its buffer full)
  int64_t reopened;
} vs_serial_stats;

// VS_FAIL: missing, no permission (names the group), in use by another program, no terminal. VS_USAGE: baud unknown.
vs_status vs_serial_open(const char *device, int baud, vs_serial **out, vs_error *err);
void vs_serial_close(vs_serial *serial); // NULL is allowed

// Sends bytes (one round, <= 96) or drops them; true: sent. What a full buffer cut off is sent before anything else.
// now_us: monotonic, for the pause between attempts to reopen (50 ms, doubling to 0.2 s).
bool vs_serial_write(vs_serial *serial, const uint8_t *bytes, size_t size, int64_t now_us);
// Reads what is there, up to size bytes; 0: nothing.
size_t vs_serial_read(vs_serial *serial, uint8_t *bytes, size_t size, int64_t now_us);
// Waits until all that was written has left (drains the buffer), at most timeout_ms.
void vs_serial_drain(vs_serial *serial, int timeout_ms);

int vs_serial_fd(const vs_serial *serial); // for poll(2); -1 while the device is away
const char *vs_serial_device(const vs_serial *serial);
vs_serial_stats vs_serial_get_stats(const vs_serial *serial);

// The other end: a pseudo terminal whose path a vs_serial opens. For the rig's robots and for tests.
typedef struct vs_pty vs_pty;
vs_status vs_pty_new(vs_pty **out, vs_error *err);
void vs_pty_free(vs_pty *pty);              // the other end sees its device go away
const char *vs_pty_path(const vs_pty *pty); // /dev/pts/N
int vs_pty_fd(const vs_pty *pty);
size_t vs_pty_read(vs_pty *pty, uint8_t *bytes, size_t size);        // 0: nothing there
size_t vs_pty_write(vs_pty *pty, const uint8_t *bytes, size_t size); // 0: full (nobody reads)

#ifdef __cplusplus
}
#endif
#endif
