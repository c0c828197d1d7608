// Tests src/control/go_to.c in the simulator: from random starts all robots stand at the places of a restart within 8 s and
// touch nobody on the way, past opponents that stand and past opponents that drive to their own places, also with the delay
// and the noise of a camera. STARTS=40 in the environment runs as many starts of each restart as deploy/docs tells of.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "planar_model.h"
#include "vsss/control.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/go_to.h"
#include "vsss/referee.h"
#include "vsss/sim.h"

#define LIMIT_S 8.0
#define HELD    15 // frames that it must stand there
#define DELAY   2  // frames, and
#define NOISE_M 0.002

static const vs_event restarts[] = {
    {.kind = VS_EVENT_KICK_OFF, .team = VS_BLUE},
    {.kind = VS_EVENT_KICK_OFF, .team = VS_YELLOW},
    {.kind = VS_EVENT_PENALTY, .team = VS_BLUE},
    {.kind = VS_EVENT_PENALTY, .team = VS_YELLOW},
    {.kind = VS_EVENT_FREE_BALL, .quadrant = 1},
    {.kind = VS_EVENT_FREE_BALL, .quadrant = 2},
    {.kind = VS_EVENT_FREE_BALL, .quadrant = 3},
    {.kind = VS_EVENT_FREE_BALL, .quadrant = 4},
    {.kind = VS_EVENT_GOAL_KICK, .team = VS_BLUE, .quadrant = 2},
    {.kind = VS_EVENT_GOAL_KICK, .team = VS_YELLOW, .quadrant = 4},
};
enum { RESTARTS = sizeof restarts / sizeof *restarts };

// By how much two squares overlap along each of the four directions of their sides, at least; negative: a gap.
static double overlap(const vs_pose *a, const vs_pose *b) {
  double least = 1;
  for (int k = 0; k < 4; k++) {
    double axis = (k < 2 ? a : b)->theta_rad + (k % 2) * VS_PI / 2, reach = 0;
    for (int r = 0; r < 2; r++) {
      double turn = (r ? b : a)->theta_rad - axis;
      reach += VS_ROBOT_SIZE_M / 2 * (fabs(cos(turn)) + fabs(sin(turn)));
    }
    least = fmin(least, reach - fabs((b->x_m - a->x_m) * cos(axis) + (b->y_m - a->y_m) * sin(axis)));
  }
  return least;
}

static bool touches(const vs_world *w, vs_team team) {
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int t = 0; t < VS_TEAMS; t++)
      for (int k = 0; k < VS_TEAM_SIZE; k++)
        if (!((vs_team)t == team && k >= i) && overlap(&w->robot[team][i].pose, &w->robot[t][k].pose) > -0.0005)
          return true;
  return false;
}

typedef struct figures {
  int runs, late, touched, ball;
  double sum_s, longest_s;
} figures;

typedef struct scene {
  const char *name;
  bool both;   // the opponents drive to their places as well, by the same planner
  bool camera; // its delay and noise
} scene;

// What a team sees in this frame.
static void look(const scene *c, const vs_world history[DELAY + 1], vs_rng *rng, vs_world *seen) {
  *seen = history[c->camera ? DELAY : 0];
  for (int t = 0; t < VS_TEAMS && c->camera; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      vs_robot *r = &seen->robot[t][i];
      r->pose.x_m += NOISE_M * vs_rng_normal(rng);
      r->pose.y_m += NOISE_M * vs_rng_normal(rng);
      r->pose.theta_rad = vs_wrap_rad(r->pose.theta_rad + 0.02 * vs_rng_normal(rng));
    }
}

static void targets(const vs_event *restart, const vs_world *start, vs_pose target[VS_TEAMS][VS_TEAM_SIZE]) {
  vs_world placed;
  vs_rng unused = vs_rng_make(0, 0);
  vs_place(VS_PLACEMENT_PAPER, restart, start, &unused, &placed);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) target[t][i] = placed.robot[t][i].pose;
}

