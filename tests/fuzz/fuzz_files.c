// Fuzzes src/vision/calib_file.c and src/sim/realism.c: files that people edit. A calibration that was taken is used.
#include "fuzz.h"
#include "vsss/calib.h"
#include "vsss/sensor_model.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_error err = {0};
  vs_calib calib;
  vs_realism realism = vs_realism_default();
  const char *path = fuzz_file(data, size);
  if (vs_calib_load(path, &calib, &err) == VS_OK) {
    double x_m, y_m;
    (void)vs_calib_to_field(&calib, 100, 100, 0.04, &x_m, &y_m);
    (void)vs_calib_to_pixel(&calib, 0.1, 0.1, 0.04, &x_m, &y_m);
  }
  if (vs_realism_load(path, &realism, &err) == VS_OK) {
    vs_sensors sensors;
    vs_world world = {0}, measured;
    vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST] = {0}, out[VS_TEAMS][VS_TEAM_MOST];
    vs_sensors_reset(&sensors, &realism, 1);
    for (int i = 0; i < 20; i++) {
      vs_sensors_measure(&sensors, &world, &measured);
      vs_sensors_command(&sensors, (const vs_wheels(*)[VS_TEAM_MOST])wheels, out);
    }
  }
  return 0;
}
