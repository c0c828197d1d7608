// Contacts of the planar drive's robots, seen from above: rectangles against each other and against walls. MuJoCo would
// collide them as boxes and find each contact twice, at the top and at the bottom of the upright face, with twice the
// rows for its solver. The depth is the overlap; MuJoCo 2.2.2 gives half of it between boxes. Geoms marked user="1" in
// the model come here, all others go on to MuJoCo's own functions.
#include "sim_internal.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

// Between equally deep axes the first one found stays, so that rounding does not make contacts jump.
#define AXIS_BIAS_M 1e-6

typedef struct vec2 {
  double x, y;
} vec2;

static double dot(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
static vec2 along(vec2 from, vec2 way, double length) {
  return (vec2){from.x + length * way.x, from.y + length * way.y};
}

typedef struct rectangle {
  vec2 centre, axis[2];
  double half[2];
} rectangle;

static rectangle outline_of(const mjModel *m, const mjData *d, int geom) {
  const double *place = d->geom_xpos + 3 * geom, *turn = d->geom_xmat + 9 * geom, *half = m->geom_size + 3 * geom;
  return (rectangle){{place[0], place[1]}, {{turn[0], turn[3]}, {turn[1], turn[4]}}, {half[0], half[1]}};
}

// A contact where the two surfaces are `depth` (negative) apart along normal, which points from geom 1 to geom 2.
static void set_contact(mjContact *contact, vec2 middle, vec2 normal, double depth) {
  memset(contact->frame, 0, sizeof contact->frame);
  contact->frame[0] = normal.x;
  contact->frame[1] = normal.y;
  contact->frame[3] = -normal.y; // sideways; the third axis is up, where nothing moves
  contact->frame[4] = normal.x;
  contact->pos[0] = middle.x;
  contact->pos[1] = middle.y;
  contact->pos[2] = 0.0;
  contact->dist = depth;
}

// The corners of geom 2 behind the plane of geom 1.
static int plane_rectangle(const mjModel *m, const mjData *d, mjContact *contact, int plane, int box, double margin) {
  const double *place = d->geom_xpos + 3 * plane, *turn = d->geom_xmat + 9 * plane;
  const vec2 origin = {place[0], place[1]}, normal = {turn[2], turn[5]};
  const rectangle r = outline_of(m, d, box);
  int count = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec2 at = along(r.centre, r.axis[0], corner & 1 ? r.half[0] : -r.half[0]);
    at = along(at, r.axis[1], corner & 2 ? r.half[1] : -r.half[1]);
    double depth = dot(at, normal) - dot(origin, normal);
    if (depth < margin) set_contact(&contact[count++], along(at, normal, -depth / 2), normal, depth);
  }
  return count;
}

// How far r reaches from its centre along a direction.
static double reach(const rectangle *r, vec2 way) {
  return r->half[0] * fabs(dot(r->axis[0], way)) + r->half[1] * fabs(dot(r->axis[1], way));
}

// The side through which the two overlap least.
typedef struct side {
  int owner, axis; // rectangle 0 or 1, its axis
  double gap_m;    // negative where they overlap
} side;

static side least_overlap(const rectangle r[2]) {
  const vec2 way = {r[1].centre.x - r[0].centre.x, r[1].centre.y - r[0].centre.y};
  side best = {0, 0, -INFINITY};
  for (int owner = 0; owner < 2; owner++)
    for (int axis = 0; axis < 2; axis++) {
      vec2 normal = r[owner].axis[axis];
      double gap = fabs(dot(way, normal)) - r[owner].half[axis] - reach(&r[!owner], normal);
      if (gap > best.gap_m + AXIS_BIAS_M) best = (side){owner, axis, gap};
    }
  return best;
}

// The edge of the other rectangle that faces the side, cut to the side's length: its ends that lie behind the side.
static int rectangles(const mjModel *m, const mjData *d, mjContact *contact, int geom1, int geom2, double margin) {
  const rectangle r[2] = {outline_of(m, d, geom1), outline_of(m, d, geom2)};
  const side s = least_overlap(r);
  if (s.gap_m >= margin) return 0;
  const rectangle *own = &r[s.owner], *other = &r[!s.owner];
  const vec2 way = {other->centre.x - own->centre.x, other->centre.y - own->centre.y};
  vec2 normal = own->axis[s.axis];
  if (dot(normal, way) < 0) normal = (vec2){-normal.x, -normal.y};
  const vec2 sideways = {-normal.y, normal.x};

  int facing = fabs(dot(other->axis[1], normal)) > fabs(dot(other->axis[0], normal));
  double towards = dot(other->axis[facing], normal) > 0 ? -other->half[facing] : other->half[facing];
  const vec2 middle = along(way, other->axis[facing], towards), edge = other->axis[!facing]; // from own's centre
  double low = -other->half[!facing], high = other->half[!facing];
  double slope = dot(edge, sideways), start = dot(middle, sideways), length = own->half[!s.axis];
  if (fabs(slope) > 1e-9) { // always: the facing edge lies within 45 degrees of the side
    low = fmax(low, ((slope > 0 ? -length : length) - start) / slope);
    high = fmin(high, ((slope > 0 ? length : -length) - start) / slope);
  }
  const double end[2] = {low, high};
  int count = 0;
  for (int k = 0; k < 2 && low <= high; k++) {
    vec2 at = along(middle, edge, end[k]);
    double depth = dot(at, normal) - own->half[s.axis];
    if (depth >= margin) continue;
    at = along(along(own->centre, at, 1.0), normal, -depth / 2);
    vec2 out = s.owner == 0 ? normal : (vec2){-normal.x, -normal.y};
    set_contact(&contact[count++], at, out, depth);
  }
  return count;
}

static mjfCollision mujoco_plane_box, mujoco_box_box; // set once, before any step

static bool marked(const mjModel *m, int geom) {
  return m->nuser_geom > 0 && m->geom_user[(size_t)geom * (size_t)m->nuser_geom] > 0;
}

static int plane_box(const mjModel *m, const mjData *d, mjContact *contact, int geom1, int geom2, mjtNum margin) {
  mjfCollision meet = marked(m, geom2) ? plane_rectangle : mujoco_plane_box;
  return meet(m, d, contact, geom1, geom2, margin);
}

static int box_box(const mjModel *m, const mjData *d, mjContact *contact, int geom1, int geom2, mjtNum margin) {
  mjfCollision meet = marked(m, geom1) || marked(m, geom2) ? rectangles : mujoco_box_box;
  return meet(m, d, contact, geom1, geom2, margin);
}

static void install(void) {
  mujoco_plane_box = mjCOLLISIONFUNC[mjGEOM_PLANE][mjGEOM_BOX];
  mujoco_box_box = mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_BOX];
  mjCOLLISIONFUNC[mjGEOM_PLANE][mjGEOM_BOX] = plane_box;
  mjCOLLISIONFUNC[mjGEOM_BOX][mjGEOM_BOX] = box_box;
}

void vs_outline_install(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, install);
}
