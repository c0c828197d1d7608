// The log file of the league's referee (the recorder of futebol-mini/VSSReferee): every datagram of vision and referee with the time
// it came. Per entry, big-endian, as Qt's QDataStream writes them: int64 ms since 1970, uint32 kind, uint32 size, the datagram.
#ifndef VSSS_LEAGUE_LOG_H
#define VSSS_LEAGUE_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/league_messages.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_league_kind { VS_LEAGUE_REFEREE = 0, VS_LEAGUE_VISION = 1 } vs_league_kind;

typedef struct vs_league_entry {
  int64_t time_ms;
  vs_league_kind kind;
  size_t size;
  uint8_t data[VS_LEAGUE_RECEIVE_MAX];
} vs_league_entry;

typedef struct vs_league_log vs_league_log;
// A file that is there is written over. Errors of writing are told by close.
vs_status vs_league_log_create(const char *path, vs_league_log **out, vs_error *err);
vs_status vs_league_log_open(const char *path, vs_league_log **out, vs_error *err);
vs_status vs_league_log_close(vs_league_log *log, vs_error *err); // NULL is allowed

void vs_league_log_put(vs_league_log *log, int64_t time_ms, vs_league_kind kind, const uint8_t *data, size_t size);
// *end: there are no more. VS_FAIL: cut, another kind, or longer than a datagram of the league; with the place.
vs_status vs_league_log_next(vs_league_log *log, vs_league_entry *out, bool *end, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
