// The radio's thread: the newest command on the line at once, then again every 20 ms until a newer one comes; a stop
// when it is too old. It goes on when the pipeline hangs, which is what it is for.
#ifndef VSSS_SENDER_H
#define VSSS_SENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/radio_link.h"
#include "vsss/radio_serial.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_sender vs_sender;

typedef struct vs_sender_def {
  const char *device; // NULL: a dry run, frames are made and go nowhere
  int baud;
  uint8_t id[VS_TEAM_SIZE]; // number on the air of robot i
  vs_radio_key key;
  const vs_wire *wire; // NULL: our own protocol
} vs_sender_def;
vs_status vs_sender_new(const vs_sender_def *def, vs_sender **out, vs_error *err);
// Sends VS_RADIO_STOP_FRAMES stops and waits until they have left. NULL is allowed.
void vs_sender_free(vs_sender *sender);

// Called for every frame: the wheels are still (or newly) wanted as of capture_us. now: write them at once instead of
// with the next repeat; returns after write(2).
void vs_sender_command(vs_sender *sender, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t capture_us,
                       bool now);

// For the handler of a signal that ends the program (async-signal-safe, takes no lock): every sender of this process tells
// its robots to stop, VS_RADIO_STOP_FRAMES times within 50 ms, and never writes again.
void vs_sender_last_stop(void);
// Installs that handler for SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS and SIGTRAP; the signal then ends
// the program as it would have without. Those who run out of the main thread's stack are served too.
void vs_sender_stop_at_crash(void);

// Copies of the link's and the device's state, consistent with each other.
void vs_sender_state(vs_sender *sender, vs_radio_link *link, vs_serial_stats *serial);

#ifdef __cplusplus
}
#endif
#endif
