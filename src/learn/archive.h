// A file of named sections with a hash at its end, read whole or refused.
#ifndef VSSS_LEARN_ARCHIVE_H
#define VSSS_LEARN_ARCHIVE_H

#include "vsss/status.h"
#include "wire.h"

#define VS_ARCHIVE_NAME 16

// Writing: begin, any number of sections, write (which frees).
void vs_archive_begin(vs_bytes *archive);
void vs_archive_section(vs_bytes *archive, const char *name, const void *data, size_t size);
// As a section whose bytes the caller fills in; NULL out of memory.
void *vs_archive_room(vs_bytes *archive, const char *name, size_t size);
// Replaces path atomically; what was there becomes path.previous.
vs_status vs_archive_write(vs_bytes *archive, const char *path, vs_error *err);

// Reads path and checks its length and hash. VS_FAIL names the file and what is wrong with it.
vs_status vs_archive_read(const char *path, vs_bytes *archive, vs_error *err);
// A section of exactly size bytes (size 0: any), pointing into the archive.
vs_status vs_archive_find(const vs_bytes *archive, const char *path, const char *name, size_t size, const void **data,
                          size_t *found_size, vs_error *err);

#endif
