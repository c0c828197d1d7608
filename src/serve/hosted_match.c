#include "vsss/hosted_match.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/control.h"
#include "vsss/field.h"
#include "vsss/geom.h"

enum { SEED_PLACEMENT = 2, SEED_PLAYER = 3 }; // parts of the match's seed, as in env

struct vs_hosted {
  vs_hosted_def def;
  vs_sim *sim;
  vs_control *control[VS_TEAMS]; // NULL: from outside
  vs_referee referee;
  vs_rng rng;
  vs_world truth;
  vs_phase phase;
  vs_event restart;    // the one that is being prepared
  vs_ref_command call; // the referee's word
  vs_hosted_said said; // gathered for the next frame
  double phase_s;      // spent in this phase
  double frame_s;      // 1 / frame_hz
  vs_division division;
  int team_size;
  int broken;     // the team whose player failed; -1: none
  bool goal_seen; // without our referee: this goal is counted
  uint64_t hash;
  int64_t silent_frames[VS_TEAMS];
  vs_wheels held[VS_TEAMS][VS_TEAM_MOST];   // from outside, rad/s of our wheels
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST]; // in force
  bool placed[VS_TEAMS];                    // a legal placement came for this restart
  bool drove[VS_TEAMS];                     // wheels were commanded while it was called
  vs_pose place[VS_TEAMS][VS_TEAM_MOST];
  bool asked[VS_TEAMS]; // for a time-out that has not begun
  int time_outs[VS_TEAMS];
  vs_world placed_at;   // where all were put at STOP
  bool started_falsely; // this restart came of it
};

const char *vs_phase_name(vs_phase phase) {
  static const char *const name[] = {"waiting", "called", "stopped", "play", "time-out", "over"};
  return name[phase];
}

static vs_status open_player(vs_hosted *m, int team, vs_error *err) {
  const char *uri = m->def.player[team];
  if (!uri) return VS_OK;
  vs_player *player = NULL;
  vs_status s = vs_player_open(uri, &player, err);
  if (s != VS_OK) return s;
  s = vs_control_new(player, &m->control[team], err);
  if (s != VS_OK) {
    vs_player_close(player);
    return s;
  }
  s = vs_control_plays(m->control[team], m->division, err);
  if (s != VS_OK) return s;
  return vs_control_reset(m->control[team], vs_seed_mix(m->def.seed, SEED_PLAYER + (uint64_t)team), false, err);
}

vs_status vs_hosted_new(const vs_hosted_def *def, vs_hosted **out, vs_error *err) {
  vs_hosted *m = calloc(1, sizeof *m);
  if (!m) return vs_fail(err, VS_FAIL, "out of memory for a match");
  m->def = *def;
  m->frame_s = 1.0 / vs_model_frame_hz(def->model);
  m->division = vs_model_division(def->model);
  m->team_size = vs_pitch_of(m->division)->team_size;
  m->hash = VS_HASH_START;
  m->broken = -1;
  m->rng = vs_rng_make(def->seed, SEED_PLACEMENT);
  vs_status s = vs_referee_init(&m->referee, &def->referee, err);
  if (s == VS_OK) s = vs_sim_new(def->model, &m->sim, err);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++) s = open_player(m, t, err);
  if (s != VS_OK) {
    vs_hosted_free(m);
    return s;
  }
  vs_sim_params params = vs_robot_preset_params(def->robot);
  vs_sim_reset(m->sim, &params);
  vs_sim_world(m->sim, &m->truth);
  m->phase = def->mode == VS_REFEREE_NONE ? VS_PHASE_PLAY : VS_PHASE_WAIT;
  m->call = (vs_ref_command){.foul = m->phase == VS_PHASE_PLAY ? VS_FOUL_GAME_ON : VS_FOUL_STOP, .team = -1};
  *out = m;
  return VS_OK;
}

