// The league's datagrams by protobuf-c. The generated types stay in this file.
#include "vsss/league_messages.h"

#include <math.h>
#include <string.h>

#include "league/firasim.pb-c.h"
#include "league/vssref.pb-c.h"
#include "vsss/field.h"
#include "vsss/geom.h"

#define DEGREES_PER_RAD (180 / VS_PI)

vs_status vs_league_supported(vs_error *err) {
  (void)err;
  return VS_OK;
}

static size_t pack(const void *message, uint8_t *out, size_t out_size) {
  const ProtobufCMessage *base = message;
  return protobuf_c_message_get_packed_size(base) <= out_size ? protobuf_c_message_pack(base, out) : 0;
}

static vs_status unpack(const ProtobufCMessageDescriptor *type, const uint8_t *data, size_t size,
                        ProtobufCMessage **out, vs_error *err) {
  *out = protobuf_c_message_unpack(type, NULL, size, data);
  return *out ? VS_OK : vs_fail(err, VS_FAIL, "%zu bytes that are no %s", size, type->short_name);
}

static void release(ProtobufCMessage *message) { protobuf_c_message_free_unpacked(message, NULL); }

static bool on_pitch(const vs_pitch *pitch, double x_m, double y_m) {
  return fabs(x_m) <= pitch->half_length_m + pitch->goal_depth_m && fabs(y_m) <= pitch->half_width_m; // false for NaN
}

// The packets for a simulator do not say which field they are for: the largest.
static bool on_field(double x_m, double y_m) { return on_pitch(vs_pitch_of(VS_5V5), x_m, y_m); }

// --- the world --------------------------------------------------------------------------------------------------------

size_t vs_fira_environment_encode(const vs_fira_environment *e, uint8_t *out, size_t out_size) {
  FiraMessage__Ball ball = FIRA_MESSAGE__BALL__INIT;
  FiraMessage__Field field = FIRA_MESSAGE__FIELD__INIT;
  FiraMessage__Frame frame = FIRA_MESSAGE__FRAME__INIT;
  FiraMessage__Environment message = FIRA_MESSAGE__ENVIRONMENT__INIT;
  FiraMessage__Robot robot[VS_TEAMS][VS_TEAM_MOST], *list[VS_TEAMS][VS_TEAM_MOST];
  const vs_pitch *pitch = vs_pitch_of(e->world.division);
  size_t count[VS_TEAMS] = {0};
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < pitch->team_size; i++) {
      const vs_robot *from = &e->world.robot[t][i];
      FiraMessage__Robot *to = &robot[t][i];
      if (!from->valid) continue;
      fira_message__robot__init(to);
      to->robot_id = (uint32_t)i;
      to->x = from->pose.x_m;
      to->y = from->pose.y_m;
      to->orientation = from->pose.theta_rad;
      to->vx = from->vx_mps;
      to->vy = from->vy_mps;
      to->vorientation = from->omega_radps;
      list[t][count[t]++] = to;
    }
  const vs_ball *b = &e->world.ball;
  ball.x = b->x_m, ball.y = b->y_m, ball.z = b->z_m;
  ball.vx = b->vx_mps, ball.vy = b->vy_mps, ball.vz = b->vz_mps;
  field.width = 2 * pitch->half_width_m;
  field.length = 2 * pitch->half_length_m;
  field.goal_width = 2 * pitch->goal_half_width_m;
  field.goal_depth = pitch->goal_depth_m;
  field.center_radius = pitch->circle_radius_m;
  field.penalty_width = 2 * pitch->area_half_width_m;
  field.penalty_depth = pitch->area_depth_m;
  field.penalty_point = pitch->half_length_m - pitch->penalty_mark_x_m; // before the goal line
  frame.ball = b->valid ? &ball : NULL;
  frame.robots_yellow = list[VS_YELLOW];
  frame.n_robots_yellow = count[VS_YELLOW];
  frame.robots_blue = list[VS_BLUE];
  frame.n_robots_blue = count[VS_BLUE];
  message.step = e->step;
  message.frame = &frame;
  message.field = &field;
  message.goals_blue = (uint32_t)e->goals[VS_BLUE];
  message.goals_yellow = (uint32_t)e->goals[VS_YELLOW];
  return pack(&message, out, out_size);
}

