// Tests src/cli/cmd_view.c, src/view/web.c and deploy/view/index.html: the page by plain HTTP and in a headless browser.
#include <arpa/inet.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/view.h"

static int port;

static pid_t start(const char *flags) {
  char arguments[1024], output[128];
  snprintf(arguments, sizeof arguments, "view %s --port %d", flags, port);
  snprintf(output, sizeof output, "%s/view", folder);
  return vsss_start(output, arguments);
}

static void stop(pid_t child) {
  int status = vsss_finish(child, SIGINT);
  if (status != 0) fail_msg("view ended with %d: %s", status, folder_file("view"));
}

// The answer to a request, headers and all; waits for the server.
static size_t ask(const char *request, char *out, size_t size) {
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int fd = -1;
  for (int k = 0; k < 2600; k++) {
    fd = socket(AF_INET, SOCK_STREAM, 0);
    if (connect(fd, (const struct sockaddr *)&at, sizeof at) == 0) break;
    close(fd);
    fd = -1;
    usleep(k < 2000 ? 20 : 50000);
  }
  assert_true(fd >= 0);
  assert_int_equal(write(fd, request, strlen(request)), strlen(request));
  size_t used = 0;
  for (ssize_t n; used + 1 < size && (n = read(fd, out + used, size - 1 - used)) > 0;) used += (size_t)n;
  close(fd);
  out[used] = '\0';
  return used;
}

static void make_log(void) {
  vsss_run run;
  char command[256];
  snprintf(command, sizeof command,
           "sim --blue emc: --yellow inf: --seconds 20 --drive planar --lcm 'file://%s/log?mode=w'", folder);
  vsss(&run, command);
  if (run.status != 0) fail_msg("%s", run.err);
}

static char answer[4 << 20];

static void *ask_at_once(void *out) {
  ask("GET / HTTP/1.0\r\n\r\n", out, 4096);
  return NULL;
}

// Who asks while the server is starting gets the page, not "not found".
static void the_first_request_is_answered(void **state) {
  (void)state;
  char page[128], early[4][4096];
  snprintf(page, sizeof page, "%s/page.html", folder);
  FILE *f = fopen(page, "w");
  assert_non_null(f);
  fputs("<canvas>", f);
  fclose(f);
  for (int k = 0; k < 3; k++) {
    pthread_t asker[4];
    for (int i = 0; i < 4; i++) assert_int_equal(pthread_create(&asker[i], NULL, ask_at_once, early[i]), 0);
    vs_view *view;
    assert_ok(vs_view_open(page, "", 0, "127.0.0.1", port, &view, err));
    for (int i = 0; i < 4; i++) pthread_join(asker[i], NULL);
    vs_view_close(view);
    for (int i = 0; i < 4; i++)
      if (!strstr(early[i], " 200 ")) fail_msg("answered: %s", early[i]);
  }
}

// 20 s at 30 Hz: 601 worlds, each with six robots.
static void a_log_is_served_as_a_page_and_its_frames(void **state) {
  (void)state;
  char flags[256];
  make_log();
  snprintf(flags, sizeof flags, "'%s/log'", folder);
  pid_t view = start(flags);
  ask("GET / HTTP/1.0\r\n\r\n", answer, sizeof answer);
  assert_non_null(strstr(answer, " 200 "));
  assert_non_null(strstr(answer, "<canvas"));
  assert_null(strstr(answer, "src=")); // no outside scripts
  ask("GET /data.json HTTP/1.0\r\n\r\n", answer, sizeof answer);
  int frames = 0;
  for (const char *at = strstr(answer, "frames"); at && (at = strstr(at, "\n[")) != NULL; at++) frames++;
  assert_in_range(frames, 590, 620);
  ask("GET /etc/passwd HTTP/1.0\r\n\r\n", answer, sizeof answer);
  assert_non_null(strstr(answer, " 404 "));
  stop(view);
}

// Of 5 against 5: the first frame holds ten robots, each "[1,x,y,heading,left,right]".
static void a_log_of_five_against_five_shows_ten_robots(void **state) {
  (void)state;
  vsss_run run;
  char command[256], flags[256];
  snprintf(command, sizeof command,
           "sim --division 5v5 --blue emc: --yellow inf: --seconds 2 --drive planar --lcm 'file://%s/five?mode=w'",
           folder);
  vsss(&run, command);
  if (run.status != 0) fail_msg("%s", run.err);
  snprintf(flags, sizeof flags, "'%s/five'", folder);
  pid_t view = start(flags);
  ask("GET /data.json HTTP/1.0\r\n\r\n", answer, sizeof answer);
  stop(view);
  const char *frame = strstr(answer, "\n["), *end = frame ? strchr(frame + 2, '\n') : NULL;
  assert_non_null(end);
  int robots = 0;
  for (const char *c = frame + 2; c < end; c++) robots += c[0] == '[' && c[1] == '1' && c[2] == ',';
  assert_int_equal(robots, 10);
}

