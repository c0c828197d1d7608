// Stable: part of libvsss (deploy/docs/library.md).
//
// How a failure is reported. The library never prints and never exits: every function that can fail returns a
// vs_status and, where the caller passes one, fills a vs_error with one line that names the thing and the fix.
#ifndef VSSS_STATUS_H
#define VSSS_STATUS_H

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_status {
  VS_OK = 0,
  VS_FAIL = 1,  // the run failed (file, device, numerics); the program exits with 1
  VS_USAGE = 2, // the request was wrong (key, URI, range); the program exits with 2
} vs_status;

typedef struct vs_error {
  vs_status status;
  char text[512]; // one line, no newline at its end; empty while status is VS_OK
} vs_error;

// Fills err (may be NULL) and returns status. Use as: return vs_fail(err, VS_FAIL, "%s: %s", path, why);
VSSS_API vs_status vs_fail(vs_error *err, vs_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Puts "prefix: " before the text err already has; returns err's status (VS_FAIL where err is NULL).
VSSS_API vs_status vs_fail_prefix(vs_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __cplusplus
}
#endif
#endif