static void read_robots(const vs_pitch *pitch, FiraMessage__Robot *const *from, size_t n, vs_robot *to) {
  for (size_t k = 0; k < n; k++) {
    const FiraMessage__Robot *r = from[k];
    bool finite = isfinite(r->orientation) && isfinite(r->vx) && isfinite(r->vy) && isfinite(r->vorientation);
    if (r->robot_id >= (uint32_t)pitch->team_size || !on_pitch(pitch, r->x, r->y) || !finite) continue;
    to[r->robot_id] = (vs_robot){.pose = {r->x, r->y, vs_wrap_rad(r->orientation)},
                                 .vx_mps = r->vx,
                                 .vy_mps = r->vy,
                                 .omega_radps = r->vorientation,
                                 .valid = true};
  }
}

// Half-way between the two lengths.
static vs_division division_of(const FiraMessage__Field *f) {
  double between_m = vs_pitch_of(VS_3V3)->half_length_m + vs_pitch_of(VS_5V5)->half_length_m;
  return f && f->length > between_m ? VS_5V5 : VS_3V3;
}

vs_status vs_fira_environment_decode(const uint8_t *data, size_t size, vs_fira_environment *out, vs_error *err) {
  ProtobufCMessage *base;
  vs_status s = unpack(&fira_message__environment__descriptor, data, size, &base, err);
  if (s != VS_OK) return s;
  const FiraMessage__Environment *m = (const FiraMessage__Environment *)base;
  memset(out, 0, sizeof *out);
  out->step = m->step;
  out->goals[VS_BLUE] = (int)(m->goals_blue & 0xffff);
  out->goals[VS_YELLOW] = (int)(m->goals_yellow & 0xffff);
  if (!m->frame) {
    release(base);
    return vs_fail(err, VS_FAIL, "an Environment without a frame");
  }
  out->world.division = division_of(m->field);
  const vs_pitch *pitch = vs_pitch_of(out->world.division);
  read_robots(pitch, m->frame->robots_blue, m->frame->n_robots_blue, out->world.robot[VS_BLUE]);
  read_robots(pitch, m->frame->robots_yellow, m->frame->n_robots_yellow, out->world.robot[VS_YELLOW]);
  const FiraMessage__Ball *b = m->frame->ball;
  if (b && on_pitch(pitch, b->x, b->y) && isfinite(b->z) && isfinite(b->vx) && isfinite(b->vy) && isfinite(b->vz))
    out->world.ball = (vs_ball){b->x, b->y, b->z, b->vx, b->vy, b->vz, true};
  release(base);
  return VS_OK;
}

// --- commands and replacements ----------------------------------------------------------------------------------------

size_t vs_fira_packet_encode(const vs_fira_packet *p, bool degrees, uint8_t *out, size_t out_size) {
  FiraMessage__Command command[VS_FIRA_ROWS], *commands[VS_FIRA_ROWS];
  FiraMessage__Robot position[VS_FIRA_ROWS];
  FiraMessage__RobotReplacement place[VS_FIRA_ROWS], *places[VS_FIRA_ROWS];
  FiraMessage__BallReplacement ball = FIRA_MESSAGE__BALL_REPLACEMENT__INIT;
  FiraMessage__Commands cmd = FIRA_MESSAGE__COMMANDS__INIT;
  FiraMessage__Replacement replace = FIRA_MESSAGE__REPLACEMENT__INIT;
  FiraMessage__Packet message = FIRA_MESSAGE__PACKET__INIT;
  for (int k = 0; k < p->commands; k++) {
    fira_message__command__init(&command[k]);
    command[k].id = (uint32_t)p->command[k].robot;
    command[k].yellowteam = p->command[k].team == VS_YELLOW;
    command[k].wheel_left = p->command[k].wheels.left_radps;
    command[k].wheel_right = p->command[k].wheels.right_radps;
    commands[k] = &command[k];
  }
  for (int k = 0; k < p->robots; k++) {
    const vs_pose *pose = &p->place[k].pose;
    fira_message__robot__init(&position[k]);
    fira_message__robot_replacement__init(&place[k]);
    position[k].robot_id = (uint32_t)p->place[k].robot;
    position[k].x = pose->x_m;
    position[k].y = pose->y_m;
    position[k].orientation = pose->theta_rad * (degrees ? DEGREES_PER_RAD : 1);
    place[k].position = &position[k];
    place[k].yellowteam = p->place[k].team == VS_YELLOW;
    place[k].turnon = true;
    places[k] = &place[k];
  }
  cmd.robot_commands = commands;
  cmd.n_robot_commands = (size_t)p->commands;
  ball.x = p->ball.x_m, ball.y = p->ball.y_m, ball.vx = p->ball.vx_mps, ball.vy = p->ball.vy_mps;
  replace.ball = p->places_ball ? &ball : NULL;
  replace.robots = places;
  replace.n_robots = (size_t)p->robots;
  message.cmd = p->commands ? &cmd : NULL;
  message.replace = p->places_ball || p->robots ? &replace : NULL;
  return pack(&message, out, out_size);
}

