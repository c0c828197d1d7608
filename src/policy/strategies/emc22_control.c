// EMC-2022: from a robot's command to wheel speeds in m/s, around obstacles.
#include "emc22.h"

#define HALF_TRACK_M 0.04 // the strategy's own constant
#define FAR_M        0.3  // from the ball

static void set_wheels(emc22_robot *r, double linear_mps, double angular_radps) {
  r->wheel_mps[0] = linear_mps - HALF_TRACK_M * angular_radps;
  r->wheel_mps[1] = linear_mps + HALF_TRACK_M * angular_radps;
}

// How much an obstacle turns the course: away from it, by weight over distance.
static double turn_from(const emc22_robot *r, double course_rad, vs_point obstacle, double weight) {
  double side = vs_wrap_rad(course_rad - vs_point_angle(r->at, obstacle));
  double distance = fmax(vs_point_distance(r->at, obstacle), 0.001); // where two measured poses coincide
  return (side >= 0.0 ? weight : -weight) / distance;
}

static double avoid(const emc22_state *s, int robot, double course_rad) {
  const emc22_robot *r = &s->robot[robot];
  if (robot == s->role[EMC22_KEEPER]) return course_rad;
  bool attacker = robot == s->role[EMC22_ATTACKER], far = vs_point_distance(r->at, s->ball) > FAR_M;
  double turn = 0.0;
  for (int i = 0; i < s->adversaries; i++)
    if ((!attacker || far) && vs_point_distance(s->adversary[i], s->ball) > FAR_M)
      turn += turn_from(r, course_rad, s->adversary[i], 0.07);
  const vs_point foot[] = {{r->at.x, 0.0}, {r->at.x, EMC22_WIDTH_M}, {0.0, r->at.y}, {EMC22_LENGTH_M, r->at.y}};
  for (int i = 0; i < 4; i++) turn += turn_from(r, course_rad, foot[i], 0.04);
  vs_point keeper = s->robot[s->role[EMC22_KEEPER]].at;
  turn += turn_from(r, course_rad, keeper, 0.07);
  if (!attacker)
    turn += turn_from(r, course_rad, s->robot[s->role[EMC22_ATTACKER]].at, 0.07);
  else if (far)
    turn += turn_from(r, course_rad, s->robot[s->role[EMC22_DEFENDER]].at, 0.05);
  return course_rad + turn;
}

// Error to a course for the end that is nearer to it: direction +1 front, -1 rear.
static double end_error(double theta_rad, double course_rad, double *direction) {
  double e = vs_wrap_rad(course_rad - theta_rad);
  *direction = fabs(e) > VS_PI / 2 ? -1.0 : 1.0;
  return *direction < 0.0 ? vs_wrap_rad(course_rad - theta_rad - VS_PI) : e;
}

static double saturate(double value) { return vs_clamp(value, -1.0, 1.0); }

static void curve(emc22_robot *r, double e, double direction, double kgz, double speed_mps) {
  double bend = direction * kgz * tan(direction * e / 2.0);
  r->wheel_mps[0] = speed_mps * saturate(direction - sin(e) - bend);
  r->wheel_mps[1] = speed_mps * saturate(direction + sin(e) + bend);
}

static void drive(emc22_state *s, int robot, double course_rad) {
  emc22_robot *r = &s->robot[robot];
  bool keeper = robot == s->role[EMC22_KEEPER];
  double kgz = keeper ? 0.7 : 0.22, direction;
  double e = end_error(r->theta_rad, avoid(s, robot, course_rad), &direction);
  switch (r->command.kind) {
  case EMC_POSITION: {
    double speed = r->command.speed_mps * tanh(5.0 * vs_point_distance(r->at, r->command.target));
    if (keeper && !emc22_penalty_against(s))
      set_wheels(r, direction * 0.8 * speed * cos(e), 20.0 * e);
    else
      curve(r, e, direction, kgz, speed * cos(e));
    break;
  }
  case EMC_ORIENTATION: set_wheels(r, 0.0, keeper ? 7.0 * e : 0.0); break; // field players do not turn
  default: curve(r, e, direction, kgz, r->command.speed_mps); break;
  }
}

static void follow(emc22_state *s, int robot) {
  emc22_robot *r = &s->robot[robot];
  const emc_command *c = &r->command;
  switch (c->kind) {
  case EMC_NONE: set_wheels(r, 0.0, 0.0); break;
  case EMC_SPIN: set_wheels(r, 0.0, c->spin_radps); break;
  case EMC_POSITION:
    if (vs_point_distance(r->at, c->target) < 0.005)
      set_wheels(r, 0.0, 0.0);
    else
      drive(s, robot, vs_point_angle(r->at, c->target));
    break;
  case EMC_UVF: drive(s, robot, emc_uvf_angle(r->at, c->target, c->angle_rad, 1.7)); break;
  case EMC_VECTOR:
  case EMC_ORIENTATION: drive(s, robot, c->angle_rad); break;
  }
}

// A keeper that has spun first comes to rest along its goal. True: that replaces its command in this tick.
static bool settle(emc22_state *s, emc22_robot *g) {
  if (!g->spun || g->command.kind == EMC_SPIN || !(fabs(g->wheel_mps[0] + g->wheel_mps[1]) < 0.2)) return false;
  if (fabs(g->omega_radps) < 1.0) {
    g->spun = false;
    return false;
  }
  double direction, e = end_error(g->theta_rad, VS_PI / 2, &direction);
  set_wheels(g, 0.0, emc22_penalty_against(s) ? 0.0 : 15.0 * e);
  return true;
}

void emc22_control(emc22_state *s) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    emc22_robot *r = &s->robot[i];
    if (r->command.kind == EMC_SPIN) r->spun = true;
    if (i == s->role[EMC22_KEEPER] && settle(s, r)) continue;
    follow(s, i);
  }
}