static bool has_browser(char *name, size_t size) {
  FILE *f = popen("command -v chromium-headless-shell || command -v chromium", "r");
  bool found = fgets(name, (int)size, f) != NULL;
  pclose(f);
  name[strcspn(name, "\n")] = '\0';
  return found;
}

// The browser runs the page: it counts the frames into its title, complains of nothing, and draws something.
static void a_browser_shows_the_log_without_complaint(void **state) {
  (void)state;
  char browser[256], flags[256], command[1024];
  if (!has_browser(browser, sizeof browser)) {
    print_message("note: skipped: no chromium (apt install chromium-headless-shell)\n");
    skip();
  }
  snprintf(flags, sizeof flags, "'%s/log'", folder);
  pid_t view = start(flags);
  ask("GET / HTTP/1.0\r\n\r\n", answer, sizeof answer);
  const char *const common = "--headless --no-sandbox --disable-gpu --window-size=1400,1200 --virtual-time-budget=4000 "
                             "--enable-logging=stderr";
  snprintf(command, sizeof command,
           "HOME='%s' timeout 100 '%s' %s --user-data-dir='%s/chrome' --dump-dom http:'//'127.0.0.1:%d 2>'%s/console'",
           folder, browser, common, folder, port, folder);
  FILE *f = popen(command, "r");
  answer[fread(answer, 1, sizeof answer - 1, f)] = '\0';
  pclose(f);
  const char *title = strstr(answer, "<title>vsss view ");
  if (!title || atoi(title + 17) < 590) fail_msg("title: %.60s", title ? title : answer);
  assert_non_null(strstr(answer, "blue 0"));
  snprintf(command, sizeof command, "grep 'CONSOLE' '%s/console'", folder);
  f = popen(command, "r");
  answer[fread(answer, 1, 2000, f)] = '\0';
  pclose(f);
  if (*answer) fail_msg("the page complains: %s", answer);
  stop(view);
}

// A WebSocket by hand: the handshake, then text frames of the server, which are not masked.
static void a_live_match_comes_over_the_websocket(void **state) {
  (void)state;
  char binary[4096], command[8192], flags[128];
  const char *url = "udpm://239.255.76.91:7791?ttl=0";
  snprintf(flags, sizeof flags, "--live --lcm '%s'", url);
  pid_t view = start(flags);
  ask("GET /data.json HTTP/1.0\r\n\r\n", answer, sizeof answer);
  assert_non_null(strstr(answer, "\"live\": true"));
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "exec '%s' sim --realtime --lcm '%s' --blue emc: --yellow inf: --seconds 600",
           binary, url);
  pid_t sim = fork();
  if (sim == 0) {
    if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(126);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
  }
  // Ends after the first 20000 bytes, some 60 frames.
  static char part[20000];
  ask("GET /live HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n",
      part, sizeof part);
  kill(sim, SIGINT);
  waitpid(sim, NULL, 0);
  stop(view);
  assert_non_null(strstr(part, " 101 "));
  assert_non_null(strstr(part, "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=")); // RFC 6455's answer to that key
  int frames = 0;
  const char *end = part + sizeof part - 1, *at = strstr(part, "\r\n\r\n") + 4;
  while (at + 4 < end && (unsigned char)at[0] == 0x81 && at[1] == 126) {
    size_t length = (size_t)(unsigned char)at[2] << 8 | (unsigned char)at[3];
    if (at + 4 + length > end) break;
    assert_true(at[4] == '[' && at[3 + length] == ']');
    at += 4 + length;
    frames++;
  }
  assert_true(frames > 20);
}

static void what_cannot_be_shown_is_refused(void **state) {
  (void)state;
  char command[256];
  assert_refused("view", 2, "give a log");
  assert_refused("view --live x", 2, "give a log");
  assert_refused("view /nowhere/log", 1, "/nowhere/log");
  snprintf(command, sizeof command, "view '%s/log' --address 10.255.255.1", folder);
  assert_refused(command, 1, "10.255.255.1");
}

int main(void) {
  port = 20000 + (int)(getpid() % 10000);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_first_request_is_answered),
      cmocka_unit_test(a_log_is_served_as_a_page_and_its_frames),
      cmocka_unit_test(a_log_of_five_against_five_shows_ten_robots),
      cmocka_unit_test(a_browser_shows_the_log_without_complaint),
      cmocka_unit_test(a_live_match_comes_over_the_websocket),
      cmocka_unit_test(what_cannot_be_shown_is_refused),
  };
  vs_view *unused = NULL;
  vs_error err = {0};
  if (vs_view_open("/nowhere", "", 0, "127.0.0.1", port, &unused, &err) != VS_OK && strstr(err.text, "libcivetweb")) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
