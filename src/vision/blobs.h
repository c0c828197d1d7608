// Coloured blobs: classify by a table, find components on a coarse grid, measure each at full resolution.
#ifndef VSSS_VISION_BLOBS_H
#define VSSS_VISION_BLOBS_H

#include "vsss/detect.h"

// Colour classes as bits of one byte per quantised colour: blue, green, red to 5 bits each.
#define VS_COLOUR_BITS  5
#define VS_COLOUR_TABLE (1 << (3 * VS_COLOUR_BITS))

// Sets bit in every entry whose colour lies in the range.
void vs_colour_table_add(uint8_t *table /* [VS_COLOUR_TABLE] */, const vs_colour *colour, uint8_t bit);

typedef struct vs_blob_gate {
  uint8_t bit;       // class looked for
  double area_px;    // expected; 0: not known, then min and max are taken as they are
  double min_px;     // smallest area
  double max_px;     // largest area of one
  int most;          // a component larger than one is cut into up to this many; 1: refused instead
  double elongation; // largest
} vs_blob_gate;

typedef struct vs_blob_finder vs_blob_finder;
vs_blob_finder *vs_blob_finder_new(void); // NULL: out of memory
void vs_blob_finder_free(vs_blob_finder *finder);
// Blobs of one class, best first; count <= capacity. Allocates only when the frame's size is new. step: grid in px.
vs_status vs_blobs_find(vs_blob_finder *finder, const vs_frame *frame, const uint8_t *table, const vs_blob_gate *gate,
                        int step, vs_blob *out, int capacity, int *count, vs_error *err);

#endif
