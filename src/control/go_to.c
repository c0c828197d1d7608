#include "vsss/go_to.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

// Two robots of any headings do not touch at this distance: twice half a diagonal (0.113 m) and a little.
#define CLEAR_M  0.118
#define LATE_MPS 0.15  // more of it by the delay
#define BALL_M   0.088 // the ball's radius, half a diagonal and a centimetre
#define WIDE_M   0.06  // nearer than that much more a way costs more
#define WALL_M   0.065
#define TURNS_M  0.0567 // half a diagonal

#define SPEED_MPS  0.6
#define BRAKE_MPS2 0.8
#define TURN_RADPS 6.0
#define AHEAD_S    0.35 // looked ahead, in steps
#define STEPS      5
#define NEAR_M     0.008                     // arrives; leaves at VS_GO_TO_M
#define LOOK_M     0.25                      // of the way, as far as it is straight and clear
#define OTHERS     (VS_TEAMS * VS_TEAM_SIZE) // with the ball

// --- the way ----------------------------------------------------------------------------------------------------------

#define CELL_M 0.03
enum { COLUMNS = 50, ROWS = 44, CELLS = COLUMNS * ROWS };

// What is gone round: the others, and last the ball.
typedef struct disc {
  double x_m, y_m, vx_mps, vy_mps, clear_m;
} disc;

typedef struct grid {
  float cost[CELLS], left[CELLS]; // of a metre in this cell; from here to the goal
  short heap[8 * CELLS];
  float key[8 * CELLS];
  int n;
} grid;

static double cell_x(int c) { return (c % COLUMNS - 0.5 * (COLUMNS - 1)) * CELL_M; }
static double cell_y(int c) { return ((double)(c / COLUMNS) - 0.5 * (ROWS - 1)) * CELL_M; }
static int cell_at(double x_m, double y_m) {
  int column = (int)lround(x_m / CELL_M + 0.5 * (COLUMNS - 1)), row = (int)lround(y_m / CELL_M + 0.5 * (ROWS - 1));
  column = column < 0 ? 0 : column >= COLUMNS ? COLUMNS - 1 : column;
  row = row < 0 ? 0 : row >= ROWS ? ROWS - 1 : row;
  return row * COLUMNS + column;
}

// The end wall has a gap: the goal's mouth.
static double wall_distance(double x_m, double y_m) {
  double corner = (VS_FIELD_HALF_LENGTH_M + VS_FIELD_HALF_WIDTH_M - VS_CORNER_M - fabs(x_m) - fabs(y_m)) * 0.70710678;
  double end = fabs(y_m) < VS_GOAL_HALF_WIDTH_M - WALL_M ? 1 : VS_FIELD_HALF_LENGTH_M - fabs(x_m);
  return fmin(corner, fmin(end, VS_FIELD_HALF_WIDTH_M - fabs(y_m)));
}

static void weigh(grid *g, const disc *other, int n) {
  for (int c = 0; c < CELLS; c++) {
    double x = cell_x(c), y = cell_y(c), cost = 1;
    for (int k = 0; k < n; k++) {
      double d = vs_distance_m(x, y, other[k].x_m, other[k].y_m);
      double wide_m = other[k].clear_m + WIDE_M;
      if (d < other[k].clear_m)
        cost += 40;
      else if (d < wide_m)
        cost += 4 * (wide_m - d) / WIDE_M;
    }
    if (wall_distance(x, y) < WALL_M) cost += 8;
    g->cost[c] = (float)cost;
  }
}

static void push(grid *g, int c, float key) {
  if (g->n >= 8 * CELLS) return;
  int i = g->n++;
  for (; i > 0 && g->key[(i - 1) / 2] > key; i = (i - 1) / 2) {
    g->heap[i] = g->heap[(i - 1) / 2];
    g->key[i] = g->key[(i - 1) / 2];
  }
  g->heap[i] = (short)c;
  g->key[i] = key;
}

static int pop(grid *g, float *key) {
  int top = g->heap[0], i = 0;
  *key = g->key[0];
  int c = g->heap[--g->n];
  float last = g->key[g->n];
  for (int k; (k = 2 * i + 1) < g->n; i = k) {
    if (k + 1 < g->n && g->key[k + 1] < g->key[k]) k++;
    if (g->key[k] >= last) break;
    g->heap[i] = g->heap[k];
    g->key[i] = g->key[k];
  }
  g->heap[i] = (short)c;
  g->key[i] = last;
  return top;
}

