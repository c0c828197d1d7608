// The rig's folder: camera, radio and calib.ini lie in it under names that anybody could have used before. What a rig did
// not put there is never followed, overwritten or taken away.
#ifndef VSSS_RIG_VENUE_H
#define VSSS_RIG_VENUE_H

#include <stdbool.h>
#include <sys/types.h>

#include "vsss/status.h"

typedef struct vs_venue {
  int folder; // locked; 0: not open
} vs_venue;

// What was made, to be known again; all zero: nothing was.
typedef struct vs_venue_file {
  dev_t device;
  ino_t inode;
} vs_venue_file;

// Makes the folder, mode 0700, or takes one of the user's own, and locks out other rigs. Takes away what a rig that was
// killed left in it, known by its socket. VS_FAIL: not such a folder, another rig lives in it, or one of the three
// is there and no rig left it.
vs_status vs_venue_open(vs_venue *venue, const char *folder, const char *camera, const char *radio, const char *calib,
                        vs_error *err);
void vs_venue_close(vs_venue *venue);

// Remembers that the thing at path was just made by us; taken away as long as it is still that one.
void vs_venue_mine(const char *path, vs_venue_file *file);
void vs_venue_remove(const char *path, const vs_venue_file *file);

#endif
