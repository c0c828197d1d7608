// Fuzzes src/comms/bus_log.c: a file of lcm-logger.
#include <endian.h>

#include "fuzz.h"
#include "vsss/bus_log.h"

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  struct {
    uint32_t sync, number[2], utime[2], channel_size, size;
    char rest[8];
  } event = {.sync = htobe32(0xEDA1DA01), .channel_size = htobe32(4), .size = htobe32(4), .rest = "NAMEdat"};
  fuzz_seed("event", &event, sizeof event);
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_error err = {0};
  vs_bus_log *log = NULL;
  if (vs_bus_log_open(fuzz_file(data, size), &log, &err) != VS_OK) return 0;
  vs_log_event event;
  bool end = false;
  size_t sum = 0;
  while (vs_bus_log_next(log, &event, &end, &err) == VS_OK && !end)
    for (size_t i = 0; i < event.size; i++) sum += event.data[i]; // all of it is there
  (void)vs_bus_log_fraction(log);
  vs_bus_log_close(log);
  return sum == (size_t)-1;
}
