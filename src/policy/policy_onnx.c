// onnx:FILE, a learned player through ONNX Runtime's C interface. The library is opened when the first model is, so
// that the program starts without it. Settings: one thread, sequential, no spinning (no latency spikes, the same result
// whatever else runs), preallocated tensors.
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <onnxruntime_c_api.h>
#include <onnxruntime_session_options_config_keys.h>

#include "policy_internal.h"
#include "vsss/paths.h"

static void (*before_first)(void), (*after_first)(void);

void vs_player_first_session(void (*before)(void), void (*after)(void)) {
  before_first = before;
  after_first = after;
}

enum { API = 20, ROWS = VS_TEAM_SIZE, WARM_UPS = 10 };

typedef struct onnx_player {
  vs_obs_player base;
  const OrtApi *ort; // of the library, never unloaded
  OrtEnv *env;
  OrtSession *session;
  OrtMemoryInfo *memory;
  OrtValue *input, *output; // over the two arrays below
  float observation[ROWS][VS_OBS_SIZE];
  float action[ROWS][VS_ACTION_SIZE];
  char file[PATH_MAX];
} onnx_player;

// Turns an OrtStatus into an error naming the file, and releases it.
static vs_status check(onnx_player *p, OrtStatus *status, const char *doing, vs_error *err) {
  if (!status) return VS_OK;
  char text[300];
  snprintf(text, sizeof text, "%s", p->ort->GetErrorMessage(status));
  text[strcspn(text, "\n")] = '\0';
  p->ort->ReleaseStatus(status);
  return vs_fail(err, VS_FAIL, "%s: %s: %s", p->file, doing, text);
}

static void close_player(vs_obs_player *base) {
  onnx_player *p = (onnx_player *)base;
  if (p->output) p->ort->ReleaseValue(p->output);
  if (p->input) p->ort->ReleaseValue(p->input);
  if (p->memory) p->ort->ReleaseMemoryInfo(p->memory);
  if (p->session) p->ort->ReleaseSession(p->session);
  if (p->env) p->ort->ReleaseEnv(p->env);
  free(p);
}

static vs_status run(onnx_player *p, vs_error *err) {
  static const char *const inputs[] = {"observation"}, *const outputs[] = {"action"};
  return check(p, p->ort->Run(p->session, NULL, inputs, (const OrtValue *const *)&p->input, 1, outputs, 1, &p->output),
               "cannot be run", err);
}

static vs_status act(vs_obs_player *base, const float *obs, int rows, float *action, vs_error *err) {
  onnx_player *p = (onnx_player *)base;
  if (rows != ROWS) return vs_fail(err, VS_FAIL, "%s: %d rows asked for, it takes %d", p->file, rows, ROWS);
  memcpy(p->observation, obs, sizeof p->observation);
  vs_status s = run(p, err);
  if (s == VS_OK) memcpy(action, p->action, sizeof p->action);
  return s;
}

// The library that $VSSS_ONNXRUNTIME names, the one that came with vsss (Debian 12), the system's (Debian 13).
static const OrtApiBase *load_library(vs_error *err) {
  char path[PATH_MAX];
  void *library = NULL;
  const char *given = getenv("VSSS_ONNXRUNTIME");
  if (given && !(library = dlopen(given, RTLD_NOW | RTLD_LOCAL))) {
    vs_fail(err, VS_FAIL, "VSSS_ONNXRUNTIME=%s cannot be loaded: %s", given, dlerror());
    return NULL;
  }
  if (!library && vs_path_library("build/onnxruntime/lib/libonnxruntime.so.1", path, sizeof path, NULL) == VS_OK)
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  static const char *const names[] = {"libonnxruntime.so.1", "libonnxruntime.so.1.21", "libonnxruntime.so"};
  for (size_t i = 0; !library && i < sizeof names / sizeof *names; i++)
    library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    vs_fail(err, VS_FAIL, "libonnxruntime.so.1 not found: run 'sudo sh deploy/setup.sh'");
    return NULL;
  }
  const OrtApiBase *(*base)(void) = (const OrtApiBase *(*)(void))dlsym(library, "OrtGetApiBase");
  if (!base) vs_fail(err, VS_FAIL, "libonnxruntime.so.1 has no OrtGetApiBase");
  return base ? base() : NULL;
}

const char *vs_onnxruntime_version(void) {
  const OrtApiBase *base = load_library(NULL);
  return base ? base->GetVersionString() : NULL;
}

static vs_status open_library(onnx_player *p, vs_error *err) {
  const OrtApiBase *base = load_library(err);
  if (!base) return vs_fail_prefix(err, "%s", p->file);
  p->ort = base->GetApi(API);
  if (!p->ort)
    return vs_fail(err, VS_FAIL, "%s: ONNX Runtime %s is older than 1.%d: run 'sudo sh deploy/setup.sh'", p->file,
                   base->GetVersionString(), API);
  return VS_OK;
}

