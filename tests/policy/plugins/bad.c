// A plugin that misbehaves as its options say ("step=segv", "init=fail", ...), or, by BAD_ at compile time, is refused.
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "vsss/player.h"

typedef struct memory {
  char options[64];
  int steps;
} memory;

static volatile int zero;

// The program has a function of this name: each must find its own.
double vs_wrap_rad(double angle_rad) { return 17.0 + angle_rad; }

static int overflow(int depth) {
  volatile char block[4096];
  block[depth % 4096] = 1;
  return overflow(depth + 1) + block[0];
}

static void misbehave(const char *how, vs_wheels *out) {
  if (!strcmp(how, "segv")) *(volatile int *)8 = 1;
  if (!strcmp(how, "fpe")) {
    zero = 1 / zero;
    raise(SIGFPE); // processors on which an integer divided by zero is no trap
  }
  if (!strcmp(how, "ill")) raise(SIGILL);
  if (!strcmp(how, "bus")) raise(SIGBUS);
  if (!strcmp(how, "abort")) abort();
  if (!strcmp(how, "overflow")) zero = overflow(0);
  while (!strcmp(how, "hang")) pause();
  if (!strcmp(how, "nan")) out[2].left_radps = NAN;
  if (!strcmp(how, "wrap")) out[2].left_radps = vs_wrap_rad(1.0);
}

static vs_status init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)seed;
  memory *m = state;
  memset(m, 0, sizeof *m);
  strncpy(m->options, options, sizeof m->options - 1);
  if (!strcmp(options, "init=fail")) {
    strcpy(err->text, "its file is missing");
    return VS_FAIL;
  }
  if (!strncmp(options, "init=", 5)) misbehave(options + 5, NULL);
  return VS_OK;
}

// Well behaved on its first two calls, or its first thirty.
static void step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels out[VS_TEAM_SIZE]) {
  (void)world, (void)game, (void)dt_s;
  memory *m = state;
  m->steps++;
  out[0].left_radps = m->steps;
  if (m->steps > 2 && !strncmp(m->options, "step=", 5)) misbehave(m->options + 5, out);
  if (m->steps > 30 && !strncmp(m->options, "late=", 5)) misbehave(m->options + 5, out); // after a second
}

static void release(void *state) {
  memory *m = state;
  if (!strncmp(m->options, "free=", 5)) misbehave(m->options + 5, NULL);
}

#ifndef BAD_VERSION
#define BAD_VERSION VSSS_PLAYER_VERSION
#endif
#ifndef BAD_RATE
#define BAD_RATE 30
#endif
#ifdef BAD_STEP
#define GIVEN_STEP NULL
#else
#define GIVEN_STEP step
#endif

static const vsss_player_api api = {BAD_VERSION, "bad", BAD_RATE, sizeof(memory), init, GIVEN_STEP, release};

#ifdef BAD_SYMBOL
void nobody_has_this(void);
void (*const needed)(void) = nobody_has_this;
#endif

#ifdef BAD_LOAD
__attribute__((constructor)) static void load(void) { misbehave("segv", NULL); }
#endif

#ifdef BAD_ENTRY
#define vsss_player team_player
#endif
const vsss_player_api *vsss_player(void) { return &api; }
