// Frame by frame, in real time.
#include <math.h>
#include <string.h>

#include "rig_internal.h"
#include "vsss/clock.h"
#include "vsss/field.h"
#include "vsss/observe.h"

#define FRAME_US   (1e6 / VS_CAMERA_HZ)
#define MAX_BEHIND 30    // frames; beyond them time is given up, not made up for
#define TOUCH_M    0.004 // ball to robot

static void publish(vs_rig *r, vs_channel channel) {
  vs_message *m = &r->message;
  m->channel = channel;
  m->utime_us = vs_clock_wall_us();
  m->utime_capture_us = r->truth.time_us + m->utime_us - vs_clock_monotonic_us();
  m->seq = (int32_t)r->truth.seq;
  vs_bus_publish(r->bus, m, NULL); // a message that is lost is lost
}

static void tell(vs_rig *r, const vs_event *event) {
  if (!r->bus) return;
  const vs_game *game = vs_env_game(r->env);
  if (event->kind != VS_EVENT_NONE) {
    r->message.as.referee = (vs_msg_referee){.event = *event, .duration_s = game->duration_s};
    memcpy(r->message.as.referee.score, game->score, sizeof game->score);
    publish(r, VS_CH_REFEREE);
  }
  r->message.as.world = (vs_msg_world){.world = r->truth, .game = *game, .asks_team = -1};
  publish(r, VS_CH_TRUTH);
}

// Whether the ball's rim is at the square of an own robot.
static bool touching(const vs_rig *r) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_pose *p = &r->truth.robot[r->def.team][i].pose;
    double dx = r->truth.ball.x_m - p->x_m, dy = r->truth.ball.y_m - p->y_m;
    double u = fabs(cos(p->theta_rad) * dx + sin(p->theta_rad) * dy) - 0.5 * VS_ROBOT_SIZE_M;
    double v = fabs(cos(p->theta_rad) * dy - sin(p->theta_rad) * dx) - 0.5 * VS_ROBOT_SIZE_M;
    if (hypot(fmax(u, 0), fmax(v, 0)) < VS_BALL_RADIUS_M + TOUCH_M) return true;
  }
  return false;
}

static void count(vs_rig *r) {
  r->stats.frames++;
  bool driven = false;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    driven = driven || r->wheels[i].left_radps != 0.0 || r->wheels[i].right_radps != 0.0;
  r->stats.driven += driven;
  if (!touching(r)) {
    r->apart_s += FRAME_US * 1e-6;
    return;
  }
  if (r->apart_s >= VS_RIG_TOUCH_APART_S) r->stats.touches++;
  r->apart_s = 0.0;
}

// One frame of play. What the motors were told at the frame before is what they did until this one.
static vs_status play(vs_rig *r, vs_event *event, vs_error *err) {
  float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
  vs_action_from_wheels(r->wheels, action);
  vs_status s = vs_env_set_action(r->env, r->def.team, action, err);
  if (s == VS_OK) s = vs_env_frame(r->env, event, err);
  if (s != VS_OK) return s;
  vs_env_truth(r->env, &r->truth);
  count(r);
  return VS_OK;
}

// How many frames are due: 1, or more when the machine was late.
static int wait_for_frame(vs_rig *r) {
  if (r->next_us == 0.0) r->next_us = (double)vs_clock_monotonic_us();
  vs_wheels measured[VS_TEAM_SIZE];
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_robot *robot = &r->truth.robot[r->def.team][i];
    measured[i] = (vs_wheels){robot->left_radps, robot->right_radps};
  }
  vs_robots_serve(&r->robots, measured, (int64_t)r->next_us);
  int behind = (int)floor(((double)vs_clock_monotonic_us() - r->next_us) / FRAME_US);
  if (behind > MAX_BEHIND) r->next_us += behind * FRAME_US;
  return behind > MAX_BEHIND || behind < 0 ? 1 : 1 + behind;
}

#define MOMENTS 5 // of an exposure: at 1.4 m/s and 10 ms they are 3 mm apart

