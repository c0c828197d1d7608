// INI files and key=value overrides with a declared schema: an unknown key is an error that names file, line, the
// key and the nearest known one.
#ifndef VSSS_CONFIG_H
#define VSSS_CONFIG_H

#include <stdbool.h>
#include <stddef.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_config_type {
  VS_CONFIG_INT,
  VS_CONFIG_REAL,
  VS_CONFIG_BOOL,
  VS_CONFIG_TEXT,
  VS_CONFIG_SEED,
  VS_CONFIG_ALIAS // an older name of a key; only name and help count, and help is the name the key has now
} vs_config_type;

// One key of a schema. Keys of an INI section are written "section.key". The value is stored at target, which is an
// int, double, bool, char[text_size] or uint64_t (VS_CONFIG_SEED). Numbers outside [min, max] are refused (min == max == 0: no limits).
typedef struct vs_config_key {
  const char *name;
  vs_config_type type;
  void *target;
  size_t text_size; // VS_CONFIG_TEXT only
  double min, max;
  const char *help;
} vs_config_key;

// A value of a file ends where a comment begins, with # or ;. One that holds such a character, or spaces at its ends, is
// written in double quotes; in them \" \\ \n and \r stand for these characters.

// value as it must be written in a file; needs up to 2 * strlen(value) + 3 bytes.
void vs_config_quote(const char *value, char *out, size_t size);

#define VS_CONFIG_FILE_MAX (1 << 20) // bytes: a larger file, or a device that never ends, is none of settings

// A schema ends with a row whose name is NULL. On an error no further key is read; keys read so far are set.
vs_status vs_config_load(const char *path, const vs_config_key *schema, vs_error *err);
vs_status vs_config_parse(const char *name_for_errors, const char *text, const vs_config_key *schema, vs_error *err);
vs_status vs_config_set(const char *assignment /* key=value */, const vs_config_key *schema, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