void vs_hosted_free(vs_hosted *m) {
  if (!m) return;
  for (int t = 0; t < VS_TEAMS; t++)
    if (m->control[t]) vs_control_free(m->control[t]);
  if (m->sim) vs_sim_free(m->sim);
  free(m);
}

// --- from outside -----------------------------------------------------------------------------------------------------

bool vs_hosted_command(vs_hosted *m, vs_team team, int robot, vs_wheels wheels) {
  if (m->control[team] || robot >= m->team_size) return false;
  m->silent_frames[team] = 0;
  if (m->phase == VS_PHASE_CALLED && (wheels.left_radps != 0 || wheels.right_radps != 0)) m->drove[team] = true;
  vs_wheels ours = vs_robot_preset_wheels(m->def.robot, wheels);
  m->held[team][robot].left_radps = vs_clamp(ours.left_radps, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
  m->held[team][robot].right_radps = vs_clamp(ours.right_radps, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
  return true;
}

static void put(vs_hosted *m, const vs_world *placed) {
  vs_sim_place(m->sim, placed);
  vs_sim_world(m->sim, &m->truth);
  vs_referee_restarted(&m->referee, &m->truth);
  for (int t = 0; t < VS_TEAMS; t++)
    if (m->control[t]) vs_control_restart(m->control[t]);
}

bool vs_hosted_replace(vs_hosted *m, const vs_fira_packet *p) {
  if (!p->places_ball && p->robots == 0) return true;
  if (m->def.mode == VS_REFEREE_OWN) return false;
  vs_world placed = m->truth;
  if (p->places_ball) placed.ball = p->ball;
  for (int k = 0; k < p->robots; k++)
    if (p->place[k].robot < m->team_size) placed.robot[p->place[k].team][p->place[k].robot].pose = p->place[k].pose;
  put(m, &placed);
  return true;
}

vs_status vs_hosted_place(vs_hosted *m, const vs_ref_placement *p, vs_error *err) {
  if (m->phase != VS_PHASE_CALLED || m->control[p->team]) return VS_OK;
  vs_pose pose[VS_TEAM_MOST] = {{0}};
  vs_place_team(m->division, &m->restart, p->team, pose);
  for (int i = 0; i < m->team_size; i++)
    if (p->given[i]) pose[i] = p->pose[i];
  vs_status s = vs_placement_check(m->division, &m->restart, p->team, pose, err);
  if (s != VS_OK) return s;
  m->placed[p->team] = true;
  memcpy(m->place[p->team], pose, sizeof pose);
  return VS_OK;
}

static void enter(vs_hosted *m, vs_phase phase, vs_foul foul, int team, int quadrant) {
  m->phase = phase;
  m->phase_s = 0;
  m->call = (vs_ref_command){foul, team, quadrant, m->referee.game.time_s, m->referee.half + 1};
  if (m->said.calls < VS_HOSTED_CALLS) m->said.call[m->said.calls++] = m->call;
}

// What the referee of the network calls for an event, and who is meant.
static void call_restart(vs_hosted *m, const vs_event *event) {
  m->restart = *event;
  memset(m->placed, 0, sizeof m->placed);
  memset(m->drove, 0, sizeof m->drove);
  switch (event->kind) {
  case VS_EVENT_SHOOT_OUT:
  case VS_EVENT_PENALTY: enter(m, VS_PHASE_CALLED, VS_FOUL_PENALTY_KICK, event->team, 0); return;
  case VS_EVENT_FREE_KICK: enter(m, VS_PHASE_CALLED, VS_FOUL_FREE_KICK, event->team, 0); return;
  case VS_EVENT_GOAL_KICK: enter(m, VS_PHASE_CALLED, VS_FOUL_GOAL_KICK, event->team, event->quadrant); return;
  case VS_EVENT_FREE_BALL: enter(m, VS_PHASE_CALLED, VS_FOUL_FREE_BALL, -1, event->quadrant); return;
  case VS_EVENT_GOAL: // the conceding side's kick-off
    enter(m, VS_PHASE_CALLED, VS_FOUL_KICKOFF, event->team == VS_BLUE ? VS_YELLOW : VS_BLUE, 0);
    return;
  default: enter(m, VS_PHASE_CALLED, VS_FOUL_KICKOFF, event->team, 0); return;
  }
}

// True: one begins. The team that the call names is the one that asked.
static bool begin_time_out(vs_hosted *m) {
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!m->asked[t]) continue;
    m->asked[t] = false;
    m->time_outs[t]++;
    enter(m, VS_PHASE_TIME_OUT, VS_FOUL_HALT, t, 0);
    return true;
  }
  return false;
}

