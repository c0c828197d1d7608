// lcm:TEAM, a player in another process: it is asked over VSSS_STATE and answers over VSSS_CMD.
#ifndef VSSS_CLI_PLAYER_LCM_H
#define VSSS_CLI_PLAYER_LCM_H

#include "vsss/policy.h"

#define PLAYER_LCM_HELP "blue|yellow, a player in another process (deploy/examples/lcm); ?timeout_ms=2000&url=URL"

vs_status player_lcm_open(const char *rest, vs_player_given *out, vs_error *err); // a vs_player_provider

#endif
