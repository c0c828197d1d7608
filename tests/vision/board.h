// A checkerboard of 7 x 5 inner corners before a camera with fovy 0.9 rad, its middle at (326, 236) px and k1 -0.15, drawn
// by the ray of every pixel.
#ifndef VSSS_TESTS_VISION_BOARD_H
#define VSSS_TESTS_VISION_BOARD_H

#include <math.h>

#include "vsss/calib.h"

enum { BOARD_WIDTH = 640, BOARD_HEIGHT = 480, BOARD_COLUMNS = 7, BOARD_ROWS = 5 };
#define BOARD_SQUARE_M 0.03

static inline void board_paint(const vs_calib *c, unsigned char *grey) {
  for (int y = 0; y < BOARD_HEIGHT; y++)
    for (int x = 0; x < BOARD_WIDTH; x++) {
      int white = 0;
      for (int k = 0; k < 9; k++) {
        double u = 9, v = 9;
        vs_calib_to_field(c, x + (k % 3 + 0.5) / 3, y + (k / 3 + 0.5) / 3, 0, &u, &v);
        int i = (int)floor(u / BOARD_SQUARE_M), j = (int)floor(v / BOARD_SQUARE_M);
        bool board = i >= -1 && i < BOARD_COLUMNS && j >= -1 && j < BOARD_ROWS;
        white += !board || ((i + j) & 1);
      }
      grey[y * BOARD_WIDTH + x] = (unsigned char)(30 + white * 200 / 9);
    }
}

// The board in one of several poses: tilted, turned, rolled, nearer and further.
static inline void board_draw(int pose, unsigned char *grey) {
  vs_calib c = vs_calib_overhead(BOARD_WIDTH, BOARD_HEIGHT, 0.0, 0.9);
  c.cx_px = 326, c.cy_px = 236, c.k1 = -0.15;
  double tilt = 0.5 * cos(2.4 * pose), turn = 0.3 * pose, roll = 0.5 * sin(2.4 * pose);
  double a = cos(tilt), b = sin(tilt), d = cos(turn), e = sin(turn), g = cos(roll), h = sin(roll);
  const double flat[3][3] = {{d, e, 0}, {a * e, -a * d, b}, {b * e, -b * d, -a}};
  for (int j = 0; j < 3; j++) { // then about the camera's y
    c.rotation[0][j] = g * flat[0][j] + h * flat[2][j];
    c.rotation[1][j] = flat[1][j];
    c.rotation[2][j] = -h * flat[0][j] + g * flat[2][j];
  }
  double middle[3] = {0.09, 0.06, 0}; // of the board, put into the middle of the picture and towards its sides
  double where[3] = {0.04 * cos(1.1 * pose), 0.03 * sin(1.7 * pose), 0.36 + 0.02 * pose};
  for (int i = 0; i < 3; i++) {
    c.translation_m[i] = where[i];
    for (int j = 0; j < 3; j++) c.translation_m[i] -= c.rotation[i][j] * middle[j];
  }
  board_paint(&c, grey);
}

#endif