static int neighbours(int c, int out[8], float distance[8]) {
  int column = c % COLUMNS, row = c / COLUMNS, n = 0;
  for (int dr = -1; dr <= 1; dr++)
    for (int dc = -1; dc <= 1; dc++) {
      if ((!dr && !dc) || row + dr < 0 || row + dr >= ROWS || column + dc < 0 || column + dc >= COLUMNS) continue;
      out[n] = (row + dr) * COLUMNS + column + dc;
      distance[n++] = (float)(CELL_M * (dr && dc ? 1.41421356 : 1));
    }
  return n;
}

// Dijkstra from the goal.
static void measure(grid *g, int goal) {
  for (int c = 0; c < CELLS; c++) g->left[c] = FLT_MAX;
  g->n = 0;
  g->left[goal] = 0;
  push(g, goal, 0);
  while (g->n > 0) {
    float key, distance[8];
    int to[8], c = pop(g, &key);
    if (key > g->left[c]) continue;
    int n = neighbours(c, to, distance);
    for (int k = 0; k < n; k++) {
      float through = key + distance[k] * 0.5F * (g->cost[c] + g->cost[to[k]]);
      if (through >= g->left[to[k]]) continue;
      g->left[to[k]] = through;
      push(g, to[k], through);
    }
  }
}

static double segment_distance(double ax, double ay, double bx, double by, double x, double y) {
  double dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
  double t = length2 > 0 ? vs_clamp(((x - ax) * dx + (y - ay) * dy) / length2, 0, 1) : 0;
  return vs_distance_m(x, y, ax + t * dx, ay + t * dy);
}

static bool is_straight(const vs_pose *from, double x_m, double y_m, const disc *other, int n) {
  double wall_m = fmin(WALL_M, fmin(wall_distance(from->x_m, from->y_m), wall_distance(x_m, y_m))) - 0.001;
  double way_m = vs_distance_m(from->x_m, from->y_m, x_m, y_m);
  for (double s = 0; s < way_m; s += CELL_M) {
    double share = s / way_m;
    if (wall_distance(from->x_m + share * (x_m - from->x_m), from->y_m + share * (y_m - from->y_m)) < wall_m)
      return false;
  }
  for (int k = 0; k < n; k++) {
    const disc *o = &other[k];
    double at_m = vs_distance_m(from->x_m, from->y_m, o->x_m, o->y_m);
    double past_m = segment_distance(from->x_m, from->y_m, x_m, y_m, o->x_m, o->y_m);
    if (past_m < fmin(at_m - 0.001, o->clear_m + 0.01)) return false;
  }
  return true;
}

// The point to drive at now: the farthest of the way's next LOOK_M that is reached straight.
static void next_point(grid *g, const vs_pose *from, const vs_pose *target, const disc *other, int n, double *x_m,
                       double *y_m) {
  int c = cell_at(from->x_m, from->y_m), goal = cell_at(target->x_m, target->y_m);
  *x_m = target->x_m;
  *y_m = target->y_m;
  if (c == goal || is_straight(from, target->x_m, target->y_m, other, n)) return;
  weigh(g, other, n);
  measure(g, goal);
  bool any = false;
  for (double way_m = 0; way_m < LOOK_M && c != goal;) {
    int to[8], best = -1, k = neighbours(c, to, (float[8]){0});
    for (int i = 0; i < k; i++)
      if (best < 0 || g->left[to[i]] < g->left[best]) best = to[i];
    way_m += CELL_M;
    double x = best == goal ? target->x_m : cell_x(best), y = best == goal ? target->y_m : cell_y(best);
    if (any && !is_straight(from, x, y, other, n)) return;
    *x_m = x;
    *y_m = y;
    any = true;
    c = best;
  }
}

// --- the motion -------------------------------------------------------------------------------------------------------

