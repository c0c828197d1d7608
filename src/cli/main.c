// The command table. A command is one row here and one file cmd_NAME.c.
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "cli.h"
#include "player_lcm.h"

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
    {"rig", cmd_rig, "a venue without hardware, for field to play in"},
    {"serve", cmd_serve, "teams' own programs play here, over the simulation league's network"},
    {"train", cmd_train, "learn by self-play; writes a policy as ONNX"},
    {"bridge", cmd_bridge, "carry wheel commands from LCM to the radio, and telemetry back"},
    {"plot", cmd_plot, "figures of a training run"},
    {"replay", cmd_replay, "show a log of lcm-logger as text or video, or send it again"},
    {"spy", cmd_spy, "who says what on LCM, in a window or in the terminal"},
    {NULL, NULL, NULL},
};

static void print_commands(FILE *out) {
  fprintf(out, "usage: vsss COMMAND [flags]\n\nIEEE Very Small Size Soccer: simulate, learn, play on the field.\n\n");
  for (const command *c = commands; c->name; c++) fprintf(out, "  %-12s %s\n", c->name, c->help);
  fprintf(out, "\n'vsss COMMAND --help' tells the flags of one.\n");
}

int main(int argc, char **argv) {
  if (!vs_cli_begin()) return VS_USAGE;
  vs_player_register("lcm:", PLAYER_LCM_HELP, player_lcm_open);
  if (argc < 2) {
    print_commands(stderr);
    return VS_USAGE;
  }
  if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "-h") || !strcmp(argv[1], "help")) {
    print_commands(stdout);
    return vs_cli_end("help", 0);
  }
  for (const command *c = commands; c->name; c++)
    if (!strcmp(argv[1], c->name)) return vs_cli_end(c->name, c->run(argc - 1, argv + 1));
  fprintf(stderr, "vsss: unknown command '%s'; 'vsss --help' lists them\n", argv[1]);
  return VS_USAGE;
}
