// Pictures for a binding.
#include <stdlib.h>
#include <stdio.h>

#include "capi_internal.h"
#include "vsss/render.h"

struct vs_capi_render {
  capi_guard guard;
  vs_render *render;
  size_t bytes; // of a picture
};

int vs_capi_render_new(int width_px, int height_px, const char *title, vs_capi_render **out, char *error,
                       size_t error_size) {
  vs_error err = {0};
  vs_capi_render *r = calloc(1, sizeof *r);
  if (!r) return vs_capi_told(vs_fail(&err, VS_FAIL, "out of memory"), &err, error, error_size);
  vs_capi_guard_init(&r->guard);
  vs_render_def def = vs_render_def_default(VS_VIEW_BROADCAST);
  def.width_px = width_px;
  def.height_px = height_px;
  def.title = title;
  vs_status s = vs_render_new(&def, &r->render, &err);
  r->bytes = (size_t)width_px * (size_t)height_px * 3;
  if (s == VS_OK)
    *out = r;
  else
    free(r);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_render_free(vs_capi_render *r, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = r ? vs_capi_enter(&r->guard, &err) : VS_OK;
  if (r && s == VS_OK) {
    vs_render_free(r->render);
    free(r);
  }
  return vs_capi_told(s, &err, error, error_size);
}

static vs_status draw(vs_capi_render *r, const vs_world *world, const vs_game *game, uint8_t *rgb, size_t bytes,
                      vs_error *err) {
  vs_status s = vs_capi_enter(&r->guard, err);
  if (s != VS_OK) return s;
  if (bytes != r->bytes)
    s = vs_fail(err, VS_USAGE, "%zu bytes for a picture of %zu", bytes, r->bytes);
  else
    s = vs_render_world(r->render, world, game, rgb, err);
  vs_capi_leave(&r->guard);
  return s;
}

int vs_capi_render_vec(vs_capi_render *r, vs_capi_vec *vec, int env, uint8_t *rgb, size_t bytes, char *error,
                       size_t error_size) {
  vs_error err = {0};
  vs_world world;
  vs_game game;
  vs_status s = vs_capi_vec_picture(vec, env, &world, &game, &err);
  if (s == VS_OK) s = draw(r, &world, &game, rgb, bytes, &err);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_render_vss(vs_capi_render *r, vs_capi_vss *vss, int env, uint8_t *rgb, size_t bytes, char *error,
                       size_t error_size) {
  vs_error err = {0};
  vs_world world;
  vs_game game;
  vs_status s = vs_capi_vss_picture(vss, env, &world, &game, &err);
  if (s == VS_OK) s = draw(r, &world, &game, rgb, bytes, &err);
  return vs_capi_told(s, &err, error, error_size);
}