// Towards a point, forwards or backwards, whichever is less of a turn.
static void drive_at(const vs_pose *p, double x_m, double y_m, double left_m, double *v_mps, double *w_radps) {
  double error = vs_wrap_rad(atan2(y_m - p->y_m, x_m - p->x_m) - p->theta_rad), sign = 1;
  if (fabs(error) > VS_PI / 2) {
    error = vs_wrap_rad(error + VS_PI);
    sign = -1;
  }
  double along = fmax(0, cos(error));
  *v_mps = sign * fmin(SPEED_MPS, sqrt(2 * BRAKE_MPS2 * left_m)) * along * along * along;
  *w_radps = vs_clamp(8 * error, -TURN_RADPS, TURN_RADPS);
}

// Whether it comes too near to another within the time looked ahead; those that it leaves do not count.
static bool is_safe(const vs_pose *p, double v_mps, double w_radps, const disc *other, int n) {
  double x = p->x_m, y = p->y_m, theta = p->theta_rad;
  for (int s = 1; s <= STEPS; s++) {
    double dt = AHEAD_S / STEPS, t = dt * s;
    theta += 0.5 * w_radps * dt;
    x += v_mps * cos(theta) * dt;
    y += v_mps * sin(theta) * dt;
    theta += 0.5 * w_radps * dt;
    for (int k = 0; k < n; k++) {
      double now_m = vs_distance_m(p->x_m, p->y_m, other[k].x_m, other[k].y_m);
      double d = vs_distance_m(x, y, other[k].x_m + other[k].vx_mps * t, other[k].y_m + other[k].vy_mps * t);
      double still_m =
          vs_distance_m(p->x_m, p->y_m, other[k].x_m + other[k].vx_mps * t, other[k].y_m + other[k].vy_mps * t);
      if (d < other[k].clear_m && d < now_m - 0.0005 && d < still_m + 0.0005 && v_mps != 0) return false;
    }
  }
  return true;
}

static void make_safe(const vs_pose *p, double *v_mps, double *w_radps, const disc *other, int n) {
  static const double share[] = {1, 0.5, 0.25};
  for (size_t k = 0; k < sizeof share / sizeof *share; k++) {
    if (!is_safe(p, share[k] * *v_mps, *w_radps, other, n)) continue;
    *v_mps *= share[k];
    return;
  }
  *v_mps = 0;
}

// What is left of the room that a turn takes, to robots and walls.
static double room(double x_m, double y_m, const disc *other, int n) {
  double left_m = wall_distance(x_m, y_m) - TURNS_M;
  for (int k = 0; k < n; k++) left_m = fmin(left_m, vs_distance_m(x_m, y_m, other[k].x_m, other[k].y_m) - 2 * TURNS_M);
  return left_m;
}

// So near to another or to a wall that a turn would touch it: straight ahead or back, where that leads away from all.
static bool back_off(const vs_pose *p, const disc *other, int n, double *v_mps, double *w_radps) {
  double most_m = room(p->x_m, p->y_m, other, n);
  *v_mps = *w_radps = 0;
  if (most_m >= 0) return false;
  most_m += 0.008; // along a wall is not away from it
  for (int sign = -1; sign <= 1; sign += 2) {
    double x = p->x_m + sign * 0.03 * cos(p->theta_rad), y = p->y_m + sign * 0.03 * sin(p->theta_rad);
    double left_m = room(x, y, other, n);
    if (left_m <= most_m) continue;
    most_m = left_m;
    *v_mps = sign * 0.25;
  }
  return *v_mps != 0;
}

static vs_wheels wheels_of(double v_mps, double w_radps) {
  return (vs_wheels){(v_mps - w_radps * VS_HALF_TRACK_M) / VS_WHEEL_RADIUS_M,
                     (v_mps + w_radps * VS_HALF_TRACK_M) / VS_WHEEL_RADIUS_M};
}

// All other robots that robot i of a team sees, farther off the later it sees them, and behind them the ball. Own ones of a higher number are taken to stand: they give way.
static int others_of(const vs_world *w, vs_team team, int i, double clear_m, disc out[OTHERS]) {
  int n = 0;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int k = 0; k < VS_TEAM_SIZE; k++) {
      const vs_robot *r = &w->robot[t][k];
      if (!r->valid || ((vs_team)t == team && k == i)) continue;
      bool gives_way = (vs_team)t == team && k > i;
      out[n++] = (disc){r->pose.x_m, r->pose.y_m, gives_way ? 0 : r->vx_mps, gives_way ? 0 : r->vy_mps, clear_m};
    }
  out[n] = (disc){w->ball.x_m, w->ball.y_m, 0, 0, BALL_M};
  return n;
}

