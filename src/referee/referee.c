#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/word.h"
#include "referee_internal.h"
#include "vsss/check.h"
#include "vsss/field.h"
#include "vsss/geom.h"

vs_referee_def vs_referee_def_default(vs_rules rules) {
  vs_referee_def def = {.rules = rules,
                        .placement = VS_PLACEMENT_PAPER,
                        .duration_s = 120,
                        .goal_difference_stop = 10,
                        .halves = 1,
                        .kick_off = VS_BLUE,
                        .still_s = VS_STILL_S,
                        .still_distance_m = VS_STILL_DISTANCE_M,
                        .extra_half_s = 36,
                        .kick_s = rules == VS_RULES_SERIE_A_2023 ? 30 : 10};
  if (rules != VS_RULES_PAPER) {
    def.duration_s = 600;
    def.halves = 2;
    def.extra_half_s = rules == VS_RULES_LEAGUE ? 180 : 120;
  }
  return def;
}

void vs_referee_def_lasts(vs_referee_def *def, double duration_s) {
  def->extra_half_s *= duration_s / def->duration_s;
  def->duration_s = duration_s;
}

vs_time_outs vs_time_outs_by(vs_rules rules) {
  static const vs_time_outs by[] = {[VS_RULES_PAPER] = {0, 0},
                                    [VS_RULES_LEAGUE] = {2, 120},
                                    [VS_RULES_SERIE_A_2023] = {2, 180},
                                    [VS_RULES_LARC_2026] = {2, 180}};
  return by[rules];
}

vs_referee_def vs_referee_def_training(void) {
  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  def.placement = VS_PLACEMENT_RANDOM;
  def.duration_s = 40;
  def.end_at_first_goal = true;
  return def;
}

static vs_status check_def(const vs_referee_def *def, vs_error *err) {
  if (!(def->duration_s >= 1 && def->duration_s <= 7200))
    return vs_fail(err, VS_USAGE, "duration %g s: a match lasts 1 to 7200 s", def->duration_s);
  if (def->goal_difference_stop < 0)
    return vs_fail(err, VS_USAGE, "goal difference %d: 0 (never ends the match) or more", def->goal_difference_stop);
  if (!(def->still_s > 0)) return vs_fail(err, VS_USAGE, "a still ball for %g s: more than 0", def->still_s);
  if (!(def->still_distance_m > 0))
    return vs_fail(err, VS_USAGE, "a still ball within %g m: more than 0", def->still_distance_m);
  if (!(def->extra_half_s >= 0 && def->extra_half_s <= 7200))
    return vs_fail(err, VS_USAGE, "a half of extra time of %g s: 0 (none) to 7200 s", def->extra_half_s);
  if (!(def->kick_s > 0 && def->kick_s <= 600))
    return vs_fail(err, VS_USAGE, "a shoot-out's kick of %g s: more than 0, at most 600 s", def->kick_s);
  if (def->halves != 1 && def->halves != 2) return vs_fail(err, VS_USAGE, "%d halves: 1 or 2", def->halves);
  return VS_OK;
}

static void forget(vs_referee *r) {
  r->still_s = 0;
  r->play_area = -1;
  r->defence_s = r->attack_s = 0;
  r->defence_seen_s = r->attack_seen_s = -1;
  r->push_s[VS_BLUE] = r->push_s[VS_YELLOW] = 0;
}

vs_status vs_referee_init(vs_referee *referee, const vs_referee_def *def, vs_error *err) {
  vs_status status = check_def(def, err);
  if (status != VS_OK) return status;
  memset(referee, 0, sizeof *referee);
  referee->def = *def;
  referee->kick_off = def->kick_off;
  referee->game.duration_s = def->duration_s;
  referee->game.last_event = (vs_event){.kind = VS_EVENT_KICK_OFF, .team = def->kick_off};
  forget(referee);
  return VS_OK;
}

static bool is_team(vs_team team) { return (int)team == VS_BLUE || (int)team == VS_YELLOW; }

static bool game_ok(const vs_game *g) {
  const vs_event *e = &g->last_event;
  bool ok = vs_all_finite(&g->time_s, 1) && vs_all_finite(&g->duration_s, 1) && vs_all_finite(&e->time_s, 1);
  for (int t = 0; t < VS_TEAMS; t++) ok = ok && g->score[t] >= 0 && g->score[t] < 1000000;
  return ok && (int)e->kind >= 0 && (int)e->kind < VS_EVENT_KINDS && is_team(e->team) && e->quadrant >= 0 &&
         e->quadrant <= 4;
}

static bool idle_ok(const vs_idle *idle) {
  bool ok = true;
  for (int i = 0; i < VS_TEAMS * VS_TEAM_MOST; i++) {
    int t = i / VS_TEAM_MOST, k = i % VS_TEAM_MOST;
    ok = ok && vs_all_finite(&idle->robot[t][k].x_m, 3) && vs_are_bools(&idle->robot[t][k].warned, 2);
  }
  for (int t = 0; t < VS_TEAMS; t++) ok = ok && idle->warnings[t] >= 0 && idle->sent_off[t] >= 0;
  return ok;
}

