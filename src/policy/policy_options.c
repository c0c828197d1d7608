// The "?key=value&key=value" part of a player's URI.
#include <stdio.h>
#include <string.h>

#include "policy_internal.h"

static void list_keys(const vs_config_key *schema, char *out, size_t size) {
  out[0] = '\0';
  for (const vs_config_key *k = schema; k->name; k++) {
    size_t used = strlen(out);
    snprintf(out + used, size - used, "%s%s", used ? ", " : "", k->name);
  }
}

static const vs_config_key *known(const vs_config_key *schema, const char *name, size_t length) {
  for (const vs_config_key *k = schema; k->name; k++)
    if (strlen(k->name) == length && !strncmp(k->name, name, length)) return k;
  return NULL;
}

vs_status vs_player_options(const char *scheme, const char *options, const vs_config_key *schema, vs_error *err) {
  if (*options && !schema->name) return vs_fail(err, VS_USAGE, "%s takes no options, '?%s' must go", scheme, options);
  while (*options) {
    size_t length = strcspn(options, "&");
    char pair[256];
    if (length >= sizeof pair) return vs_fail(err, VS_USAGE, "%s option '%.40s...' is too long", scheme, options);
    memcpy(pair, options, length);
    pair[length] = '\0';
    if (!known(schema, pair, strcspn(pair, "="))) {
      char keys[200];
      list_keys(schema, keys, sizeof keys);
      return vs_fail(err, VS_USAGE, "%s has no option '%s'; it knows: %s", scheme, pair, keys);
    }
    vs_status s = vs_config_set(pair, schema, err);
    if (s != VS_OK) {
      vs_fail_prefix(err, "%s", scheme);
      return s;
    }
    options += length + (options[length] == '&');
  }
  return VS_OK;
}
