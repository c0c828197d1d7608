// One datagram at a time, sent when it is due by a thread that does nothing else: how long the next frame takes to compute does
// not delay it, and a thread that computes little is woken before those that compute much.
#ifndef VSSS_SERVE_OUTBOX_H
#define VSSS_SERVE_OUTBOX_H

#include "vsss/histogram.h"
#include "vsss/league_messages.h"
#include "vsss/udp.h"

typedef struct vs_outbox vs_outbox;
// to: copied, stays the caller's to close, after the box. The thread has the caller's priority.
vs_status vs_outbox_new(const vs_udp *to, vs_outbox **out, vs_error *err);
void vs_outbox_free(vs_outbox *box); // what it holds is sent first; NULL is allowed

// Waits while the one before has not gone. size: at most VS_LEAGUE_DATAGRAM_5V5_MAX. due_us: of the monotonic clock; past: at once.
void vs_outbox_put(vs_outbox *box, const uint8_t *data, size_t size, int64_t due_us);

void vs_outbox_flush(vs_outbox *box); // waits until it has gone; NULL is allowed

// Of those sent so far: how late (us), how many the system refused.
void vs_outbox_told(vs_outbox *box, vs_histogram *late, int64_t *unsent);

#endif