static void tell(const scene *c, const vs_event *restart, const vs_world *start, const vs_world *end,
                 const char *what) {
  vs_pose target[VS_TEAMS][VS_TEAM_SIZE];
  targets(restart, start, target);
  print_message("%s, %s for %s: %s\n", c->name, vs_event_name(restart->kind), vs_team_name(restart->team), what);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_pose *a = &start->robot[t][i].pose, *b = &end->robot[t][i].pose, *to = &target[t][i];
      print_message("   %s %d: %.3f %.3f %.2f -> %.3f %.3f %.2f, wanted %.3f %.3f %.2f\n", vs_team_name((vs_team)t), i,
                    a->x_m, a->y_m, a->theta_rad, b->x_m, b->y_m, b->theta_rad, to->x_m, to->y_m, to->theta_rad);
    }
}

static void drive(vs_sim *sim, const scene *c, const vs_event *restart, const vs_world *start, vs_rng *rng,
                  figures *f) {
  vs_world w, seen, history[DELAY + 1];
  vs_go_to go[VS_TEAMS] = {0};
  vs_pose target[VS_TEAMS][VS_TEAM_SIZE];
  targets(restart, start, target);
  for (int t = 0; t < VS_TEAMS; t++) go[t].delay_s = c->camera ? DELAY / 30.0 : 0;
  vs_sim_place(sim, start);
  vs_sim_world(sim, &w);
  for (int k = 0; k <= DELAY; k++) history[k] = w;
  bool touched = false;
  int frames = 0, held = 0;
  for (; frames < 30 * LIMIT_S + HELD && held < HELD; frames++) {
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST] = {0};
    memmove(history + 1, history, DELAY * sizeof *history);
    history[0] = w;
    look(c, history, rng, &seen);
    for (int t = 0; t <= c->both; t++) vs_go_to_step(&go[t], &seen, (vs_team)t, target[t], wheels[t]);
    assert_ok(vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])wheels, err));
    vs_sim_world(sim, &w);
    touched = touched || touches(&w, VS_BLUE);
    bool there = vs_go_to_arrived(&w, VS_BLUE, target[VS_BLUE]) &&
                 (!c->both || vs_go_to_arrived(&w, VS_YELLOW, target[VS_YELLOW]));
    held = there ? held + 1 : 0;
  }
  double s = (frames - held) / 30.0;
  f->runs++;
  f->late += held < HELD;
  f->touched += touched;
  f->ball += vs_distance_m(w.ball.x_m, w.ball.y_m, start->ball.x_m, start->ball.y_m) > 0.01;
  f->sum_s += s;
  f->longest_s = fmax(f->longest_s, s);
  if (held < HELD) tell(c, restart, start, &w, "late");
  if (touched) tell(c, restart, start, &w, "touched");
}

// An opponent that will not go stands where one of ours shall.
static bool occupied(const vs_event *restart, const vs_world *start) {
  vs_pose target[VS_TEAMS][VS_TEAM_SIZE];
  targets(restart, start, target);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_TEAM_SIZE; k++) {
      const vs_pose *a = &target[VS_BLUE][i], *b = &start->robot[VS_YELLOW][k].pose;
      if (vs_distance_m(a->x_m, a->y_m, b->x_m, b->y_m) < 0.13) return true;
    }
  return false;
}

// A start for this restart: robots as in open play, the ball where the referee has put it, clear of all.
static void draw(const scene *c, const vs_event *restart, const vs_world *before, vs_rng *rng, vs_world *start) {
  bool clear;
  do {
    vs_world placed;
    vs_place_open_play(before, rng, start);
    vs_place(VS_PLACEMENT_PAPER, restart, start, rng, &placed);
    start->ball = placed.ball;
    clear = c->both || !occupied(restart, start);
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++) {
        const vs_pose *p = &start->robot[t][i].pose;
        clear = clear && vs_distance_m(start->ball.x_m, start->ball.y_m, p->x_m, p->y_m) > 0.085;
      }
  } while (!clear);
}

static void arrive(const scene *c, uint64_t seed) {
  const char *more = getenv("STARTS");
  int starts = more ? atoi(more) : 6;
  figures f = {0};
  vs_sim *sim;
  vs_rng rng = vs_rng_make(seed, 0);
  assert_ok(vs_sim_new(model, &sim, err));
  for (int r = 0; r < RESTARTS; r++)
    for (int k = 0; k < starts; k++) {
      vs_world before, start;
      vs_sim_reset(sim, NULL);
      vs_sim_world(sim, &before);
      draw(c, &restarts[r], &before, &rng, &start);
      drive(sim, c, &restarts[r], &start, &rng, &f);
    }
  vs_sim_free(sim);
  print_message("%s: %d runs, mean %.2f s, longest %.2f s; late %d, touched %d, ball moved in %d\n", c->name, f.runs,
                f.sum_s / f.runs, f.longest_s, f.late, f.touched, f.ball);
  assert_int_equal(f.late, 0);
  assert_int_equal(f.touched, 0);
}

