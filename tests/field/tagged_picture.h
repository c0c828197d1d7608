// A picture for cameras of the tests: a black field with robots 0, 1, 2, painted without a renderer.
#ifndef VSSS_TESTS_FIELD_TAGGED_PICTURE_H
#define VSSS_TESTS_FIELD_TAGGED_PICTURE_H

#include <string.h>

#include "assert_near.h"
#include "vsss/tag.h"

// 3 pixels a cell: 27 where a paper of 78 mm on a cap under a camera 2.2 m high that just shows the field has 28.6.
enum { PICTURE_W = 640, PICTURE_H = 480, CELL_PX = 3 };

// rgb: uint8_t[PICTURE_H][PICTURE_W][3]. An orange ball at (320, 350). Tag i, its top up, has its upper left corner at (100 + 150 i, 200).
static inline void paint_tagged_picture(uint8_t *rgb) {
  memset(rgb, 0, 3 * PICTURE_W * PICTURE_H);
  for (int id = 0; id < 3; id++) {
    vs_tag_pattern tag;
    assert_ok(vs_tag_pattern_of(VS_TAG_FAMILY, id, &tag, err));
    for (int y = 0; y < tag.cells * CELL_PX; y++)
      for (int x = 0; x < tag.cells * CELL_PX; x++)
        memset(rgb + 3 * ((200 + y) * PICTURE_W + 100 + 150 * id + x), tag.cell[y / CELL_PX][x / CELL_PX], 3);
  }
  for (int y = -8; y <= 8; y++)
    for (int x = -8; x <= 8; x++) {
      if (x * x + y * y > 64) continue;
      uint8_t *pixel = rgb + 3 * ((350 + y) * PICTURE_W + 320 + x);
      pixel[0] = 255, pixel[1] = 120, pixel[2] = 0;
    }
}

#endif