static void move(vs_world *w, double dt_s) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_robot *r = &w->robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    r->pose.x_m += dt_s * r->vx_mps;
    r->pose.y_m += dt_s * r->vy_mps;
    r->pose.theta_rad += dt_s * r->omega_radps;
  }
  w->ball.x_m += dt_s * w->ball.vx_mps;
  w->ball.y_m += dt_s * w->ball.vy_mps;
}

// The shutter is open around the moment of the truth.
static vs_status expose(vs_rig *r, vs_error *err) {
  if (!r->moment) return vs_render_world(r->render, &r->truth, NULL, r->rgb, err);
  size_t bytes = 3 * (size_t)r->def.width_px * (size_t)r->def.height_px;
  memset(r->exposed, 0, bytes * sizeof *r->exposed);
  for (int k = 0; k < MOMENTS; k++) {
    vs_world then = r->truth;
    move(&then, r->def.optics.exposure_s * ((k + 0.5) / MOMENTS - 0.5));
    vs_status s = vs_render_world(r->render, &then, NULL, r->moment, err);
    if (s != VS_OK) return s;
    for (size_t i = 0; i < bytes; i++) r->exposed[i] = (uint16_t)(r->exposed[i] + r->moment[i]);
  }
  for (size_t i = 0; i < bytes; i++) r->rgb[i] = (uint8_t)((r->exposed[i] + MOMENTS / 2) / MOMENTS);
  return VS_OK;
}

vs_status vs_rig_step(vs_rig *r, vs_rig_step_result *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  int due = wait_for_frame(r);
  out->playing = vs_frame_server_get_stats(r->camera).clients > 0;
  vs_status s = VS_OK;
  vs_event event = {0};
  if (vs_env_over(r->env)) {
    s = vs_env_reset(r->env, vs_seed_mix(r->def.seed, ++r->matches), err);
    vs_env_truth(r->env, &r->truth);
    event.kind = VS_EVENT_KICK_OFF;
  } else if (out->playing && !r->begun) {
    event.kind = VS_EVENT_KICK_OFF;
  }
  r->begun = out->playing;
  for (int i = 0; i < due && s == VS_OK && !out->over; i++) {
    if (event.kind != VS_EVENT_NONE)
      out->event = event; // a match begins; its first frame is the next
    else if (out->playing)
      s = play(r, &event, err);
    if (s != VS_OK) return s;
    if (event.kind != VS_EVENT_NONE) out->event = event;
    r->truth.time_us = (int64_t)r->next_us;
    r->truth.seq = r->seq++;
    vs_robots_wheels(&r->robots, r->truth.time_us, r->wheels);
    tell(r, &event);
    event.kind = VS_EVENT_NONE;
    out->over = out->playing && vs_env_over(r->env);
    r->next_us += FRAME_US;
  }
  if (s == VS_OK) s = expose(r, err);
  if (s != VS_OK) return s;
  vs_optics_apply(&r->optics, r->rgb, r->truth.seq);
  vs_frame_server_put(r->camera, r->rgb, r->truth.time_us, r->truth.seq);
  out->skipped = due - 1;
  r->stats.late += due - 1;
  out->truth = r->truth;
  return VS_OK;
}

vs_rig_stats vs_rig_get_stats(vs_rig *r) {
  r->stats.commands = r->robots.taken;
  // A physics step moves by the speed at its end, so that motion runs half a step ahead of its cause.
  double ahead_s = 0.5 * vs_model_step_s(r->def.model);
  r->stats.act_s = r->robots.acted ? 1e-6 * (double)r->robots.acted_us / (double)r->robots.acted - ahead_s : 0;
  r->stats.camera = vs_frame_server_get_stats(r->camera);
  return r->stats;
}

const vs_game *vs_rig_game(const vs_rig *r) { return vs_env_game(r->env); }
const char *vs_rig_camera_path(const vs_rig *r) { return r->camera_path; }
const char *vs_rig_radio_path(const vs_rig *r) { return r->radio_path; }
const char *vs_rig_calib_path(const vs_rig *r) { return r->calib_path; }
