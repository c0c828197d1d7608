// vsss spy: looks at the bus, in a window or in the terminal.
#include "cli.h"
#include "commands.h"
#include "spy.h"
#include "vsss/bus.h"

int cmd_spy(int argc, char **argv) {
  const char *url = NULL;
  bool print = false;
  double seconds = 0.0;
  const vs_flag flags[] = {
      {"print", VS_FLAG_SWITCH, &print, NULL, "a table in the terminal instead of a window", 0, 0},
      {"seconds", VS_FLAG_REAL, &seconds, "S", "with --print: stop after S seconds; 0: at Ctrl-C", 0, 1e6},
      {"lcm", VS_FLAG_TEXT, &url, "URL", "what to listen to (LCM_DEFAULT_URL, else " VS_BUS_DEFAULT_URL ")", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_error err = {0};
  bool help;
  vs_status s = vs_args_parse(argc, argv, "spy [flags]",
                              "Shows who says what on LCM: lcm-spy with the types of vsss, or a table.", flags, NULL,
                              &help, &err);
  if (s == VS_OK && help) return 0;
  if (!url) url = vs_bus_default_url();
  if (s == VS_OK) s = print ? spy_print(url, seconds, &err) : spy_window(url, &err);
  return s == VS_OK ? 0 : vs_cli_error("spy", &err);
}
