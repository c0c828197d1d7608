// Built in place of gl_context.c where the EGL headers are missing.
#include "gl_context.h"

#include <stddef.h>

vs_status vs_gl_context_new(vs_gl_context **out, vs_error *err) {
  *out = NULL;
  return vs_fail(err, VS_FAIL, "built without EGL, which draws pictures; install libegl-dev and run make again");
}
void vs_gl_context_free(vs_gl_context *context) { (void)context; }
int vs_gl_context_bind(vs_gl_context *context) {
  (void)context;
  return 0;
}
void vs_gl_context_release(vs_gl_context *context) { (void)context; }
