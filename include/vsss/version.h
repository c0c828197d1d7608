// Stable. The release, said once here: the Makefile, vsss.pc, the CMake package and the Debian packages read it.
#ifndef VSSS_VERSION_H
#define VSSS_VERSION_H

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VSSS_VERSION_MAJOR 0
#define VSSS_VERSION_MINOR 1
#define VSSS_VERSION_PATCH 0

// Number of the interface of libvsss.so (its SONAME is libvsss.so.1): it grows when a program built against the release
// before would no longer run.
#define VSSS_ABI 1

VSSS_API const char *vs_version(void); // "0.1.0", of the library that is running

#ifdef __cplusplus
}
#endif
#endif