static void read_commands(const FiraMessage__Commands *from, vs_fira_packet *out) {
  for (size_t k = 0; from && k < from->n_robot_commands; k++) {
    const FiraMessage__Command *c = from->robot_commands[k];
    if (c->id >= VS_TEAM_MOST || !isfinite(c->wheel_left) || !isfinite(c->wheel_right) ||
        out->commands == VS_FIRA_ROWS) {
      out->dropped++;
      continue;
    }
    int row = out->commands++;
    out->command[row].team = c->yellowteam ? VS_YELLOW : VS_BLUE;
    out->command[row].robot = (int)c->id;
    out->command[row].wheels = (vs_wheels){c->wheel_left, c->wheel_right};
  }
}

static void read_replacements(const FiraMessage__Replacement *from, bool degrees, vs_fira_packet *out) {
  if (!from) return;
  const FiraMessage__BallReplacement *b = from->ball;
  out->places_ball = b && on_field(b->x, b->y) && isfinite(b->vx) && isfinite(b->vy);
  if (b && !out->places_ball) out->dropped++;
  if (out->places_ball)
    out->ball =
        (vs_ball){.x_m = b->x, .y_m = b->y, .z_m = VS_BALL_RADIUS_M, .vx_mps = b->vx, .vy_mps = b->vy, .valid = true};
  for (size_t k = 0; k < from->n_robots; k++) {
    const FiraMessage__Robot *p = from->robots[k]->position;
    if (!p || p->robot_id >= VS_TEAM_MOST || !on_field(p->x, p->y) || !isfinite(p->orientation) ||
        out->robots == VS_FIRA_ROWS) {
      out->dropped++;
      continue;
    }
    int row = out->robots++;
    out->place[row].team = from->robots[k]->yellowteam ? VS_YELLOW : VS_BLUE;
    out->place[row].robot = (int)p->robot_id;
    out->place[row].pose = (vs_pose){p->x, p->y, vs_wrap_rad(p->orientation / (degrees ? DEGREES_PER_RAD : 1))};
  }
}

vs_status vs_fira_packet_decode(const uint8_t *data, size_t size, bool degrees, vs_fira_packet *out, vs_error *err) {
  ProtobufCMessage *base;
  vs_status s = unpack(&fira_message__packet__descriptor, data, size, &base, err);
  if (s != VS_OK) return s;
  const FiraMessage__Packet *m = (const FiraMessage__Packet *)base;
  out->commands = out->robots = out->dropped = 0;
  out->places_ball = false;
  read_commands(m->cmd, out);
  read_replacements(m->replace, degrees, out);
  release(base);
  return VS_OK;
}

void vs_fira_packet_fit(vs_fira_packet *p, vs_division division) {
  const vs_pitch *pitch = vs_pitch_of(division);
  int commands = 0, robots = 0;
  for (int k = 0; k < p->commands; k++)
    if (p->command[k].robot < pitch->team_size) p->command[commands++] = p->command[k];
  for (int k = 0; k < p->robots; k++)
    if (p->place[k].robot < pitch->team_size && on_pitch(pitch, p->place[k].pose.x_m, p->place[k].pose.y_m))
      p->place[robots++] = p->place[k];
  bool ball = p->places_ball && on_pitch(pitch, p->ball.x_m, p->ball.y_m);
  p->dropped += p->commands - commands + p->robots - robots + (p->places_ball ? !ball : 0);
  p->commands = commands;
  p->robots = robots;
  p->places_ball = ball;
}

// --- the referee ------------------------------------------------------------------------------------------------------

