// Whole files, written so that nobody ever sees half of one.
#ifndef VSSS_FILE_H
#define VSSS_FILE_H

#include <stddef.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Writes path through path.tmp, fsync and rename: a reader, or a crash at any moment, sees the old file or the new one,
// whole. A full disk is VS_FAIL naming the file; the old file stays.
vs_status vs_file_replace(const char *path, const void *data, size_t size, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
