// src/field/field_loop.c, src/field/tap.c and src/field/record.c: after the first pictures the loop allocates nothing of our own.
// Stands in front of the allocator and counts the calls that come out of this program's code; those of the libraries it uses
// (libapriltag takes memory for every picture) come from elsewhere.
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "assert_near.h"
#include "field/tagged_picture.h"
#include "vsss/bus.h"
#include "vsss/clock.h"
#include "vsss/field_loop.h"
#include "vsss/image.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define COUNTS 0
#else
#define COUNTS 1
#endif

static atomic_long ours;

#if COUNTS
// The linker's: where this program's code begins and ends.
extern const char __executable_start, etext;
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t n, size_t size);
extern void *__libc_realloc(void *block, size_t size);

static void count(const void *caller) {
  if ((const char *)caller >= &__executable_start && (const char *)caller < &etext) atomic_fetch_add(&ours, 1);
}

__attribute__((noinline)) void *malloc(size_t size) {
  count(__builtin_return_address(0));
  return __libc_malloc(size);
}

__attribute__((noinline)) void *calloc(size_t n, size_t size) {
  count(__builtin_return_address(0));
  return __libc_calloc(n, size);
}

__attribute__((noinline)) void *realloc(void *block, size_t size) {
  count(__builtin_return_address(0));
  return __libc_realloc(block, size);
}
#endif

enum { W = PICTURE_W, H = PICTURE_H };
static uint8_t picture[3 * W * H], grey[W * H];
static uint32_t seq;

static vs_status open_fake(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                           vs_error *err) {
  (void)rest, (void)def, (void)err;
  *handle = picture;
  *info = (vs_camera_info){.width = W, .height = H, .fps = 30};
  return VS_OK;
}

// Every tenth picture does not come.
static vs_status read_fake(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  (void)handle, (void)timeout_ms, (void)err;
  vs_clock_sleep_until_us(vs_clock_monotonic_us() + 33333);
  *got = seq % 10 == 9 ? VS_CAMERA_TIMEOUT : VS_CAMERA_FRAME;
  *out = (vs_frame){.grey = grey,
                    .bgr = picture,
                    .width = W,
                    .height = H,
                    .grey_stride = W,
                    .bgr_stride = 3 * W,
                    .capture_us = vs_clock_monotonic_us() - 1000,
                    .seq = seq++};
  return VS_OK;
}

static void close_fake(void *handle) { (void)handle; }

static void the_counter_sees_our_own_calls(void **state) {
  (void)state;
  if (!COUNTS) skip();
  long before = ours;
  void *volatile block = malloc(10);
  free(block);
  assert_int_equal(ours - before, 1);
}

static void the_loop_allocates_nothing(void **state) {
  (void)state;
  if (!COUNTS) {
    print_message("note: the sanitizer owns the allocator\n");
    skip();
  }
  static const vs_camera_api api = {"fake", "fake: for tests", open_fake, read_fake, close_fake};
  vs_camera_register(&api);
  paint_tagged_picture(picture);
  vs_image_grey(picture, 3 * W, W, H, grey, W);
  char record[64];
  snprintf(record, sizeof record, "/tmp/vsss_allocations_%ld.lcm", (long)getpid());
  vs_field_def def = vs_field_def_default();
  bool bus = vs_bus_supported(NULL) == VS_OK;
  def.camera = "fake:";
  def.policy = "emc:";
  def.go = true;
  def.lcm = bus;
  def.lcm_url = bus ? "memq://" : NULL;
  def.image_hz = 0; // pictures are made by a thread of their own
  def.record = bus ? record : NULL;
  vs_field *field;
  static vs_field_stats stats;
  assert_ok(vs_field_new(&def, &field, NULL, 0, err));
  long before = 0;
  for (int i = 0; i < 60; i++) {
    vs_field_tick_result r;
    if (i == 20) before = ours;
    assert_ok(vs_field_tick(field, &r, err));
  }
  long taken = ours - before;
  vs_field_get_stats(field, &stats);
  assert_true(stats.decisions > 20);
  if (taken) fail_msg("%ld allocations in 40 turns", taken);
  vs_field_free(field);
  unlink(record);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_counter_sees_our_own_calls),
      cmocka_unit_test(the_loop_allocates_nothing),
  };
  return cmocka_run_group_tests_name("field/loop_allocations", tests, NULL, NULL);
}