static bool kicks_ok(const vs_referee *r) {
  bool ok = vs_all_finite(&r->kick_s, 1) && r->lot >= 0 && r->lot <= VS_TEAMS;
  for (int t = 0; t < VS_TEAMS; t++)
    ok = ok && r->kicks_scored[t] >= 0 && r->kicks_scored[t] <= r->kicks[t] && r->kicks[t] <= VS_SHOOT_OUT_MOST;
  return ok;
}

bool vs_referee_ok(const vs_referee *r, const vs_referee_def *def) {
  const vs_referee_def *d = &r->def;
  bool same = d->rules == def->rules && d->placement == def->placement && d->duration_s == def->duration_s &&
              d->goal_difference_stop == def->goal_difference_stop && vs_are_bools(&d->end_at_first_goal, 1) &&
              d->end_at_first_goal == def->end_at_first_goal && d->halves == def->halves && is_team(d->kick_off) &&
              vs_are_bools(&d->knockout, 1) && d->knockout == def->knockout && d->extra_half_s == def->extra_half_s &&
              d->kick_s == def->kick_s && vs_all_finite(&d->still_s, 1) && d->still_s > 0; // an episode draws these two
  return same && game_ok(&r->game) && vs_are_bools(&r->over, 1) && is_team(r->kick_off) && r->half >= 0 &&
         r->half <= VS_HALF_SHOOT_OUT && vs_all_finite(&r->still_x_m, 3) && r->play_area >= -1 &&
         r->play_area < VS_TEAMS && vs_all_finite(&r->defence_s, 4) && r->free_balls >= 0 &&
         vs_all_finite(r->push_s, VS_TEAMS) && idle_ok(&r->idle) && kicks_ok(r);
}

void vs_referee_restarted(vs_referee *referee, const vs_world *world) {
  forget(referee);
  referee->still_x_m = world->ball.x_m;
  referee->still_y_m = world->ball.y_m;
}

static int count_in_area(const vs_world *world, int team, int side) {
  const vs_pitch *field = vs_pitch_of(world->division);
  int n = 0;
  for (int i = 0; i < field->team_size; i++) {
    const vs_pose *p = &world->robot[team][i].pose;
    n += vs_in_area(field, side, p->x_m, p->y_m) ? 1 : 0;
  }
  return n;
}

static bool near_ball(const vs_world *world, int team) {
  for (int i = 0, n = vs_team_size(world); i < n; i++) {
    const vs_pose *p = &world->robot[team][i].pose;
    if (vs_distance_m(p->x_m, p->y_m, world->ball.x_m, world->ball.y_m) <= VS_LEAGUE_NEAR_BALL_M) return true;
  }
  return false;
}

static void facts_of(const vs_world *world, double dt_s, vs_facts *f) {
  const vs_ball *ball = &world->ball;
  const vs_pitch *field = vs_pitch_of(world->division);
  const double line_m = field->half_length_m + VS_BALL_RADIUS_M;
  bool over_line = fabs(ball->x_m) > line_m, in_mouth = fabs(ball->y_m) < field->goal_half_width_m;
  *f = (vs_facts){.dt_s = dt_s, .scorer = -1, .area = -1, .ended_play = -1, .pusher = -1, .holder = -1};
  if (over_line && in_mouth) f->scorer = ball->x_m > 0 ? VS_BLUE : VS_YELLOW;
  f->ball_out = (over_line && !in_mouth) || fabs(ball->y_m) > field->half_width_m + VS_BALL_RADIUS_M;
  f->quadrant = ball->x_m >= 0 ? (ball->y_m >= 0 ? 1 : 4) : (ball->y_m >= 0 ? 2 : 3);
  f->ball_mps = sqrt(ball->vx_mps * ball->vx_mps + ball->vy_mps * ball->vy_mps);
  for (int t = 0; t < VS_TEAMS; t++) {
    int side = t == VS_BLUE ? -1 : 1;
    f->near_ball[t] = near_ball(world, t);
    if (f->scorer >= 0 || !vs_in_area(field, side, ball->x_m, ball->y_m)) continue;
    f->area = t;
    f->defenders = count_in_area(world, t, side);
    f->attackers = count_in_area(world, vs_other_team(t), side);
  }
}

bool vs_rule_ball_out(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  if (!f->ball_out) return false;
  event->kind = VS_EVENT_FREE_BALL;
  event->quadrant = f->quadrant;
  return true;
}

