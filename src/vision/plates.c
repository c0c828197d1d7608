#include "vision/plates.h"

#include <math.h>

// Reach of a colour around its reference, in the plane of hue (angle) and saturation (radius).
#define REACH 0.38
// Share of a square's inner pixels that must agree.
#define SHARE 0.5
#define DARK  0.2 // value below which a pixel has no colour

// The colour of a pixel: index of the reference, or -1.
static int colour_of(const uint8_t *bgr, const vs_hue *square) {
  double b = bgr[0] / 255.0, g = bgr[1] / 255.0, r = bgr[2] / 255.0, high = fmax(b, fmax(g, r));
  if (high < DARK) return -1;
  // The colour's place on the hexagon of hues, mapped to a plane.
  double x = (r - 0.5 * (g + b)) / high, y = 0.866025404 * (g - b) / high, best = REACH;
  int index = -1;
  for (int i = 0; i < VS_PLATE_COLOURS; i++) {
    double hue_rad = square[i].hue_deg * M_PI / 180, s = square[i].saturation;
    double d = hypot(x - s * cos(hue_rad), y - s * sin(hue_rad));
    if (d < best) best = d, index = i;
  }
  return index;
}

// The colour that most pixels of a square agree on, about (x, y), half_px to each side.
static int vote(const vs_frame *f, double x, double y, double half_px, const vs_hue *square, double *share) {
  int count[VS_PLATE_COLOURS] = {0}, pixels = 0, best = 0;
  int x0 = (int)floor(x - half_px), x1 = (int)floor(x + half_px), y0 = (int)floor(y - half_px),
      y1 = (int)floor(y + half_px);
  *share = 0;
  if (x0 < 0 || y0 < 0 || x1 >= f->width || y1 >= f->height) return -1;
  for (int row = y0; row <= y1; row++)
    for (int column = x0; column <= x1; column++, pixels++) {
      int c = colour_of(f->bgr + (size_t)row * f->bgr_stride + 3 * (size_t)column, square);
      if (c >= 0) count[c]++;
    }
  for (int c = 1; c < VS_PLATE_COLOURS; c++)
    if (count[c] > count[best]) best = c;
  *share = (double)count[best] / pixels;
  return *share >= SHARE ? best : -1;
}

// A plate whose front lies at (fx, fy), a unit vector in the picture, from the bar's middle.
static double try_front(const vs_frame *f, const vs_blob *bar, double fx, double fy, double scale, const vs_hue *square,
                        int colour[2]) {
  const double ahead = VS_PLATE_SIDE_M - VS_PLATE_SQUARE_M, aside = 0.5 * ahead, half = 0.3 * VS_PLATE_SQUARE_M;
  double share[2];
  for (int right = 0; right < 2; right++) {
    // Left of the front is (fy, -fx) where y counts down.
    double side = right ? -aside : aside;
    colour[right] = vote(f, bar->x_px + scale * (ahead * fx + side * fy), bar->y_px + scale * (ahead * fy - side * fx),
                         scale * half, square, &share[right]);
  }
  return colour[0] < 0 || colour[1] < 0 ? 0.0 : 0.5 * (share[0] + share[1]);
}

static void place(const vs_blob *bar, double fx, double fy, double scale, vs_tag *tag) {
  const double half = 0.5 * VS_PLATE_SIDE_M, back = 0.5 * (VS_PLATE_SIDE_M - VS_PLATE_SQUARE_M);
  const double along[4] = {-half, -half, half, half}, left[4] = {half, -half, -half, half};
  tag->centre_px[0] = bar->x_px + scale * back * fx;
  tag->centre_px[1] = bar->y_px + scale * back * fy;
  for (int i = 0; i < 4; i++) {
    tag->corner_px[i][0] = tag->centre_px[0] + scale * (along[i] * fx + left[i] * fy);
    tag->corner_px[i][1] = tag->centre_px[1] + scale * (along[i] * fy - left[i] * fx);
  }
}

int vs_plates_read(const vs_frame *frame, vs_team team, const vs_blob *bar, int bars, double px_per_m,
                   const vs_hue *square, vs_tag *out, int capacity) {
  int count = 0;
  for (int i = 0; i < bars && count < capacity; i++) {
    if (bar[i].elongation < VS_PLATE_LEAST_ELONGATION) continue;
    double scale = px_per_m > 0 ? px_per_m : sqrt(bar[i].area_px / (VS_PLATE_SIDE_M * VS_PLATE_SQUARE_M));
    double fx = -sin(bar[i].angle_rad), fy = cos(bar[i].angle_rad); // across the bar
    int colour[2], other[2];
    double score = try_front(frame, &bar[i], fx, fy, scale, square, colour);
    double turned = try_front(frame, &bar[i], -fx, -fy, scale, square, other);
    if (score <= 0 && turned <= 0) continue;
    bool back = turned > score;
    vs_tag *tag = &out[count++];
    *tag = (vs_tag){.kind = VS_MARK_COLOUR, .margin = 100 * fmax(score, turned)};
    tag->id = back ? vs_plate_code(team, other[0], other[1]) : vs_plate_code(team, colour[0], colour[1]);
    place(&bar[i], back ? -fx : fx, back ? -fy : fy, scale, tag);
  }
  return count;
}
