// PY-VSSS-INF: from a command to the wheels. The original's formulas are kept where they are wrong as well: a local
// frame that is no rotation, a distance to the wrong origin, a mirrored error when driving forwards.
#include "inf.h"

#define SPIRAL_PX 5.9

static double saturate(double value) { return vs_clamp(value, -1.0, 1.0); }

static void look(const inf_robot *r, double command[2]) {
  const inf_command *c = &r->command;
  double to = c->toward_angle ? c->angle_rad : atan2(c->toward.y - r->at.y, -(c->toward.x - r->at.x));
  double from = r->o_rad;
  if (vs_wrap_rad(to - from + VS_PI / 2) < 0.0) from = vs_wrap_rad(from + VS_PI); // either end may face it
  double e = vs_wrap_rad(to - from);
  bool there = fabs(e) < vs_rad(2);
  command[0] = there ? 0.0 : saturate(c->speed * e) * c->speed;
  command[1] = there ? 0.0 : saturate(-c->speed * e) * c->speed;
}

// Radius of the approach: small near the side walls and near the target.
static double approach_radius(vs_point p, vs_point target) {
  if (p.y >= INF_AREA_HIGH_PX || p.y < INF_AREA_LOW_PX) return 50.0 * 0.06;
  return 50.0 * (fabs(p.x - target.x) > 250.0 ? 1.0 : 0.1);
}

// Angle of one spiral of the move-to-goal field. The distance is from a local point to the absolute target.
static double spiral(double x, double y, double side, double radius, vs_point target) {
  double distance = vs_distance_m(x, y, target.x, target.y);
  double turn = distance > radius ? VS_PI / 2 * (2.0 - (radius + SPIRAL_PX) / (distance + SPIRAL_PX))
                                  : VS_PI / 2 * sqrt(distance / radius);
  return atan2(y, x) + side * turn;
}

// Direction of the field at a local point.
static vs_point field_direction(double x, double y, double radius, vs_point target) {
  if (y < -radius) {
    double a = spiral(x, y - radius, -1.0, radius, target);
    return (vs_point){cos(a), sin(a)};
  }
  if (y >= radius) {
    double a = spiral(x, y + radius, 1.0, radius, target);
    return (vs_point){cos(a), sin(a)};
  }
  double a = spiral(x, y - radius, 1.0, radius, target), c = spiral(x, y + radius, -1.0, radius, target);
  double wa = fabs(y + radius) / (2.0 * radius), wc = fabs(y - radius) / (2.0 * radius);
  return (vs_point){wa * cos(a) + wc * cos(c), wa * sin(a) + wc * sin(c)};
}

// Which way to drive from p so as to reach the target looking at `toward`.
static double course(vs_point p, vs_point target, vs_point toward) {
  double radius = approach_radius(p, target);
  double ux = toward.x - target.x, uy = toward.y - target.y;
  if (ux == 0.0 || uy == 0.0) ux = -1.0, uy = 0.0;
  double length = sqrt(ux * ux + uy * uy);
  ux /= length, uy /= length;
  double dx = p.x - target.x, dy = p.y - target.y;
  double determinant = ux * ux - uy * uy;
  if (determinant == 0.0) determinant = 1e-12; // a diagonal axis stops the original; here the field just points away
  double lx = (ux * dx - uy * dy) / determinant, ly = (ux * dy - uy * dx) / determinant;
  vs_point m = field_direction(lx, ly, radius, target);
  double phi = atan2(uy * m.x + ux * m.y, ux * m.x + uy * m.y);
  return atan2(1.3 / INF_HEIGHT_PX * sin(phi), 1.5 / INF_WIDTH_PX * cos(phi)); // back from pixels to a true angle
}

// Forwards or backwards. After a change of mind the next call, of whichever robot, keeps what it had.
static void choose_front(inf_state *s, inf_robot *r, double course_rad) {
  if (s->hold) {
    s->hold = false;
    return;
  }
  int front = cos(course_rad + r->o_rad) > 0.0 ? 1 : -1;
  s->hold = front != r->front;
  r->front = front;
}

static void go_to(inf_state *s, inf_robot *r, double command[2]) {
  const inf_command *c = &r->command;
  vs_point toward = c->toward;
  if (c->toward_angle) toward = (vs_point){r->at.x + cos(VS_PI - c->angle_rad), r->at.y + sin(VS_PI - c->angle_rad)};
  double course_rad = course(r->at, c->target, toward), theta = -r->o_rad;
  choose_front(s, r, course_rad);
  double e = vs_wrap_rad(r->front > 0 ? course_rad + theta : course_rad - theta);
  double distance = vs_point_distance(r->at, c->target);
  double gain =
      c->speed * (r->has_moved ? 1.0 : 0.75) * (1.0 - exp(-distance * distance / 450.0)) * exp(-e * e / 450.0);
  r->has_moved = true;
  command[0] = saturate(r->front + sin(e)) * gain;
  command[1] = saturate(r->front - sin(e)) * gain;
}

void inf_control(inf_state *s, int robot, double command[2]) {
  inf_robot *r = &s->robot[robot];
  double v = r->command.speed;
  switch (r->command.kind) {
  case INF_GOTO: go_to(s, r, command); break;
  case INF_LOOK: look(r, command); break;
  case INF_TURN:
    command[0] = r->command.clockwise ? v : -v;
    command[1] = -command[0];
    break;
  }
}
