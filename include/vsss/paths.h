// Where the program's own files lie: beside the executable in a checkout, under PREFIX/share/vsss when installed.
#ifndef VSSS_PATHS_H
#define VSSS_PATHS_H

#include <stdbool.h>
#include <stddef.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Writes the path of a file of ours, such as "models/vsss_contact.xml". Looked for in $VSSS_HOME, the executable's
// folder and those above it, share/vsss beside the folder of the executable or of libvsss.so, and the install prefix.
// VS_FAIL names every place tried.
vs_status vs_path_find(const char *relative, char *out, size_t out_size, vs_error *err);

// Makes a folder and those above it, as `mkdir -p` does; one that is there is left as it is.
vs_status vs_path_make_folder(const char *path, unsigned mode, vs_error *err);

// A folder of the user's own, for sockets and files that nobody else may plant, read or take away. Refused: a link, another
// owner's, one that others may write into. make: it is made, mode 0700, where it is missing (those above it are not).
// folder: a descriptor to lock it by and to close.
vs_status vs_path_own_folder(const char *path, bool make, int *folder, vs_error *err);

// The same for a shared library, named as it lies in a checkout, such as "build/lib/vsss_mpi.so": installed, it lies in
// LIBDIR/vsss.
vs_status vs_path_library(const char *built, char *out, size_t out_size, vs_error *err);

// Loads vsss_NAME.so, one of the modules that cost start-up time (opencv, torch, mpi), and returns its handle for dlsym. VS_FAIL says which Debian package to install and to run make again.
vs_status vs_module_load(const char *name, const char *debian_package, void **handle, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
