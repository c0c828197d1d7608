// Reads the recorded behaviour of the original opponents, tests/data/opponents/NAME.csv.gz: 54,000 robot commands each.
#ifndef VSSS_TESTS_POLICY_VECTORS_H
#define VSSS_TESTS_POLICY_VECTORS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/paths.h"
#include "vsss/world.h"

#define VECTORS_COMMANDS 54000
#define VECTORS_COLUMNS  48

typedef struct vectors {
  FILE *pipe;
  char line[2048];
  char *column[VECTORS_COLUMNS]; // of the present row; missing ones are ""
} vectors;

static void vectors_open(vectors *v, const char *name) {
  char command[1200], relative[100], path[1100];
  snprintf(relative, sizeof relative, "tests/data/opponents/%s.csv.gz", name);
  assert_ok(vs_path_find(relative, path, sizeof path, err));
  snprintf(command, sizeof command, "gzip -dc '%s'", path);
  v->pipe = popen(command, "r");
  assert_non_null(v->pipe);
  assert_non_null(fgets(v->line, sizeof v->line, v->pipe)); // the header line
}

static bool vectors_next(vectors *v) {
  if (!fgets(v->line, sizeof v->line, v->pipe)) return false;
  v->line[strcspn(v->line, "\r\n")] = '\0';
  static char empty[1] = "";
  char *at = v->line;
  for (int i = 0; i < VECTORS_COLUMNS; i++) {
    v->column[i] = at ? at : empty;
    char *comma = at ? strchr(at, ',') : NULL;
    if (comma) *comma = '\0';
    at = comma ? comma + 1 : NULL;
  }
  return true;
}

static double vectors_number(const vectors *v, int column) { return strtod(v->column[column], NULL); }

// Where ball and own robots are in the present row: columns of the ball's x, of the first robot's x, from one to the next.
static vs_world vectors_world(const vectors *v, int ball, int robot, int step) {
  vs_world world = {.ball = {.x_m = vectors_number(v, ball), .y_m = vectors_number(v, ball + 1)}};
  for (int i = 0, c = robot; i < VS_TEAM_SIZE; i++, c += step)
    world.robot[VS_OWN][i].pose = (vs_pose){vectors_number(v, c), vectors_number(v, c + 1), vectors_number(v, c + 2)};
  return world;
}

static void vectors_close(vectors *v) { assert_int_equal(pclose(v->pipe), 0); }

#endif
