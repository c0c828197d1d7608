// EGL is opened when a picture is first asked for, so that the program starts on a machine without it.
#include "gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <stdlib.h>

#define INSTALL "install libegl1 and libgl1-mesa-dri"

typedef EGLDisplay (*get_platform_display_fn)(EGLenum, void *, const EGLint *);

// The functions used of libEGL.so.1.
typedef struct egl {
  EGLDisplay (*get_display)(EGLNativeDisplayType);
  __eglMustCastToProperFunctionPointerType (*get_proc_address)(const char *);
  EGLBoolean (*initialize)(EGLDisplay, EGLint *, EGLint *);
  EGLBoolean (*bind_api)(EGLenum);
  EGLBoolean (*choose_config)(EGLDisplay, const EGLint *, EGLConfig *, EGLint, EGLint *);
  EGLContext (*create_context)(EGLDisplay, EGLConfig, EGLContext, const EGLint *);
  EGLBoolean (*make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
  EGLBoolean (*destroy_context)(EGLDisplay, EGLContext);
  EGLint (*get_error)(void);
} egl;

struct vs_gl_context {
  egl api;
  EGLDisplay display;
  EGLContext context;
};

static vs_status load(egl *api, vs_error *err) {
  // Never closed: the driver leaves threads and exit handlers behind.
  void *library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
  if (!library) return vs_fail(err, VS_FAIL, "drawing pictures needs EGL (%s); " INSTALL, dlerror());
  const struct {
    const char *name;
    void *target;
  } symbols[] = {
      {"eglGetDisplay", &api->get_display},     {"eglGetProcAddress", &api->get_proc_address},
      {"eglInitialize", &api->initialize},      {"eglBindAPI", &api->bind_api},
      {"eglChooseConfig", &api->choose_config}, {"eglCreateContext", &api->create_context},
      {"eglMakeCurrent", &api->make_current},   {"eglDestroyContext", &api->destroy_context},
      {"eglGetError", &api->get_error},
  };
  for (size_t i = 0; i < sizeof symbols / sizeof *symbols; i++) {
    *(void **)symbols[i].target = dlsym(library, symbols[i].name);
    if (!*(void **)symbols[i].target) return vs_fail(err, VS_FAIL, "libEGL.so.1 lacks %s; " INSTALL, symbols[i].name);
  }
  return VS_OK;
}

// Mesa's surfaceless platform needs neither X nor a graphics card; other drivers offer only their default display.
static EGLDisplay open_display(const egl *api) {
  get_platform_display_fn get = (get_platform_display_fn)(void *)api->get_proc_address("eglGetPlatformDisplayEXT");
  EGLDisplay display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
  if (display != EGL_NO_DISPLAY && api->initialize(display, NULL, NULL)) return display;
  display = api->get_display(EGL_DEFAULT_DISPLAY);
  return display != EGL_NO_DISPLAY && api->initialize(display, NULL, NULL) ? display : EGL_NO_DISPLAY;
}

vs_status vs_gl_context_new(vs_gl_context **out, vs_error *err) {
  *out = NULL;
  egl api;
  vs_status s = load(&api, err);
  if (s != VS_OK) return s;
  EGLDisplay display = open_display(&api);
  if (display == EGL_NO_DISPLAY) return vs_fail(err, VS_FAIL, "EGL finds no driver to draw with; " INSTALL);

  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config;
  EGLint found = 0;
  if (!api.bind_api(EGL_OPENGL_API) || !api.choose_config(display, wanted, &config, 1, &found) || found < 1)
    return vs_fail(err, VS_FAIL, "EGL offers no OpenGL (error 0x%x); " INSTALL, (unsigned)api.get_error());
  EGLContext context = api.create_context(display, config, EGL_NO_CONTEXT, NULL);
  if (context == EGL_NO_CONTEXT)
    return vs_fail(err, VS_FAIL, "EGL gives no OpenGL context (error 0x%x); " INSTALL, (unsigned)api.get_error());

  vs_gl_context *c = malloc(sizeof *c);
  if (!c) return vs_fail(err, VS_FAIL, "out of memory");
  *c = (vs_gl_context){.api = api, .display = display, .context = context};
  *out = c;
  return VS_OK;
}

int vs_gl_context_bind(vs_gl_context *c) {
  return c->api.bind_api(EGL_OPENGL_API) && c->api.make_current(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, c->context);
}

void vs_gl_context_release(vs_gl_context *c) {
  c->api.make_current(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void vs_gl_context_free(vs_gl_context *c) {
  if (!c) return;
  vs_gl_context_release(c);
  c->api.destroy_context(c->display, c->context);
  free(c);
}
