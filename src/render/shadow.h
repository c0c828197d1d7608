// Shadows of a directional lamp on the floor, as flattened pieces: a shadow map would cost more than all the rest.
#ifndef VSSS_RENDER_SHADOW_H
#define VSSS_RENDER_SHADOW_H

#include <mujoco/mujoco.h>

// Adds to scene the shadow of a box or sphere (type, half sizes, centre, row-major rotation; m). lamp: where light goes,
// lamp[2] < 0.
void vs_shadow_add(mjvScene *scene, int type, const mjtNum size[3], const mjtNum centre[3], const mjtNum turn[9],
                   const float lamp[3]);

// The same for every box that stands still in the scene.
void vs_shadow_add_walls(mjvScene *scene, const float lamp[3]);

#endif
