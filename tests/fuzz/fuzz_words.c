// Fuzzes src/policy/policy.c (player URIs), src/learn/league.c and src/learn/reward_mix.c (mixes), src/cli/args.c (flags).
#include "cli/cli.h"
#include "fuzz.h"
#include "learn/league.h"
#include "learn/reward_mix.h"
#include "vsss/policy.h"

static void flags(char *text) {
  static bool help, on;
  static int whole;
  static double real;
  static uint64_t seed;
  const char *word = NULL;
  vs_flag_list list = {0}, words = {0};
  const vs_flag table[] = {{"on", VS_FLAG_SWITCH, &on, NULL, "", 0, 0},
                           {"n", VS_FLAG_INT, &whole, "N", "", -5, 9},
                           {"x", VS_FLAG_REAL, &real, "X", "", 0, 0},
                           {"seed", VS_FLAG_SEED, &seed, "N", "", 0, 0},
                           {"word", VS_FLAG_TEXT, &word, "W", "", 0, 0},
                           {"list", VS_FLAG_LIST, &list, "L", "", 0, 0},
                           {.name = NULL}};
  char *argv[128] = {"vsss"};
  int argc = 1;
  for (char *part; argc < 127 && (part = strsep(&text, "\n")) != NULL;)
    if (strcmp(part, "--help") && strcmp(part, "-h")) argv[argc++] = part;
  vs_error err = {0};
  (void)vs_args_parse(argc, argv, "fuzz", "", table, &words, &help, &err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_error err = {0};
  vs_player *player = NULL;
  vs_league_def league = {0};
  vs_reward_weights weights;
  char *text = fuzz_text(data, size);
  // Foreign code, files and processes are not what is tried here.
  bool foreign = !strncmp(text, "plugin:", 7) || !strncmp(text, "onnx:", 5) || !strncmp(text, "process:", 8);
  if (!foreign && vs_player_open(text, &player, &err) == VS_OK) {
    vs_world world = {0};
    vs_game game = {.duration_s = 120};
    vs_wheels out[VS_TEAM_SIZE];
    for (int i = 0; i < 3; i++) (void)vs_player_step(player, &world, &game, 0.1, out, &err);
    vs_player_close(player);
  }
  (void)vs_league_parse(text, &league, &err);
  (void)vs_reward_mix_parse(text, &weights, &err);
  flags(text);
  free(text);
  return 0;
}