// A place so near to the ball that a turn there would touch it is entered straight: from a step farther away.
static vs_pose place_now(vs_go_to *go, int i, const vs_pose *p, const vs_pose *target, const vs_ball *ball) {
  double d = vs_distance_m(target->x_m, target->y_m, ball->x_m, ball->y_m);
  if (!ball->valid || d >= BALL_M || d < VS_BALL_RADIUS_M) return *target;
  double step_m = BALL_M + 0.01 - d;
  vs_pose before = *target;
  before.x_m += step_m * (target->x_m - ball->x_m) / d;
  before.y_m += step_m * (target->y_m - ball->y_m) / d;
  double from_m = vs_distance_m(p->x_m, p->y_m, before.x_m, before.y_m);
  bool turned = fabs(vs_wrap_rad(target->theta_rad - p->theta_rad)) < 0.05;
  if (go->near[i] && from_m < VS_GO_TO_M && turned) go->enters[i] = true;
  if (vs_distance_m(p->x_m, p->y_m, target->x_m, target->y_m) > step_m + 2 * VS_GO_TO_M) go->enters[i] = false;
  return go->enters[i] ? *target : before;
}

static vs_wheels step_robot(vs_go_to *go, const vs_world *w, vs_team team, int i, const vs_pose *wanted) {
  const vs_pose *p = &w->robot[team][i].pose, place = place_now(go, i, p, wanted, &w->ball), *target = &place;
  disc other[OTHERS];
  grid g;
  int n = others_of(w, team, i, CLEAR_M + LATE_MPS * go->delay_s, other);
  double left_m = vs_distance_m(p->x_m, p->y_m, target->x_m, target->y_m), v_mps, w_radps, x_m, y_m;
  go->near[i] = left_m < (go->near[i] ? VS_GO_TO_M : NEAR_M);
  if (back_off(p, other, n, &v_mps, &w_radps)) return wheels_of(v_mps, w_radps);
  if (go->near[i]) {
    double turn = vs_wrap_rad(target->theta_rad - p->theta_rad);
    return wheels_of(0, fabs(turn) < 0.03 ? 0 : vs_clamp(6 * turn, -TURN_RADPS, TURN_RADPS));
  }
  next_point(&g, p, target, other, n + w->ball.valid, &x_m, &y_m);
  drive_at(p, x_m, y_m, left_m, &v_mps, &w_radps);
  make_safe(p, &v_mps, &w_radps, other, n);
  return wheels_of(v_mps, w_radps);
}

// Everybody where they will be when the wheels act.
static void move_on(vs_world *w, double by_s) {
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      vs_robot *r = &w->robot[t][i];
      double middle_rad = r->pose.theta_rad + 0.5 * by_s * r->omega_radps, ahead = cos(middle_rad),
             side = sin(middle_rad);
      double v_mps = r->vx_mps * cos(r->pose.theta_rad) + r->vy_mps * sin(r->pose.theta_rad); // it does not slip
      r->pose.x_m += by_s * v_mps * ahead;
      r->pose.y_m += by_s * v_mps * side;
      r->pose.theta_rad = vs_wrap_rad(r->pose.theta_rad + by_s * r->omega_radps);
    }
}

void vs_go_to_step(vs_go_to *go, const vs_world *world, vs_team team, const vs_pose target[VS_TEAM_SIZE],
                   vs_wheels out[VS_TEAM_SIZE]) {
  vs_world w = *world;
  move_on(&w, go->delay_s);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    out[i] = w.robot[team][i].valid ? step_robot(go, &w, team, i, &target[i]) : (vs_wheels){0, 0};
}

bool vs_go_to_arrived(const vs_world *w, vs_team team, const vs_pose target[VS_TEAM_SIZE]) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_pose *p = &w->robot[team][i].pose;
    if (!w->robot[team][i].valid) continue;
    if (vs_distance_m(p->x_m, p->y_m, target[i].x_m, target[i].y_m) > VS_GO_TO_M) return false;
    if (fabs(vs_wrap_rad(p->theta_rad - target[i].theta_rad)) > VS_GO_TO_RAD) return false;
  }
  return true;
}
