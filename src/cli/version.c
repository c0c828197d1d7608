// What `vsss --version` says, and what keeps ONNX Runtime's first words off the terminal.
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "cli.h"
#include "vsss/contract.h"
#include "vsss/policy.h"
#include "vsss/sim.h"
#include "vsss/version.h"

const char *vs_cli_commit = "unknown";

void vs_cli_version(void) {
  const char *runtime = vs_onnxruntime_version();
  printf("vsss %s (commit %s)\n", vs_version(), vs_cli_commit);
  printf("MuJoCo %s, ONNX Runtime %s\n", vs_mujoco_version(), runtime ? runtime : "not found");
  printf("built with: %s\n", VSSS_FEATURES);
  if (VSSS_MISSING[0]) printf("built without: %s\n", VSSS_MISSING);
  printf("library interface %d, observation contract %s\n", VSSS_ABI, vs_contract_hash_hex());
}

static int heard = -1; // a copy of standard error while it is away

static void look_away(void) {
  int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  heard = nowhere >= 0 ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0) : -1;
  if (heard >= 0) dup2(nowhere, STDERR_FILENO);
  if (nowhere >= 0) close(nowhere);
}

static void look_back(void) {
  if (heard < 0) return;
  dup2(heard, STDERR_FILENO);
  close(heard);
  heard = -1;
}

void vs_cli_quiet_first_session(void) { vs_player_first_session(look_away, look_back); }
