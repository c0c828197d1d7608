// The text spy: who sends what, how often, and what it said last.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli.h"
#include "message_text.h"
#include "spy.h"
#include "vsss/clock.h"

enum { CHANNELS_MAX = 64, LAST_MAX = 400 };

typedef struct row {
  char name[64];
  int64_t messages, bytes;             // since the start
  int64_t shown_messages, shown_bytes; // at the last table
  char last[LAST_MAX];
} row;

typedef struct spy {
  row rows[CHANNELS_MAX];
  int n;
  vs_message message;
  uint8_t image[VS_BUS_IMAGE_MAX];
} spy;

static void hear(const char *channel, const uint8_t *data, size_t size, int64_t utime_us, void *user) {
  (void)utime_us;
  spy *s = user;
  if (!strcmp(channel, "LCM_SELF_TEST")) return; // LCM's own, when somebody starts to listen
  int i = 0;
  while (i < s->n && strcmp(s->rows[i].name, channel) != 0) i++;
  if (i == CHANNELS_MAX) return;
  row *r = &s->rows[i];
  if (i == s->n) {
    snprintf(r->name, sizeof r->name, "%s", channel);
    s->n++;
  }
  r->messages++;
  r->bytes += (int64_t)size;
  vs_channel which;
  vs_error err = {0};
  if (!vs_channel_parse(channel, &which) || strcmp(vs_channel_name(which), channel) != 0)
    snprintf(r->last, sizeof r->last, "%zu bytes, not of vsss", size);
  else if (vs_message_decode(which, data, size, &s->message, s->image, &err) == VS_OK)
    vs_message_text(&s->message, r->last, sizeof r->last);
  else
    snprintf(r->last, sizeof r->last, "%s", err.text);
  vs_text_clean(r->last);
}

static int compare(const void *a, const void *b) { return strcmp(((const row *)a)->name, ((const row *)b)->name); }

// since_s: over what time the rates are; cut: width of the terminal, 0: whole lines.
static void print_table(spy *s, double since_s, bool since_start, int cut) {
  qsort(s->rows, (size_t)s->n, sizeof s->rows[0], compare);
  printf("%-18s %9s %7s %8s  %s\n", "channel", "messages", "Hz", "kB/s", "last");
  for (int i = 0; i < s->n; i++) {
    row *r = &s->rows[i];
    double messages = (double)(r->messages - (since_start ? 0 : r->shown_messages));
    double bytes = (double)(r->bytes - (since_start ? 0 : r->shown_bytes));
    char line[LAST_MAX + 64];
    snprintf(line, sizeof line, "%-18s %9lld %7.1f %8.2f  %s", r->name, (long long)r->messages, messages / since_s,
             bytes / since_s * 1e-3, r->last);
    vs_text_clean(line);
    printf("%.*s\n", cut > 0 ? cut : (int)sizeof line, line);
    r->shown_messages = r->messages;
    r->shown_bytes = r->bytes;
  }
  if (s->n == 0) printf("(nothing heard yet)\n");
  fflush(stdout);
}

static int terminal_width(void) {
  struct winsize size;
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

// On a terminal the table is drawn over itself; into a file or pipe every table is kept, or only the last where the time
// is limited.
static vs_status listen(vs_bus *bus, spy *s, double seconds, vs_error *err) {
  bool terminal = isatty(STDOUT_FILENO);
  int64_t start_us = vs_clock_monotonic_us(), last_us = start_us, now_us = start_us;
  int64_t end_us = start_us + (int64_t)(seconds * 1e6);
  while (!vs_cli_interrupted() && (seconds == 0.0 || now_us < end_us)) {
    int64_t wait_us = last_us + 1000000 - now_us;
    if (seconds > 0.0 && end_us - now_us < wait_us) wait_us = end_us - now_us;
    vs_status status = vs_bus_handle(bus, wait_us > 0 ? (int)(wait_us / 1000) + 1 : 0, NULL, err);
    if (status != VS_OK) return status;
    now_us = vs_clock_monotonic_us();
    if (now_us - last_us < 1000000) continue;
    if (terminal)
      printf("\033[H\033[J%s, %.0f s; Ctrl-C ends\n\n", vs_bus_url(bus), (double)(now_us - start_us) * 1e-6);
    if (terminal || seconds == 0.0)
      print_table(s, (double)(now_us - last_us) * 1e-6, false, terminal ? terminal_width() : 0);
    last_us = now_us;
  }
  if (!terminal && seconds > 0.0) print_table(s, (double)(now_us - start_us) * 1e-6, true, 0);
  return VS_OK;
}

vs_status spy_print(const char *url, double seconds, vs_error *err) {
  vs_bus *bus;
  vs_status status = vs_bus_open(url, &bus, err);
  if (status != VS_OK) return status;
  spy *s = calloc(1, sizeof *s);
  status = s ? vs_bus_subscribe_raw(bus, NULL, hear, s, err) : vs_fail(err, VS_FAIL, "out of memory");
  vs_cli_catch_interrupts();
  if (status == VS_OK) status = listen(bus, s, seconds, err);
  free(s);
  vs_bus_close(bus);
  return status;
}