size_t vs_ref_command_encode(const vs_ref_command *c, uint8_t *out, size_t out_size) {
  VSSRef__Command message = VSSREF__COMMAND__INIT;
  message.foul = (VSSRef__Foul)c->foul;
  message.teamcolor = c->team < 0 ? VSSREF__COLOR__NONE : (VSSRef__Color)c->team;
  message.foulquadrant = (VSSRef__Quadrant)c->quadrant;
  message.timestamp = c->timestamp_s;
  message.gamehalf = (VSSRef__Half)c->half;
  return pack(&message, out, out_size);
}

vs_status vs_ref_command_decode(const uint8_t *data, size_t size, vs_ref_command *out, vs_error *err) {
  ProtobufCMessage *base;
  vs_status s = unpack(&vssref__command__descriptor, data, size, &base, err);
  if (s != VS_OK) return s;
  VSSRef__Command m = *(const VSSRef__Command *)base;
  release(base);
  int foul = (int)m.foul, team = (int)m.teamcolor, quadrant = (int)m.foulquadrant, half = (int)m.gamehalf;
  if (foul < 0 || foul >= VS_FOULS || team < 0 || team > 2 || quadrant < 0 || quadrant > 4 || half < 0 || half > 5)
    return vs_fail(err, VS_FAIL, "a referee's call with foul %d, colour %d, quadrant %d, half %d", foul, team, quadrant,
                   half);
  // The call is what matters: a HALT is obeyed whatever its time says.
  double timestamp_s = isfinite(m.timestamp) ? m.timestamp : 0;
  *out = (vs_ref_command){(vs_foul)foul, team == 2 ? -1 : team, quadrant, timestamp_s, half};
  return VS_OK;
}

size_t vs_ref_placement_encode(const vs_ref_placement *p, uint8_t *out, size_t out_size) {
  VSSRef__Robot robot[VS_TEAM_MOST], *list[VS_TEAM_MOST];
  VSSRef__Frame frame = VSSREF__FRAME__INIT;
  VSSRef__Placement message = VSSREF__PLACEMENT__INIT;
  for (int i = 0; i < VS_TEAM_MOST; i++) {
    if (!p->given[i]) continue;
    vssref__robot__init(&robot[i]);
    robot[i].robot_id = (uint32_t)i;
    robot[i].x = p->pose[i].x_m;
    robot[i].y = p->pose[i].y_m;
    robot[i].orientation = p->pose[i].theta_rad * DEGREES_PER_RAD;
    list[frame.n_robots++] = &robot[i];
  }
  frame.robots = list;
  frame.teamcolor = (VSSRef__Color)p->team;
  message.world = &frame;
  return pack(&message, out, out_size);
}

static vs_status read_placement(const VSSRef__Frame *from, vs_ref_placement *out, vs_error *err) {
  int team = from ? (int)from->teamcolor : -1;
  memset(out, 0, sizeof *out);
  if (team != VS_BLUE && team != VS_YELLOW) return vs_fail(err, VS_FAIL, "a placement of no team");
  out->team = (vs_team)team;
  for (size_t k = 0; k < from->n_robots; k++) {
    const VSSRef__Robot *r = from->robots[k];
    if (r->robot_id >= VS_TEAM_MOST)
      return vs_fail(err, VS_FAIL, "%s places robot %u: there are 0 to %d", vs_team_name(out->team), r->robot_id,
                     VS_TEAM_MOST - 1);
    if (!on_field(r->x, r->y) || !isfinite(r->orientation))
      return vs_fail(err, VS_FAIL, "%s places robot %u at %g, %g m, %g degrees", vs_team_name(out->team), r->robot_id,
                     r->x, r->y, r->orientation);
    out->given[r->robot_id] = true;
    out->pose[r->robot_id] = (vs_pose){r->x, r->y, vs_wrap_rad(r->orientation / DEGREES_PER_RAD)};
  }
  return VS_OK;
}

vs_status vs_ref_placement_decode(const uint8_t *data, size_t size, vs_ref_placement *out, vs_error *err) {
  ProtobufCMessage *base;
  vs_status s = unpack(&vssref__placement__descriptor, data, size, &base, err);
  if (s != VS_OK) return s;
  s = read_placement(((const VSSRef__Placement *)base)->world, out, err);
  release(base);
  return s;
}
