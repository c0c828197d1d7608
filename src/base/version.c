#include "vsss/version.h"

#define TEXT_OF(x) #x
#define TEXT(x)    TEXT_OF(x)

const char *vs_version(void) {
  return TEXT(VSSS_VERSION_MAJOR) "." TEXT(VSSS_VERSION_MINOR) "." TEXT(VSSS_VERSION_PATCH);
}
