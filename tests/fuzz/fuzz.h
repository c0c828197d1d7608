// What the fuzz targets share: libFuzzer calls LLVMFuzzerTestOneInput with bytes it made up; nothing may crash, hang or
// allocate without bound. A target whose input is no text writes seeds into the folder that VSSS_SEEDS names, with the
// program's own encoders.
#ifndef VSSS_TESTS_FUZZ_H
#define VSSS_TESTS_FUZZ_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);

static inline void fuzz_seed(const char *name, const void *data, size_t size) {
  char path[4096];
  const char *folder = getenv("VSSS_SEEDS");
  if (!folder) return;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "wb");
  if (!f) return;
  fwrite(data, 1, size, f);
  fclose(f);
}

// The input as a file; the same name in every call of a process.
static inline const char *fuzz_file(const uint8_t *data, size_t size) {
  static char path[64];
  if (!path[0]) snprintf(path, sizeof path, "/tmp/vsss_fuzz_%d", (int)getpid());
  FILE *f = fopen(path, "wb");
  if (!f) abort();
  fwrite(data, 1, size, f);
  fclose(f);
  return path;
}

// The input as text.
static inline char *fuzz_text(const uint8_t *data, size_t size) {
  char *text = malloc(size + 1);
  if (!text) abort();
  memcpy(text, data, size);
  text[size] = '\0';
  return text;
}

#endif
