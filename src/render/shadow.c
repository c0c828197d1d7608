#include "shadow.h"

#define LIFT_M   0.001 // over the floor, whose depth would be the same
#define FLATNESS 0.001 // left of the height: a flat piece would have no normals
static const float dark[4] = {0.0f, 0.0f, 0.0f, 0.4f};

// What faces the lamp faces upwards once flattened along its rays, and MuJoCo draws front faces only: every point of the
// shadow is darkened once.
void vs_shadow_add(mjvScene *scene, int type, const mjtNum size[3], const mjtNum centre[3], const mjtNum turn[9],
                   const float lamp[3]) {
  if (scene->ngeom >= scene->maxgeom) return;
  mjtNum drift[3] = {lamp[0] / -lamp[2], lamp[1] / -lamp[2], FLATNESS - 1.0}, at[3], mat[9];
  for (int row = 0; row < 3; row++) {
    at[row] = centre[row] + drift[row] * centre[2] + (row == 2 ? LIFT_M : 0.0);
    for (int column = 0; column < 3; column++)
      mat[3 * row + column] = turn[3 * row + column] + drift[row] * turn[6 + column];
  }
  mjvGeom *shadow = &scene->geoms[scene->ngeom++];
  mjv_initGeom(shadow, type, size, at, mat, dark);
  shadow->category = mjCAT_DECOR;
  shadow->specular = 0.0f;
}

void vs_shadow_add_walls(mjvScene *scene, const float lamp[3]) {
  int pieces = scene->ngeom;
  for (int i = 0; i < pieces; i++) {
    const mjvGeom *g = &scene->geoms[i];
    if (g->type != mjGEOM_BOX || g->category != mjCAT_STATIC) continue;
    mjtNum size[3], centre[3], turn[9];
    for (int k = 0; k < 3; k++) size[k] = g->size[k], centre[k] = g->pos[k];
    for (int k = 0; k < 9; k++) turn[k] = g->mat[k];
    vs_shadow_add(scene, mjGEOM_BOX, size, centre, turn, lamp);
  }
}
