// ArUco Original by its definition.
#include "vision/aruco.h"

enum { CELLS = VS_ARUCO_CELLS, DATA = CELLS - 2 };

bool vs_aruco_light(int id, int row, int column) {
  // Each of the five rows holds two bits of the id, the most significant first, as one of four words of five cells.
  static const int words[4] = {0x10, 0x17, 0x09, 0x0e};
  if (row < 1 || column < 1 || row > DATA || column > DATA) return false;
  return words[id >> 2 * (DATA - row) & 3] >> (DATA - column) & 1;
}

vs_status vs_aruco_pattern(int id, vs_tag_pattern *out, vs_error *err) {
  if (id < 0 || id >= VS_ARUCO_IDS)
    return vs_fail(err, VS_USAGE, "mark id %d: ArUco Original has 0 to %d", id, VS_ARUCO_IDS - 1);
  *out = (vs_tag_pattern){.cells = CELLS, .border_cells = CELLS};
  for (int i = 0; i < CELLS * CELLS; i++)
    out->cell[i / CELLS][i % CELLS] = vs_aruco_light(id, i / CELLS, i % CELLS) ? 255 : 0;
  return VS_OK;
}
