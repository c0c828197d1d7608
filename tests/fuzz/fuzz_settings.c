// Fuzzes src/base/config.c through the settings of training, src/learn/train_def.c: what was read must be written so that
// it reads back the same.
#include "fuzz.h"
#include "vsss/learn.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static char written[VS_TRAIN_TEXT_MAX], again[VS_TRAIN_TEXT_MAX];
  char *text = fuzz_text(data, size);
  vs_train_def def = vs_train_def_default(), read = def;
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  vs_error err = {0};
  vs_train_schema(&def, keys);
  vs_status s = vs_config_parse("fuzz", text, keys, &err);
  (void)vs_config_set(text, keys, &err);
  free(text);
  if (s != VS_OK) return 0;
  (void)vs_train_def_check(&def, &err);
  if (vs_train_def_text(&def, size % 2, written, sizeof written) >= sizeof written) abort();
  vs_train_schema(&read, keys);
  if (vs_config_parse("written", written, keys, &err) != VS_OK) abort();
  vs_train_def_text(&read, size % 2, again, sizeof again);
  if (strcmp(written, again) != 0) abort();
  return 0;
}