static vs_status set_options(onnx_player *p, OrtSessionOptions *options, vs_error *err) {
  const OrtApi *ort = p->ort;
  static const char *const config[][2] = {
      {kOrtSessionOptionsConfigSetDenormalAsZero, "1"},
      {kOrtSessionOptionsConfigAllowIntraOpSpinning, "0"},
      {kOrtSessionOptionsConfigAllowInterOpSpinning, "0"},
  };
  OrtStatus *s = ort->SetIntraOpNumThreads(options, 1);
  if (!s) s = ort->SetInterOpNumThreads(options, 1);
  if (!s) s = ort->SetSessionExecutionMode(options, ORT_SEQUENTIAL);
  if (!s) s = ort->SetSessionGraphOptimizationLevel(options, ORT_ENABLE_ALL);
  for (size_t i = 0; !s && i < sizeof config / sizeof *config; i++)
    s = ort->AddSessionConfigEntry(options, config[i][0], config[i][1]);
  return check(p, s, "session options", err);
}

// The first session of a process is made alone, between the two calls of vs_player_first_session.
static OrtStatus *create_session(onnx_player *p, const OrtSessionOptions *options) {
  static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
  static bool registered;
  pthread_mutex_lock(&lock);
  bool first = !registered;
  if (first && before_first) before_first();
  OrtStatus *status = p->ort->CreateSession(p->env, p->file, options, &p->session);
  if (first && after_first) after_first();
  registered = registered || !status;
  pthread_mutex_unlock(&lock);
  return status;
}

static vs_status load_model(onnx_player *p, vs_error *err) {
  if (access(p->file, R_OK) != 0) return vs_fail(err, VS_FAIL, "%s: %s", p->file, strerror(errno));
  vs_status s = check(p, p->ort->CreateEnv(ORT_LOGGING_LEVEL_FATAL, "vsss", &p->env), "ONNX Runtime", err);
  if (s != VS_OK) return s;
  OrtSessionOptions *options = NULL;
  s = check(p, p->ort->CreateSessionOptions(&options), "ONNX Runtime", err);
  if (s == VS_OK) s = set_options(p, options, err);
  if (s == VS_OK)
    s = check(p, create_session(p, options), "not a whole ONNX model (truncated? export or copy it again)", err);
  if (options) p->ort->ReleaseSessionOptions(options);
  return s;
}

// The contract's hash in the metadata. A model without one was not made by `vsss train`.
static vs_status check_contract(onnx_player *p, vs_error *err) {
  OrtModelMetadata *metadata = NULL;
  OrtAllocator *allocator = NULL;
  char *hash = NULL;
  OrtStatus *status = p->ort->GetAllocatorWithDefaultOptions(&allocator);
  if (!status) status = p->ort->SessionGetModelMetadata(p->session, &metadata);
  if (!status) status = p->ort->ModelMetadataLookupCustomMetadataMap(metadata, allocator, "contract", &hash);
  vs_status s = check(p, status, "metadata", err);
  if (s == VS_OK && !hash)
    s = vs_fail(err, VS_FAIL, "%s: no 'contract' in its metadata: not a model of 'vsss train' (this program's is %s)",
                p->file, vs_contract_hash_hex());
  else if (s == VS_OK && strcmp(hash, vs_contract_hash_hex()) != 0)
    s = vs_fail(err, VS_FAIL, "%s: made for contract %.32s, this program's is %s: train or export it again", p->file,
                hash, vs_contract_hash_hex());
  if (hash) (void)!p->ort->AllocatorFree(allocator, hash);
  if (metadata) p->ort->ReleaseModelMetadata(metadata);
  return s;
}

// One input or output: its type must be float[any][columns].
static vs_status check_shape(onnx_player *p, OrtTypeInfo *type, const char *name, int64_t columns, vs_error *err) {
  const OrtTensorTypeAndShapeInfo *info = NULL;
  ONNXTensorElementDataType element = ONNX_TENSOR_ELEMENT_DATA_TYPE_UNDEFINED;
  size_t rank = 0;
  int64_t size[4] = {0};
  OrtStatus *s = p->ort->CastTypeInfoToTensorInfo(type, &info);
  if (!s && info) s = p->ort->GetTensorElementType(info, &element);
  if (!s && info) s = p->ort->GetDimensionsCount(info, &rank);
  if (!s && info && rank <= 4) s = p->ort->GetDimensions(info, size, rank);
  p->ort->ReleaseTypeInfo(type);
  if (s) return check(p, s, name, err);
  if (element != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT || rank != 2 || size[1] != columns)
    return vs_fail(err, VS_FAIL, "%s: '%s' has rank %zu and %lld columns, the contract wants float[N][%lld]", p->file,
                   name, rank, rank == 2 ? (long long)size[1] : 0LL, (long long)columns);
  // Rows: any number (reported as -1), or exactly ours.
  if (size[0] >= 0 && size[0] != ROWS)
    return vs_fail(err, VS_FAIL, "%s: '%s' has %lld rows, it must take any number or %d", p->file, name,
                   (long long)size[0], ROWS);
  return VS_OK;
}

