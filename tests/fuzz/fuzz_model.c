// Fuzzes how src/policy/policy_onnx.c reads a model's metadata: notes of made-up keys and values among ours, or made-up
// bytes where a true model's metadata stands. The network in front of them is a true one of one unit.
#define _GNU_SOURCE // memmem
#include "fuzz.h"
#include "learn/export.h"
#include "vsss/contract.h"
#include "vsss/policy.h"

static uint8_t *model; // up to its metadata
static size_t model_size;

static vs_status write_model(const char *path, const vs_onnx_note *note, int notes, vs_error *err) {
  static const vs_net_shape shape = {VS_OBS_SIZE, 1, {1}, VS_ACTION_SIZE, false};
  static float *parameters;
  vs_net net;
  if (vs_net_init(&net, &shape, err) != VS_OK) abort();
  if (!parameters) {
    vs_rng rng = vs_rng_make(1, 0);
    parameters = calloc(net.size, sizeof *parameters);
    if (!parameters || vs_net_randomise(&net, 4.0, &rng, parameters, err) != VS_OK) abort();
  }
  const vs_export_def def = {"fuzz", {.action_gain = 1.0}, false, note, notes};
  return vs_export_actor(path, &net, parameters, &def, err);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  static const vs_onnx_note note = {"seed", "7"};
  vs_error err = {0};
  const char *path = fuzz_file(NULL, 0);
  if (write_model(path, &note, 1, &err) != VS_OK) abort();
  FILE *f = fopen(path, "rb");
  model = malloc(1 << 20);
  size_t size = f && model ? fread(model, 1, 1 << 20, f) : 0;
  if (f) fclose(f);
  const uint8_t *contract = size ? memmem(model, size, "\012\010contract", 10) : NULL; // a note's key
  if (!contract) abort();
  model_size = (size_t)(contract - model) - 2; // before the note's own key and length
  uint8_t seed[4096] = {1};
  size_t tail = size - model_size < sizeof seed - 1 ? size - model_size : sizeof seed - 1;
  memcpy(seed + 1, model + model_size, tail);
  fuzz_seed("metadata", seed, tail + 1);
  fuzz_seed("notes", "\000contract\nffffffffffffffff\nlayout\n\n", 35);
  return 0;
}

// Lines of the input as keys and values, each NUL-terminated.
static vs_status write_notes(char *text, const char *path, vs_error *err) {
  vs_onnx_note note[8];
  int notes = 0;
  while (notes < 8) {
    char *key = strsep(&text, "\n"), *value = text ? strsep(&text, "\n") : NULL;
    if (!value) break;
    note[notes++] = (vs_onnx_note){key, value};
  }
  return write_model(path, note, notes, err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 1) return 0;
  vs_error err = {0};
  const char *path = fuzz_file(NULL, 0);
  if (data[0] % 2 == 0) {
    char *text = fuzz_text(data + 1, size - 1);
    if (write_notes(text, path, &err) != VS_OK) abort();
    free(text);
  } else {
    uint8_t *whole = malloc(model_size + size - 1);
    memcpy(whole, model, model_size);
    memcpy(whole + model_size, data + 1, size - 1);
    fuzz_file(whole, model_size + size - 1);
    free(whole);
  }
  char uri[128];
  vs_player *player;
  snprintf(uri, sizeof uri, "onnx:%s", path);
  if (vs_player_open(uri, &player, &err) == VS_OK) vs_player_close(player);
  if (strlen(err.text) >= sizeof err.text) abort();
  return 0;
}