static void stop_play(vs_hosted *m, const vs_event *event) {
  m->restart = *event;
  if (!begin_time_out(m)) call_restart(m, event);
}

static void end_time_out(vs_hosted *m) {
  if (!begin_time_out(m)) call_restart(m, &m->restart);
}

vs_status vs_hosted_time_out(vs_hosted *m, vs_team team, vs_error *err) {
  const char *who = vs_team_name(team);
  vs_time_outs by = vs_time_outs_by(m->def.referee.rules);
  if (m->def.mode != VS_REFEREE_OWN) return vs_fail(err, VS_FAIL, "%s: a time-out is the other referee's to give", who);
  if (m->phase == VS_PHASE_WAIT || m->phase == VS_PHASE_OVER)
    return vs_fail(err, VS_FAIL, "%s: no time-out before or after the match", who);
  if (m->asked[team] || (m->phase == VS_PHASE_TIME_OUT && m->call.team == (int)team))
    return vs_fail(err, VS_FAIL, "%s has asked for a time-out already", who);
  if (m->time_outs[team] >= by.number)
    return vs_fail(err, VS_FAIL, "%s has had all its time-outs: %d by these rules", who, by.number);
  m->asked[team] = true;
  if (m->phase == VS_PHASE_CALLED || m->phase == VS_PHASE_STOPPED) begin_time_out(m);
  return VS_OK;
}

bool vs_hosted_ready(vs_hosted *m, vs_team team) {
  if (m->phase != VS_PHASE_TIME_OUT || m->call.team != (int)team) return false;
  end_time_out(m);
  return true;
}

int vs_hosted_time_outs_taken(const vs_hosted *m, vs_team team) { return m->time_outs[team]; }

void vs_hosted_begin(vs_hosted *m) {
  if (m->phase != VS_PHASE_WAIT || m->def.mode != VS_REFEREE_OWN) return;
  call_restart(m, &m->referee.game.last_event);
}

void vs_hosted_hear(vs_hosted *m, const vs_ref_command *call) {
  if (m->def.mode != VS_REFEREE_EXTERNAL) return;
  if (vs_ref_command_repeats(&m->call, call)) return;
  vs_phase phase = call->foul == VS_FOUL_GAME_ON                              ? VS_PHASE_PLAY
                   : call->foul == VS_FOUL_STOP || call->foul == VS_FOUL_HALT ? VS_PHASE_STOPPED
                                                                              : VS_PHASE_CALLED;
  if (phase == VS_PHASE_PLAY && m->phase != VS_PHASE_PLAY)
    for (int t = 0; t < VS_TEAMS; t++)
      if (m->control[t]) vs_control_restart(m->control[t]);
  m->phase = phase;
  m->call = *call;
}

// --- restarts ---------------------------------------------------------------------------------------------------------

static bool overlap(const vs_world *w) {
  for (int i = 0, n = vs_team_size(w); i < n; i++)
    for (int k = 0; k < n; k++) {
      const vs_pose *a = &w->robot[VS_BLUE][i].pose, *b = &w->robot[VS_YELLOW][k].pose;
      if (vs_distance_m(a->x_m, a->y_m, b->x_m, b->y_m) < VS_ROBOT_SIZE_M) return true;
    }
  return false;
}

