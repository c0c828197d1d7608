// src/stream/frame_server.c and src/stream/frame_client.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "assert_near.h"
#include "stream/frame_wire.h"
#include "vsss/clock.h"
#include "vsss/frame_stream.h"

enum { W = 320, H = 240 };
static uint8_t rgb[H][W][3];
static char folder[] = "/tmp/vsss_stream_XXXXXX", path[64], source[80];

static int make_folder(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return 1;
  snprintf(path, sizeof path, "%s/camera", folder);
  snprintf(source, sizeof source, "rig:%s", path);
  vs_camera_register(vs_frame_stream_camera());
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder); // fails where a socket was left behind
}

static void paint(uint8_t red, uint8_t green, uint8_t blue) {
  for (int i = 0; i < W * H; i++) {
    uint8_t *p = &rgb[0][0][0] + 3 * i;
    p[0] = red;
    p[1] = green;
    p[2] = blue;
  }
}

static void wait_connected(vs_frame_server *server) {
  for (int i = 0; i < 500 && !vs_frame_server_get_stats(server).connected; i++)
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 2000);
  assert_true(vs_frame_server_get_stats(server).connected);
}

static void a_picture_arrives_whole_with_its_stamp_and_number(void **state) {
  (void)state;
  vs_frame_server *server;
  vs_camera *camera;
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  const vs_camera_info *info = vs_camera_about(camera);
  assert_int_equal(info->width, W);
  assert_int_equal(info->height, H);
  assert_near(info->fps, 30, 0);
  wait_connected(server);
  paint(200, 100, 50);
  rgb[H - 1][W - 1][0] = 7;
  vs_frame_server_put(server, &rgb[0][0][0], 123456789, 42);
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_read(camera, 2000, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_int_equal(frame.capture_us, 123456789);
  assert_int_equal(frame.seq, 42);
  assert_int_equal(frame.bgr[0], 50); // blue first
  assert_int_equal(frame.bgr[2], 200);
  assert_int_equal(frame.bgr[(H - 1) * frame.bgr_stride + 3 * (W - 1) + 2], 7);
  // 0.299 * 200 + 0.587 * 100 + 0.114 * 50 = 124.2
  assert_near(frame.grey[0], 124, 1);
  assert_ok(vs_camera_read(camera, 20, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_TIMEOUT); // each picture once
  vs_camera_close(camera);
  vs_frame_server_free(server);
}

static void a_late_reader_gets_few_old_pictures_and_then_the_newest(void **state) {
  (void)state;
  vs_frame_server *server;
  vs_camera *camera;
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  wait_connected(server);
  for (int i = 0; i < 200; i++) { // nobody reads: the socket fills, the rest is replaced
    vs_frame_server_put(server, &rgb[0][0][0], i, (uint32_t)i);
    if (i % 20 == 0) vs_clock_sleep_until_us(vs_clock_monotonic_us() + 2000);
  }
  vs_frame frame = {0};
  vs_camera_got got = VS_CAMERA_FRAME;
  int reads = 0;
  while (frame.seq != 199 && reads++ < 20) assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(frame.seq, 199);
  assert_true(vs_frame_server_get_stats(server).dropped > 100);
  vs_camera_close(camera);
  vs_frame_server_free(server);
}

static void the_next_viewer_is_served_when_one_leaves(void **state) {
  (void)state;
  vs_frame_server *server;
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  for (int viewer = 0; viewer < 2; viewer++) {
    vs_camera *camera;
    assert_ok(vs_camera_open(source, NULL, &camera, err));
    wait_connected(server);
    vs_frame frame;
    vs_camera_got got;
    vs_frame_server_put(server, &rgb[0][0][0], 1, 1);
    assert_ok(vs_camera_read(camera, 2000, &frame, &got, err));
    assert_int_equal(got, VS_CAMERA_FRAME);
    vs_camera_close(camera);
  }
  assert_int_equal(vs_frame_server_get_stats(server).clients, 2);
  vs_frame_server_free(server);
}

static void a_server_that_goes_away_is_an_error_of_the_camera(void **state) {
  (void)state;
  vs_frame_server *server;
  vs_camera *camera;
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  vs_frame_server_free(server);
  vs_frame frame;
  vs_camera_got got;
  vs_error err = {0};
  assert_int_equal(vs_camera_read(camera, 1000, &frame, &got, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "the rig is gone"));
  vs_camera_close(camera);
}

static void a_second_server_in_the_same_place_is_refused_and_a_dead_one_replaced(void **state) {
  (void)state;
  vs_frame_server *server, *second;
  vs_error err = {0};
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  assert_int_equal(vs_frame_server_new(path, W, H, 30, &second, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "in use by another rig"));
  char moved[80];
  snprintf(moved, sizeof moved, "%s/dead", folder);
  assert_int_equal(rename(path, moved), 0); // what a crash would leave
  vs_frame_server_free(server);
  assert_int_equal(rename(moved, path), 0);
  assert_ok(vs_frame_server_new(path, W, H, 30, &server, err));
  vs_frame_server_free(server);
  assert_int_not_equal(access(path, F_OK), 0);
}

static void no_server_is_an_error_that_says_how_to_start_one(void **state) {
  (void)state;
  vs_camera *camera;
  vs_error err = {0};
  assert_int_equal(vs_camera_open(source, NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "vsss rig"));
}

// A process in the rig's place that sends `bytes`, then `again` for ever, every pause_us.
static pid_t start_impostor(const void *bytes, size_t count, const void *again, size_t size, int pause_us) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
  int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  assert_int_equal(bind(listener, (struct sockaddr *)&address, sizeof address), 0);
  assert_int_equal(listen(listener, 1), 0);
  pid_t child = fork();
  if (child == 0) {
    alarm(60);
    int viewer = accept(listener, NULL, NULL);
    bool sent = write(viewer, bytes, count) == (ssize_t)count;
    while (sent && write(viewer, again, size) == (ssize_t)size)
      if (pause_us) usleep((useconds_t)pause_us);
    _exit(0);
  }
  close(listener);
  return child;
}

static void end_impostor(pid_t child) {
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  unlink(path);
}

// At that pace a picture would take 20 minutes.
static void bytes_that_trickle_hold_nobody_up(void **state) {
  (void)state;
  const vs_wire_hello hello = {.magic = VS_WIRE_HELLO, .width_px = W, .height_px = H, .fps = 30};
  struct {
    vs_wire_hello hello;
    vs_wire_frame frame;
  } begin = {hello, {.magic = VS_WIRE_FRAME, .seq = 1}};
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_FRAME;
  pid_t child = start_impostor(&begin, sizeof begin, "", 1, 5000);
  alarm(60); // who waits for the rest ends here
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  for (int i = 0; i < 5; i++) {
    assert_ok(vs_camera_read(camera, 50, &frame, &got, err));
    assert_int_equal(got, VS_CAMERA_TIMEOUT);
  }
  vs_camera_close(camera);
  end_impostor(child);

  vs_error err = {0};
  child = start_impostor(&hello, 4, &hello.width_px, 1, 200000); // the hello itself: 4 s
  assert_int_equal(vs_camera_open(source, NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "busy"));
  end_impostor(child);
  alarm(0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_picture_arrives_whole_with_its_stamp_and_number),
      cmocka_unit_test(a_late_reader_gets_few_old_pictures_and_then_the_newest),
      cmocka_unit_test(the_next_viewer_is_served_when_one_leaves),
      cmocka_unit_test(a_server_that_goes_away_is_an_error_of_the_camera),
      cmocka_unit_test(a_second_server_in_the_same_place_is_refused_and_a_dead_one_replaced),
      cmocka_unit_test(no_server_is_an_error_that_says_how_to_start_one),
      cmocka_unit_test(bytes_that_trickle_hold_nobody_up),
  };
  return cmocka_run_group_tests_name("stream/frame_server", tests, make_folder, remove_folder);
}
