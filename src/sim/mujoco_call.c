#include "mujoco_call.h"

#include <assert.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdio.h>

#include <mujoco/mujoco.h>

// MuJoCo's handlers are process-wide function pointers without a context, so where to return to is kept per thread.
typedef struct rescue {
  jmp_buf jump;
  char text[300];
} rescue;
static _Thread_local rescue *active;

static void on_error(const char *text) {
  assert(active && "a MuJoCo function that failed was called outside vs_mujoco_call"); // it must not return
  snprintf(active->text, sizeof active->text, "%s", text);
  longjmp(active->jump, 1);
}

static void on_warning(const char *text) { (void)text; }

static void install_handlers(void) {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
}

vs_status vs_mujoco_call(void (*work)(void *context), void *context, vs_error *err) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, install_handlers);
  rescue here;
  if (setjmp(here.jump)) {
    active = NULL;
    return vs_fail(err, VS_FAIL, "MuJoCo: %s", here.text);
  }
  active = &here;
  work(context);
  active = NULL;
  return VS_OK;
}