// A placement that was sent, else robots of a team from outside that drove to legal places.
static bool own_places(vs_hosted *m, int team, vs_pose pose[VS_TEAM_MOST]) {
  if (m->control[team]) return false;
  if (m->placed[team]) {
    memcpy(pose, m->place[team], sizeof m->place[team]);
    return true;
  }
  for (int i = 0; i < m->team_size; i++) pose[i] = m->truth.robot[team][i].pose;
  return m->drove[team] && vs_placement_check(m->division, &m->restart, (vs_team)team, pose, NULL) == VS_OK;
}

static void place_all(vs_hosted *m) {
  vs_world standard, placed;
  vs_place(m->def.referee.placement, &m->restart, &m->truth, &m->rng, &standard);
  vs_place_without(&m->referee, &standard);
  placed = standard;
  // The kicking team's wish goes first where both want the same place.
  int kicker = m->call.team < 0 ? VS_BLUE : m->call.team;
  for (int k = 0; k < VS_TEAMS; k++) {
    int t = k == 0 ? kicker : !kicker;
    vs_pose pose[VS_TEAM_MOST];
    if (!own_places(m, t, pose)) continue;
    vs_world with = placed;
    for (int i = 0; i < m->team_size; i++) with.robot[t][i].pose = pose[i];
    for (int i = 0; i < m->team_size; i++)
      if (vs_referee_off(&m->referee, (vs_team)t, i))
        with.robot[t][i].pose = vs_world_beside(m->division, (vs_team)t, i);
    if (!overlap(&with)) placed = with;
  }
  put(m, &placed);
  m->placed_at = m->truth;
}

// False: it was a false start, and another restart is called. One that follows at once is put right without a call: play
// would never begin.
static bool may_start(vs_hosted *m, vs_event *event) {
  vs_referee judged = m->referee;
  vs_event foul;
  vs_start start = m->def.pause_s > 0 ? vs_referee_start(&judged, &m->placed_at, &m->truth, &foul) : VS_START_PLAY;
  m->started_falsely = start == VS_START_FOUL && !m->started_falsely;
  if (m->started_falsely) {
    m->referee = judged;
    *event = foul;
    stop_play(m, event);
    return false;
  }
  if (start != VS_START_PLAY) put(m, &m->placed_at);
  return true;
}

static void send_off(vs_hosted *m) {
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < m->team_size; i++)
      if (vs_referee_off(&m->referee, (vs_team)t, i)) vs_sim_put_beside(m->sim, (vs_team)t, i);
  vs_sim_world(m->sim, &m->truth);
}

static void referee_frame(vs_hosted *m, vs_event *event) {
  if (m->phase == VS_PHASE_PLAY) {
    *event = vs_referee_step(&m->referee, &m->truth, m->frame_s);
    if (m->referee.over)
      enter(m, VS_PHASE_OVER, VS_FOUL_HALT, -1, 0);
    else if (event->kind == VS_EVENT_SENT_OFF)
      send_off(m);
    else if (event->kind != VS_EVENT_NONE)
      stop_play(m, event);
    if (m->phase == VS_PHASE_PLAY || m->referee.over || m->def.pause_s > 0) return;
  }
  double time_out_s = vs_time_outs_by(m->def.referee.rules).length_s;
  if (m->phase == VS_PHASE_TIME_OUT && m->phase_s + 0.5 * m->frame_s >= time_out_s) {
    end_time_out(m);
    if (m->def.pause_s > 0) return;
  }
  if (m->phase == VS_PHASE_CALLED && m->phase_s + 0.5 * m->frame_s >= m->def.pause_s) {
    enter(m, VS_PHASE_STOPPED, VS_FOUL_STOP, m->call.team, m->call.quadrant);
    place_all(m);
    if (m->def.pause_s > 0) return;
  }
  if (m->phase == VS_PHASE_STOPPED && m->phase_s + 0.5 * m->frame_s >= m->def.pause_s) {
    if (!may_start(m, event)) return;
    enter(m, VS_PHASE_PLAY, VS_FOUL_GAME_ON, -1, 0);
    for (int t = 0; t < VS_TEAMS; t++)
      if (m->control[t]) vs_control_restart(m->control[t]);
  }
}

