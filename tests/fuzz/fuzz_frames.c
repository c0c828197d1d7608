// Fuzzes src/stream/frame_client.c and frame_server.c, both over real sockets. The first byte chooses the end: what a rig
// says to a viewer (a hello of its own making, or a small true one and then frames), or what a viewer says to a rig and
// how much of the answer it reads before it leaves.
#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "fuzz.h"
#include "stream/frame_wire.h"
#include "vsss/frame_stream.h"

static struct sockaddr_un address = {.sun_family = AF_UNIX};

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  snprintf(address.sun_path, sizeof address.sun_path, "/tmp/vsss_fuzz_frames_%d", (int)getpid());
  uint8_t seed[1 + sizeof(vs_wire_hello) + 2 * (sizeof(vs_wire_frame) + 12)] = {0};
  const vs_wire_hello hello = {VS_WIRE_HELLO, 2, 2, 0, 30.0};
  memcpy(seed + 1, &hello, sizeof hello);
  for (int i = 0; i < 2; i++) {
    const vs_wire_frame head = {VS_WIRE_FRAME, (uint32_t)i, 1000 * i};
    memcpy(seed + 1 + sizeof hello + (size_t)i * (sizeof head + 12), &head, sizeof head);
  }
  fuzz_seed("hello", seed, sizeof seed);
  seed[sizeof hello] = 1; // the frames alone, behind the small hello
  fuzz_seed("frames", seed + sizeof hello, sizeof seed - sizeof hello);
  fuzz_seed("viewer", "\002\0050123456789", 12);
  return 0;
}

typedef struct speech {
  int listener;
  const uint8_t *data;
  size_t size;
  bool hello; // a true one of 2 x 2 pixels first
} speech;

static void *speak(void *context) {
  const speech *s = context;
  int fd = accept(s->listener, NULL, NULL);
  if (fd < 0) return NULL;
  const vs_wire_hello hello = {VS_WIRE_HELLO, 2, 2, 0, 30.0};
  if (s->hello) (void)!send(fd, &hello, sizeof hello, MSG_NOSIGNAL);
  size_t half = s->size / 2; // in two parts, which may end anywhere
  (void)!send(fd, s->data, half, MSG_NOSIGNAL);
  (void)!send(fd, s->data + half, s->size - half, MSG_NOSIGNAL);
  close(fd);
  return NULL;
}

static void view(const uint8_t *data, size_t size, bool hello) {
  speech s = {socket(AF_UNIX, SOCK_STREAM, 0), data, size, hello};
  unlink(address.sun_path);
  if (s.listener < 0 || bind(s.listener, (struct sockaddr *)&address, sizeof address) || listen(s.listener, 1)) abort();
  pthread_t speaker;
  if (pthread_create(&speaker, NULL, speak, &s)) abort();
  const vs_camera_api *camera = vs_frame_stream_camera();
  const vs_camera_def def = {0};
  vs_camera_info info;
  vs_error err = {0};
  void *handle;
  if (camera->open(address.sun_path, &def, &handle, &info, &err) == VS_OK) {
    vs_frame frame;
    vs_camera_got got;
    uint32_t sum = 0;
    for (int i = 0; i < 1000 && camera->read(handle, 5, &frame, &got, &err) == VS_OK; i++) {
      if (got != VS_CAMERA_FRAME) continue;
      for (int row = 0; row < frame.height; row++)
        sum += frame.bgr[row * frame.bgr_stride + 3 * frame.width - 1] +
               frame.grey[row * frame.grey_stride + frame.width - 1];
    }
    if (sum == 1) fputs("", stderr); // the pixels are read
    camera->close(handle);
  }
  pthread_join(speaker, NULL);
  close(s.listener);
}

static void watch(const uint8_t *data, size_t size) {
  static vs_frame_server *server;
  static const uint8_t picture[2 * 2 * 3];
  vs_error err = {0};
  unlink(address.sun_path);
  if (vs_frame_server_new(address.sun_path, 2, 2, 30.0, &server, &err) != VS_OK) abort();
  int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  if (fd < 0 || connect(fd, (struct sockaddr *)&address, sizeof address)) abort();
  uint8_t said[64];
  (void)!send(fd, data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (size && data[0] % 2) shutdown(fd, SHUT_WR);
  (void)!recv(fd, said, size ? data[0] % sizeof said : 0, size && data[0] % 4 == 2 ? 0 : MSG_DONTWAIT);
  for (uint32_t i = 0; i < 3; i++) vs_frame_server_put(server, picture, i, i);
  close(fd);
  vs_frame_server_free(server);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 1) return 0;
  if (data[0] % 3 == 2)
    watch(data + 1, size - 1);
  else
    view(data + 1, size - 1, data[0] % 3 == 1);
  unlink(address.sun_path);
  return 0;
}
