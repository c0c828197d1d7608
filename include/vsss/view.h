// A page in the browser that shows a match: one static page (deploy/view/index.html), what it shows as JSON, and a
// WebSocket for matches that are being played. Served by libcivetweb, to this machine only unless told otherwise.
#ifndef VSSS_VIEW_H
#define VSSS_VIEW_H

#include <stddef.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// What the page needs of one moment: [seconds, ball, six or ten robots with their commands, score, clock, event]; the size written, as
// snprintf counts. wheels NULL: none known. event: text or "".
int vs_view_frame(double time_s, const vs_world *world, const vs_game *game,
                  const vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST], const char *event, char *out, size_t size);

typedef struct vs_view vs_view;
// page: path of the HTML file. data: what /data.json answers, stays the caller's. address: IPv4 of this machine to listen
// on. VS_FAIL: the port is in use, the page cannot be read, or built without libcivetweb (says what to install).
vs_status vs_view_open(const char *page, const char *data, size_t data_size, const char *address, int port,
                       vs_view **out, vs_error *err);
void vs_view_close(vs_view *view); // NULL is allowed
// Sends text to all pages that watch live. Any thread.
void vs_view_send(vs_view *view, const char *text, size_t size);
int vs_view_watchers(vs_view *view);

#ifdef __cplusplus
}
#endif
#endif
