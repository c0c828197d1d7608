// Pictures from one process to another on the same machine: the venue (vsss rig) serves, vsss field opens the other end
// as camera "rig:PATH".
//
// A Unix stream socket, not shared memory: the kernel tells each end when the other is gone, a reader sleeps in poll(2)
// until a picture is there, a half-written picture cannot be seen, and a crash leaves nothing behind that must be
// repaired. The price is a copy of 0.9 MB per picture (0.2 ms). Both ends read the same monotonic clock, so capture
// stamps need no translation. A reader that is late never gets old pictures: the server keeps only the newest.
#ifndef VSSS_FRAME_STREAM_H
#define VSSS_FRAME_STREAM_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/camera.h"
#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_frame_server vs_frame_server;

typedef struct vs_frame_server_stats {
  bool connected;        // somebody watches
  int64_t sent, dropped; // pictures; dropped: replaced by a newer one before they could leave
  int64_t clients;       // that ever connected
} vs_frame_server_stats;

// Listens at path (at most 100 characters; a dead socket there is replaced). One client at a time, the next is served
// when it leaves. VS_FAIL: path in use by another server, or not writable.
vs_status vs_frame_server_new(const char *path, int width_px, int height_px, double fps, vs_frame_server **out,
                              vs_error *err);
void vs_frame_server_free(vs_frame_server *server); // NULL is allowed; removes path
// Hands a picture over: uint8_t[height_px][width_px][3], red first, top row first. Never blocks.
void vs_frame_server_put(vs_frame_server *server, const uint8_t *rgb, int64_t capture_us, uint32_t seq);
vs_frame_server_stats vs_frame_server_get_stats(vs_frame_server *server);

// The client as a camera, for vs_camera_register. An empty path means vs_rig_default_path's "camera".
const vs_camera_api *vs_frame_stream_camera(void);

// Writes the path of a file of the rig in its default folder ("camera", "radio", "calib.ini"), the same for server and
// client: vsss-rig in $XDG_RUNTIME_DIR, else in the system's folder for temporary files with the user's number.
void vs_rig_default_path(const char *file, char *out, unsigned long out_size);

#ifdef __cplusplus
}
#endif
#endif