// Without our rules a goal counts once, until the ball is back on the field.
static void count_goals(vs_hosted *m, vs_event *event) {
  m->referee.game.time_s += m->phase == VS_PHASE_PLAY ? m->frame_s : 0;
  const vs_ball *ball = &m->truth.ball;
  const vs_pitch *pitch = vs_pitch_of(m->division);
  bool in_goal =
      fabs(ball->x_m) > pitch->half_length_m + VS_BALL_RADIUS_M && fabs(ball->y_m) < pitch->goal_half_width_m;
  if (in_goal && !m->goal_seen) {
    *event = (vs_event){
        .kind = VS_EVENT_GOAL, .team = ball->x_m > 0 ? VS_BLUE : VS_YELLOW, .time_s = m->referee.game.time_s};
    m->referee.game.score[event->team]++;
    m->referee.game.last_event = *event;
  }
  m->goal_seen = in_goal;
}

// --- a frame ----------------------------------------------------------------------------------------------------------

static vs_status decide(vs_hosted *m, vs_error *err) {
  for (int t = 0; t < VS_TEAMS; t++) {
    m->silent_frames[t]++;
    if (!m->control[t]) {
      memcpy(m->wheels[t], m->held[t], sizeof m->wheels[t]);
      continue;
    }
    memset(m->wheels[t], 0, sizeof m->wheels[t]);
    if (m->phase != VS_PHASE_PLAY) continue;
    vs_status s =
        vs_control_step(m->control[t], (vs_team)t, &m->truth, &m->referee.game, m->frame_s, m->wheels[t], NULL, err);
    if (s != VS_OK) {
      m->broken = t;
      vs_fail_prefix(err, "%s", vs_team_name((vs_team)t));
      return s;
    }
  }
  return VS_OK;
}

vs_status vs_hosted_frame(vs_hosted *m, vs_hosted_said *said, vs_error *err) {
  vs_status s = decide(m, err);
  vs_referee_hold_off(&m->referee, m->wheels);
  if (s == VS_OK) s = vs_sim_frame(m->sim, (const vs_wheels(*)[VS_TEAM_MOST])m->wheels, err);
  if (s != VS_OK) {
    vs_fail_prefix(err, "match at %.2f s", m->referee.game.time_s);
    return s;
  }
  vs_sim_world(m->sim, &m->truth);
  m->hash = vs_world_hash(m->hash, &m->truth);
  m->phase_s += m->frame_s;
  if (m->def.mode == VS_REFEREE_OWN)
    referee_frame(m, &m->said.event);
  else
    count_goals(m, &m->said.event);
  *said = m->said;
  memset(&m->said, 0, sizeof m->said);
  return VS_OK;
}

const vs_world *vs_hosted_world(const vs_hosted *m) { return &m->truth; }
const vs_referee *vs_hosted_referee(const vs_hosted *m) { return &m->referee; }
const vs_game *vs_hosted_game(const vs_hosted *m) { return &m->referee.game; }
vs_phase vs_hosted_phase(const vs_hosted *m) { return m->phase; }
const vs_ref_command *vs_hosted_call(const vs_hosted *m) { return &m->call; }
int vs_hosted_broken(const vs_hosted *m) { return m->broken; }
uint64_t vs_hosted_hash(const vs_hosted *m) { return m->hash; }
void vs_hosted_wheels(const vs_hosted *m, vs_wheels out[VS_TEAMS][VS_TEAM_MOST]) {
  memcpy(out, m->wheels, sizeof m->wheels);
}
double vs_hosted_silence_s(const vs_hosted *m, vs_team team) {
  return m->control[team] ? 0 : (double)m->silent_frames[team] * m->frame_s;
}
