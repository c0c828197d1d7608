// vsss train: PPO self-play.
#include <stdio.h>

#include "cli.h"
#include "commands.h"
#include "vsss/learn.h"

int cmd_train(int argc, char **argv) {
  const char *untrained = NULL;
  int seed = 1;
  const vs_flag flags[] = {
      {"seed", VS_FLAG_INT, &seed, "N", "everything random follows from it", 0, 2147483647},
      {"write-untrained", VS_FLAG_TEXT, &untrained, "FILE", "write a policy nobody trained as ONNX and stop", 0, 0},
      {.name = NULL},
  };
  bool help;
  vs_error err = {0};
  if (vs_args_parse(argc, argv, "train [flags]", "Learns by self-play.", flags, NULL, &help, &err) != VS_OK)
    return vs_cli_error("train", &err);
  if (help) return 0;
  if (!untrained) {
    vs_fail(&err, VS_USAGE, "say --write-untrained FILE");
    return vs_cli_error("train", &err);
  }
  if (vs_learn_write_untrained(untrained, (uint64_t)seed, &err) != VS_OK) return vs_cli_error("train", &err);
  return 0;
}
