// An OpenGL context without a window (EGL, Mesa's surfaceless platform or the default display's).
#ifndef VSSS_RENDER_GL_CONTEXT_H
#define VSSS_RENDER_GL_CONTEXT_H

#include "vsss/status.h"

typedef struct vs_gl_context vs_gl_context;

vs_status vs_gl_context_new(vs_gl_context **out, vs_error *err);
void vs_gl_context_free(vs_gl_context *context); // NULL is allowed
// Binds the context to the calling thread until released; false: the driver refused.
int vs_gl_context_bind(vs_gl_context *context);
void vs_gl_context_release(vs_gl_context *context);

#endif