static void announce(vs_referee *r, const vs_event *event, double dt_s) {
  r->game.last_event = *event;
  r->free_balls = event->kind == VS_EVENT_FREE_BALL ? r->free_balls + 1 : 0;
  if (event->kind == VS_EVENT_GOAL) {
    r->game.score[event->team]++;
    r->kick_off = vs_other_team(event->team);
    r->over = vs_ended_by_goal(r, dt_s);
  } else if (event->kind == VS_EVENT_HALF_TIME) {
    r->half++;
    r->kick_off = event->team;
  } else if (event->kind == VS_EVENT_END) {
    r->over = true;
  } else {
    vs_extend(r, event);
  }
  forget(r);
}

// The idle rule stops no play.
static void send_off(vs_referee *r, const vs_world *world, vs_event *event, double dt_s) {
  int before[VS_TEAMS] = {r->idle.sent_off[VS_BLUE], r->idle.sent_off[VS_YELLOW]};
  vs_idle_step(&r->idle, world, event, dt_s);
  for (int t = 0; t < VS_TEAMS; t++) {
    if (event->kind != VS_EVENT_NONE || r->idle.sent_off[t] == before[t]) continue;
    event->kind = VS_EVENT_SENT_OFF;
    event->team = (vs_team)t;
    r->game.last_event = *event;
  }
}

static bool has_left(const vs_world *placed, const vs_world *now, int team) {
  for (int i = 0, n = vs_team_size(now); i < n; i++) {
    const vs_pose *a = &placed->robot[team][i].pose, *b = &now->robot[team][i].pose;
    if (vs_distance_m(a->x_m, a->y_m, b->x_m, b->y_m) > VS_FALSE_START_M) return true;
  }
  return false;
}

vs_start vs_referee_start(vs_referee *r, const vs_world *placed, const vs_world *now, vs_event *event) {
  bool judged = r->def.rules == VS_RULES_SERIE_A_2023 || r->def.rules == VS_RULES_LARC_2026;
  bool left[VS_TEAMS] = {has_left(placed, now, VS_BLUE), has_left(placed, now, VS_YELLOW)};
  *event = (vs_event){.kind = VS_EVENT_NONE, .time_s = r->game.time_s};
  if (!judged || !(left[VS_BLUE] || left[VS_YELLOW])) return VS_START_PLAY;
  if (left[VS_BLUE] == left[VS_YELLOW] || r->half == VS_HALF_SHOOT_OUT) return VS_START_PUT_BACK;
  event->kind = VS_EVENT_FREE_KICK;
  event->team = left[VS_BLUE] ? VS_YELLOW : VS_BLUE;
  announce(r, event, 0);
  return VS_START_FOUL;
}

bool vs_referee_off(const vs_referee *r, vs_team team, int robot) { return r->idle.robot[team][robot].off; }

void vs_referee_hold_off(const vs_referee *r, vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST]) {
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_MOST; i++)
      if (vs_referee_off(r, (vs_team)t, i)) wheels[t][i] = (vs_wheels){0, 0};
}

vs_event vs_referee_step(vs_referee *referee, const vs_world *world, double dt_s) {
  vs_event event = {.kind = VS_EVENT_NONE};
  if (referee->over) return event;
  referee->game.time_s += dt_s;
  event.time_s = referee->game.time_s;

  vs_facts facts;
  facts_of(world, dt_s, &facts);
  if (referee->half == VS_HALF_SHOOT_OUT) {
    vs_shoot_out_step(referee, world, &facts, &event);
    return event;
  }
  static const vs_rule *const tables[] = {vs_paper_rules, vs_league_rules, vs_serie_a_2023_rules, vs_larc_2026_rules};
  switch (referee->def.rules) {
  case VS_RULES_PAPER: vs_paper_clocks(referee, world, &facts); break;
  case VS_RULES_LEAGUE: vs_league_clocks(referee, &facts); break;
  default: vs_serie_a_clocks(referee, world, &facts);
  }
  for (const vs_rule *rule = tables[referee->def.rules]; rule->name; rule++) {
    if (!rule->applies(referee, &facts, &event)) continue;
    announce(referee, &event, dt_s);
    break;
  }
  if (referee->def.rules == VS_RULES_LARC_2026 && !referee->over) send_off(referee, world, &event, dt_s);
  return event;
}

vs_status vs_rules_parse(const char *name, vs_rules *out, vs_error *err) {
  static const char *const names[] = {"paper", "league", "serie-a-2023", "larc-2026", NULL};
  int rules;
  vs_status s = vs_word_parse("rules", name, names, &rules, err);
  if (s == VS_OK) *out = (vs_rules)rules;
  return s;
}

vs_status vs_placement_parse(const char *name, vs_placement_mode *out, vs_error *err) {
  static const char *const names[] = {"paper", "random", "mixed", NULL};
  int mode;
  vs_status s = vs_word_parse("placement", name, names, &mode, err);
  if (s == VS_OK) *out = (vs_placement_mode)mode;
  return s;
}
