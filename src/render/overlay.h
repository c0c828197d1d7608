// Score, clock and captions over a broadcast picture.
#ifndef VSSS_RENDER_OVERLAY_H
#define VSSS_RENDER_OVERLAY_H

#include <mujoco/mujoco.h>

#include "vsss/world.h"

#define VS_OVERLAY_LABELS 6

// Draws into the context's picture and says where: opaque labels, their number returned.
int vs_render_overlay(const mjrContext *context, mjrRect picture, const vs_game *game, const char *title,
                      mjrRect drawn[VS_OVERLAY_LABELS]);

#endif