static void robots_arrive_past_opponents_that_stand(void **state) {
  (void)state;
  arrive(&(scene){.name = "opponents stand"}, 1);
}

static void robots_arrive_while_opponents_go_to_their_places(void **state) {
  (void)state;
  arrive(&(scene){.name = "both teams drive", .both = true}, 2);
}

static void robots_arrive_seen_late_and_with_noise(void **state) {
  (void)state;
  arrive(&(scene){.name = "both teams drive, as a camera sees them", .both = true, .camera = true}, 3);
}

// Play ended in a scrum: ours is wedged between two, one a hair from its front and one from its side.
static void a_robot_in_a_scrum_leaves_it_without_pushing(void **state) {
  (void)state;
  const vs_event kick_off = {.kind = VS_EVENT_KICK_OFF, .team = VS_YELLOW};
  vs_pose target[VS_TEAMS][VS_TEAM_SIZE];
  vs_sim *sim;
  vs_world w, start;
  vs_go_to go = {0};
  assert_ok(vs_sim_new(model, &sim, err));
  vs_sim_reset(sim, NULL);
  vs_sim_world(sim, &start);
  start.robot[VS_BLUE][1].pose = (vs_pose){0.3, 0.3, 0};
  start.robot[VS_YELLOW][1].pose = (vs_pose){0.3 + VS_ROBOT_SIZE_M + 0.001, 0.3, VS_PI};
  start.robot[VS_YELLOW][2].pose = (vs_pose){0.3, 0.3 + VS_ROBOT_SIZE_M + 0.001, VS_PI / 2};
  targets(&kick_off, &start, target);
  vs_sim_place(sim, &start);
  int frames = 0;
  for (vs_sim_world(sim, &w); frames < 30 * LIMIT_S && !vs_go_to_arrived(&w, VS_BLUE, target[VS_BLUE]); frames++) {
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST] = {0};
    vs_go_to_step(&go, &w, VS_BLUE, target[VS_BLUE], wheels[VS_BLUE]);
    assert_ok(vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])wheels, err));
    vs_sim_world(sim, &w);
  }
  assert_true(frames < 30 * LIMIT_S);
  for (int i = 1; i < VS_TEAM_SIZE; i++) {
    assert_near(w.robot[VS_YELLOW][i].pose.x_m, start.robot[VS_YELLOW][i].pose.x_m, 0.003);
    assert_near(w.robot[VS_YELLOW][i].pose.y_m, start.robot[VS_YELLOW][i].pose.y_m, 0.003);
  }
  vs_sim_free(sim);
}

static void a_robot_that_is_not_seen_stands(void **state) {
  (void)state;
  const vs_pose target[VS_TEAM_SIZE] = {{-0.5, 0, 0}, {-0.5, 0.3, 0}, {-0.5, -0.3, 0}};
  vs_world w = {0};
  vs_go_to go = {0};
  vs_wheels out[VS_TEAM_SIZE];
  w.robot[VS_BLUE][1] = (vs_robot){.pose = {0, 0.3, VS_PI}, .valid = true};
  vs_go_to_step(&go, &w, VS_BLUE, target, out);
  assert_near(out[0].left_radps, 0, 0);
  assert_near(out[2].right_radps, 0, 0);
  assert_true(out[1].left_radps > 1 && out[1].right_radps > 1); // straight ahead
  assert_false(vs_go_to_arrived(&w, VS_BLUE, target));
  w.robot[VS_BLUE][1].pose = (vs_pose){-0.5, 0.3, 0.1};
  assert_true(vs_go_to_arrived(&w, VS_BLUE, target));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(robots_arrive_past_opponents_that_stand),
      cmocka_unit_test(robots_arrive_while_opponents_go_to_their_places),
      cmocka_unit_test(robots_arrive_seen_late_and_with_noise),
      cmocka_unit_test(a_robot_in_a_scrum_leaves_it_without_pushing),
      cmocka_unit_test(a_robot_that_is_not_seen_stands),
  };
  return cmocka_run_group_tests(tests, load_model, free_model);
}
