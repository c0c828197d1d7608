#include "eyes.h"

#include <stdio.h>
#include <string.h>

#include "vsss/clock.h"

#define RETRY_MIN_US 50000

// What has a scheme or is a device may come back; a file that cannot be read stays so.
static bool is_live(const char *source) {
  return !strncmp(source, "/dev/", 5) || source[strspn(source, "abcdefghijklmnopqrstuvwxyz0123456789")] == ':';
}

vs_status vs_eyes_open(vs_eyes *e, const char *source, const vs_camera_def *def, vs_error *err) {
  *e = (vs_eyes){.source = source, .def = *def, .live = is_live(source)};
  vs_status s = vs_camera_open(source, &e->def, &e->camera, err);
  if (s != VS_OK) return s;
  e->info = *vs_camera_about(e->camera);
  e->width = e->info.width;
  e->height = e->info.height;
  e->def.width = e->width; // asked for again
  e->def.height = e->height;
  return VS_OK;
}

void vs_eyes_close(vs_eyes *e) {
  vs_camera_close(e->camera);
  e->camera = NULL;
}

void vs_eyes_lose(vs_eyes *e, const char *why) {
  if (e->camera) e->lost++;
  vs_eyes_close(e);
  snprintf(e->why, sizeof e->why, "%s", why);
  e->pause_us = RETRY_MIN_US;
  e->retry_us = vs_clock_monotonic_us() + e->pause_us;
}

static bool right_size(vs_eyes *e, int width, int height, char *why, size_t size) {
  if (width == e->width && height == e->height) return true;
  snprintf(why, size, "%s now gives pictures of %dx%d, the calibration is for %dx%d; set it back or calibrate anew",
           e->source, width, height, e->width, e->height);
  return false;
}

static void look_again(vs_eyes *e) {
  vs_error why = {0};
  if (vs_camera_open(e->source, &e->def, &e->camera, &why) == VS_OK) {
    const vs_camera_info *info = vs_camera_about(e->camera);
    if (right_size(e, info->width, info->height, why.text, sizeof why.text)) {
      e->info = *info;
      e->reopened++;
      return;
    }
    vs_eyes_close(e);
  }
  snprintf(e->why, sizeof e->why, "%s", why.text);
  e->pause_us = 2 * e->pause_us < VS_EYES_RETRY_MAX_US ? 2 * e->pause_us : VS_EYES_RETRY_MAX_US;
  e->retry_us = vs_clock_monotonic_us() + e->pause_us;
}

// Sleeps, if it must, until it is time to look.
static void wait_for_camera(vs_eyes *e, int timeout_ms) {
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * timeout_ms;
  if (e->retry_us > until_us) {
    vs_clock_sleep_until_us(until_us);
    return;
  }
  vs_clock_sleep_until_us(e->retry_us);
  look_again(e);
}

vs_status vs_eyes_read(vs_eyes *e, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  *got = VS_CAMERA_TIMEOUT;
  if (!e->camera) {
    wait_for_camera(e, timeout_ms);
    return VS_OK;
  }
  vs_error why = {0};
  vs_status s = vs_camera_read(e->camera, timeout_ms, out, got, &why);
  if (s == VS_OK && (*got != VS_CAMERA_FRAME || right_size(e, out->width, out->height, why.text, sizeof why.text)))
    return VS_OK;
  *got = VS_CAMERA_TIMEOUT;
  if (!e->live) return vs_fail(err, VS_FAIL, "%s", why.text);
  vs_eyes_lose(e, why.text);
  return VS_OK;
}
