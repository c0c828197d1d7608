// Colour plates: a bar of the team's colour and two squares on one cap (mark.h) -> a mark with id and heading.
#ifndef VSSS_VISION_PLATES_H
#define VSSS_VISION_PLATES_H

#include "vsss/detect.h"

// Which of the bars carry a plate, as tags of VS_MARK_COLOUR: id as vs_plate_code gives it, corners of the 65 mm square
// that bar and squares fill, margin 100 times the share of their pixels that look as they should. px_per_m 0: by each
// bar's area. Returns how many were written.
int vs_plates_read(const vs_frame *frame, vs_team team, const vs_blob *bar, int bars, double px_per_m,
                   const vs_hue *square, vs_tag *out, int capacity);

#endif
