// Score, clock and captions over a broadcast picture.
#ifndef VSSS_SIM_RENDER_OVERLAY_H
#define VSSS_SIM_RENDER_OVERLAY_H

#include <mujoco/mujoco.h>

#include "vsss/world.h"

void vs_render_overlay(const mjrContext *context, mjrRect picture, const vs_game *game, const char *title);

#endif
