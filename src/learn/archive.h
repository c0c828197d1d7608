// A file of named sections, each with a version, with a hash at its end, read whole or refused.
#ifndef VSSS_LEARN_ARCHIVE_H
#define VSSS_LEARN_ARCHIVE_H

#include "vsss/status.h"
#include "wire.h"

#define VS_ARCHIVE_NAME 12 // bytes of a section's name, its end included

// A kind of section. Whoever changes what its bytes mean raises `version`, which is what is written; `oldest` is the one of
// before that can still be read. Files from before 0.1.0 say no version: theirs is 1.
typedef struct vs_section {
  const char *name;
  uint32_t oldest, version;
} vs_section;

// A section that was found; data points into the archive, at no particular alignment.
typedef struct vs_found {
  const void *data;
  size_t size; // bytes
  uint32_t version;
} vs_found;

// Writing: begin, any number of sections, write (which frees).
void vs_archive_begin(vs_bytes *archive);
void vs_archive_section(vs_bytes *archive, const vs_section *section, const void *data, size_t size);
// As a section whose bytes the caller fills in; NULL out of memory.
void *vs_archive_room(vs_bytes *archive, const vs_section *section, size_t size);
// Replaces path atomically; what was there becomes path.previous.
vs_status vs_archive_write(vs_bytes *archive, const char *path, vs_error *err);

// Reads path and checks its length and hash. VS_FAIL names the file and what is wrong with it.
vs_status vs_archive_read(const char *path, vs_bytes *archive, vs_error *err);
// A section of exactly size bytes (size 0: any). VS_FAIL names path and what is wrong: not there, too old, too new, of
// another size.
vs_status vs_archive_find(const vs_bytes *archive, const char *path, const vs_section *section, size_t size,
                          vs_found *out, vs_error *err);
// Whether the section is there, of whatever version and size.
bool vs_archive_has(const vs_bytes *archive, const char *name, vs_found *out);

#endif
