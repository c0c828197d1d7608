// Takes policy_onnx.c's place where the headers of ONNX Runtime are missing.
#include "policy_internal.h"

void vs_player_first_session(void (*before)(void), void (*after)(void)) { (void)before, (void)after; }

const char *vs_onnxruntime_version(void) { return NULL; }

vs_status vs_policy_onnx_open(const char *rest, vs_obs_player **out, vs_error *err) {
  *out = NULL;
  return vs_fail(err, VS_FAIL,
                 "onnx:%s: this build has no ONNX Runtime (package libonnxruntime-dev on Debian 13): run 'sudo sh "
                 "deploy/setup.sh', then make",
                 rest);
}
