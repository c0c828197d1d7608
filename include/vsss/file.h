// Whole files, written so that nobody ever sees half of one.
#ifndef VSSS_FILE_H
#define VSSS_FILE_H

#include <stddef.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Writes path through path.tmp, fsync and rename: a reader, or a crash at any moment, sees the old file or the new one,
// whole. A new file has the mode 0644 less the umask, another keeps its own. What lies at path.tmp goes, a link itself, not
// what it points to; so one writer of a path at a time. A full disk is VS_FAIL naming the file; the old file stays.
vs_status vs_file_replace(const char *path, const void *data, size_t size, vs_error *err);

// Writes a file of the user's own (mode 0600) where there is nothing yet. VS_FAIL: something, or a link, is there already, or
// the disk is full: then nothing is left.
vs_status vs_file_create(const char *path, const void *data, size_t size, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