// Finds the input or output called `name`.
static vs_status check_port(onnx_player *p, bool input, const char *name, int64_t columns, vs_error *err) {
  const OrtApi *ort = p->ort;
  OrtAllocator *allocator = NULL;
  size_t count = 0;
  OrtStatus *s = ort->GetAllocatorWithDefaultOptions(&allocator);
  if (!s) s = input ? ort->SessionGetInputCount(p->session, &count) : ort->SessionGetOutputCount(p->session, &count);
  if (s) return check(p, s, name, err);
  if (input && count != 1) return vs_fail(err, VS_FAIL, "%s: %zu inputs, the contract wants one", p->file, count);
  for (size_t i = 0; i < count; i++) {
    char *found = NULL;
    OrtTypeInfo *type = NULL;
    s = input ? ort->SessionGetInputName(p->session, i, allocator, &found)
              : ort->SessionGetOutputName(p->session, i, allocator, &found);
    if (s) return check(p, s, name, err);
    bool same = !strcmp(found, name);
    (void)!ort->AllocatorFree(allocator, found);
    if (!same) continue;
    s = input ? ort->SessionGetInputTypeInfo(p->session, i, &type)
              : ort->SessionGetOutputTypeInfo(p->session, i, &type);
    return s ? check(p, s, name, err) : check_shape(p, type, name, columns, err);
  }
  return vs_fail(err, VS_FAIL, "%s: no %s '%s', which the contract wants", p->file, input ? "input" : "output", name);
}

static vs_status make_tensors(onnx_player *p, vs_error *err) {
  static const int64_t in[] = {ROWS, VS_OBS_SIZE}, out[] = {ROWS, VS_ACTION_SIZE};
  const ONNXTensorElementDataType type = ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT;
  OrtStatus *s = p->ort->CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, &p->memory);
  if (!s)
    s = p->ort->CreateTensorWithDataAsOrtValue(p->memory, p->observation, sizeof p->observation, in, 2, type,
                                               &p->input);
  if (!s) s = p->ort->CreateTensorWithDataAsOrtValue(p->memory, p->action, sizeof p->action, out, 2, type, &p->output);
  return check(p, s, "tensors", err);
}

static vs_status prepare(onnx_player *p, vs_error *err) {
  vs_status s = open_library(p, err);
  if (s == VS_OK) s = load_model(p, err);
  if (s == VS_OK) s = check_contract(p, err);
  if (s == VS_OK) s = check_port(p, true, "observation", VS_OBS_SIZE, err);
  if (s == VS_OK) s = check_port(p, false, "action", VS_ACTION_SIZE, err);
  if (s == VS_OK) s = make_tensors(p, err);
  // The first runs allocate and take 10 to 40 times as long as the others.
  for (int i = 0; s == VS_OK && i < WARM_UPS; i++) s = run(p, err);
  return s;
}

vs_status vs_policy_onnx_open(const char *rest, vs_obs_player **out, vs_error *err) {
  static const vs_config_key no_options[] = {{.name = NULL}};
  static const char shipped[] = "models/policy/vsss.onnx";
  *out = NULL;
  size_t length = strcspn(rest, "?");
  vs_status s = vs_player_options("onnx:", rest + length + (rest[length] == '?'), no_options, err);
  if (s != VS_OK) return s;
  onnx_player *p = calloc(1, sizeof *p);
  if (!p) return vs_fail(err, VS_FAIL, "onnx:%s: out of memory", rest);
  p->base = (vs_obs_player){act, close_player, "onnx"};
  snprintf(p->file, sizeof p->file, "%.*s", length ? (int)length : (int)strlen(shipped), length ? rest : shipped);
  // A file of ours, such as models/policy/vsss.onnx, is found from any folder.
  char found[PATH_MAX];
  if (p->file[0] != '/' && access(p->file, F_OK) != 0 && vs_path_find(p->file, found, sizeof found, NULL) == VS_OK)
    snprintf(p->file, sizeof p->file, "%s", found);
  s = prepare(p, err);
  if (s != VS_OK) {
    close_player(&p->base);
    return s;
  }
  *out = &p->base;
  return VS_OK;
}
