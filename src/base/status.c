#include "vsss/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

vs_status vs_fail(vs_error *err, vs_status status, const char *format, ...) {
  if (err) {
    va_list args;
    va_start(args, format);
    err->status = status;
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
  }
  return status;
}

vs_status vs_fail_prefix(vs_error *err, const char *format, ...) {
  if (!err) return VS_FAIL;
  char prefix[sizeof err->text];
  va_list args;
  va_start(args, format);
  vsnprintf(prefix, sizeof prefix, format, args);
  va_end(args);

  char old[sizeof err->text];
  memcpy(old, err->text, sizeof old);
  size_t used = strlen(prefix);
  memcpy(err->text, prefix, used + 1);
  snprintf(err->text + used, sizeof err->text - used, ": %s", old);
  return err->status;
}
