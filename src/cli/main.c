// The command table. A command is one row here and one file cmd_NAME.c.
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "cli.h"
#include "player_lcm.h"
#include "vsss_commit.h"

typedef struct command {
  const char *name;
  int (*run)(int argc, char **argv);
  const char *help;
} command;

static const command commands[] = {
    {"sim", cmd_sim, "play matches in the simulator"},
    {"eval", cmd_eval, "statistics over many matches between any two players"},
    {"calibrate", cmd_calibrate, "make the file that turns pixels into metres; print tags"},
    {"detect", cmd_detect, "find tags in a picture and print their corners"},
    {"field", cmd_field, "play on a real field: camera, policy, radio"},
    {"doctor", cmd_doctor, "is everything ready to play? each thing ok, or how to mend it"},
    {"rig", cmd_rig, "a venue without hardware, for field to play in"},
    {"serve", cmd_serve, "teams' own programs play here, over the simulation league's network"},
    {"league", cmd_league, "clubs play each other: players and teams' own programs; table, page, logs"},
    {"train", cmd_train, "learn by self-play; writes a policy as ONNX"},
    {"bridge", cmd_bridge, "carry wheel commands from LCM to the radio, and telemetry back"},
    {"latency", cmd_latency, "from a log of the field: camera to radio, and command to motion"},
    {"identify", cmd_identify, "from a log of the field: delay, time constants and gains of each robot"},
    {"plot", cmd_plot, "figures of a training run"},
    {"view", cmd_view, "a match in the browser, from a log or live"},
    {"replay", cmd_replay, "show a log of lcm-logger as text or video, or send it again"},
    {"spy", cmd_spy, "who says what on LCM, in a window or in the terminal"},
    {NULL, NULL, NULL},
};

static void print_commands(FILE *out) {
  fprintf(out, "usage: vsss COMMAND [flags]\n\nIEEE Very Small Size Soccer: simulate, learn, play on the field.\n\n");
  for (const command *c = commands; c->name; c++) fprintf(out, "  %-12s %s\n", c->name, c->help);
  fprintf(out, "\n'vsss COMMAND --help' tells the flags of one, 'vsss --version' what this build is made of.\n");
}

static const command *find(const char *name) {
  for (const command *c = commands; c->name; c++)
    if (!strcmp(name, c->name)) return c;
  return NULL;
}

// The known command that differs by one letter added, left out, changed or swapped with the next; else NULL.
static const char *nearest(const char *name) {
  for (const command *c = commands; c->name; c++) {
    const char *a = name, *b = c->name;
    while (*a && *a == *b) a++, b++;
    if (!strcmp(*a ? a + 1 : a, b) || !strcmp(a, *b ? b + 1 : b)) return c->name;
    if (*a && *b && (!strcmp(a + 1, b + 1) || (a[0] == b[1] && a[1] == b[0] && !strcmp(a + 2, b + 2)))) return c->name;
  }
  return NULL;
}

static int unknown(const char *name) {
  const char *near = nearest(name);
  if (near)
    fprintf(stderr, "vsss: unknown command '%s'; did you mean '%s'?\n", name, near);
  else
    fprintf(stderr, "vsss: unknown command '%s'; 'vsss --help' lists them\n", name);
  return VS_USAGE;
}

static int help(int argc, char **argv) {
  if (argc < 2) {
    print_commands(stdout);
    return 0;
  }
  const command *c = find(argv[1]);
  char *words[] = {argv[1], "--help", NULL};
  return c ? c->run(2, words) : unknown(argv[1]);
}

int main(int argc, char **argv) {
  if (!vs_cli_begin()) return VS_USAGE;
  vs_cli_commit = VSSS_COMMIT;
  if (argc > 0) vs_cli_program = argv[0];
  vs_cli_quiet_first_session();
  vs_player_register("lcm:", PLAYER_LCM_HELP, player_lcm_open);
  if (argc < 2) {
    print_commands(stderr);
    return VS_USAGE;
  }
  if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "-h") || !strcmp(argv[1], "help"))
    return vs_cli_end("help", help(argc - 1, argv + 1));
  if (!strcmp(argv[1], "--version") || !strcmp(argv[1], "-V") || !strcmp(argv[1], "version")) {
    vs_cli_version();
    return vs_cli_end("version", 0);
  }
  const command *c = find(argv[1]);
  return c ? vs_cli_end(c->name, c->run(argc - 1, argv + 1)) : unknown(argv[1]);
}
