#include "vsss/render.h"

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gl_context.h"
#include "overlay.h"
#include "paint.h"
#include "shadow.h"
#include "tile.h"
#include "vsss/field.h"
#include "vsss/paths.h"

#define CAMERA_NEAR_M 0.05
// What the overhead camera must show: the goals with their walls, and the side walls.
#define CAMERA_BEHIND_GOAL_M 0.05
#define CAMERA_BESIDE_M      0.03
#define SLOTS_MOST           (VS_TEAMS * VS_TEAM_MOST + 1)

struct vs_render {
  vs_render_def def;
  char title[64];
  vs_gl_context *gl;
  mjModel *model;
  mjData *data;
  mjvScene scene;
  mjrContext context;
  bool has_context; // scene and context hold something to free
  const vs_pitch *pitch;
  int robots, mocap[SLOTS_MOST]; // the ball is in the slot after the robots
  float lamp[3];                 // where its light goes
  vs_tile_picture picture;
  uint8_t *still; // the picture without pieces, top row first: drawn once, as most of every picture is this
  uint8_t *part;  // as OpenGL gives it, bottom row first
};

vs_render_def vs_render_def_default(vs_view view) {
  bool camera = view == VS_VIEW_CAMERA;
  return (vs_render_def){
      .view = view, .width_px = camera ? 640 : 1280, .height_px = camera ? 480 : 720, .camera_height_m = 2.2};
}

static vs_status check(const vs_render_def *def, vs_error *err) {
  if (def->width_px < 64 || def->width_px > 3840 || def->height_px < 64 || def->height_px > 2160)
    return vs_fail(err, VS_USAGE, "picture of %d x %d pixels: allowed are 64x64 to 3840x2160", def->width_px,
                   def->height_px);
  if (!(def->camera_height_m >= 1.0 && def->camera_height_m <= 5.0))
    return vs_fail(err, VS_USAGE, "camera height %g m: allowed are 1 to 5", def->camera_height_m);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_MOST; i++) {
    const vs_cap *cap = &def->cap[i / VS_TEAM_MOST][i % VS_TEAM_MOST];
    if (cap->rgb && (cap->px < 1 || !(cap->size_m > 0.0 && cap->size_m <= VS_ROBOT_SIZE_M)))
      return vs_fail(err, VS_USAGE, "cap picture of %d pixels and %g m: must fit the %g m cap", cap->px, cap->size_m,
                     VS_ROBOT_SIZE_M);
  }
  return VS_OK;
}

static int team_of(const vs_render *r, int slot) { return slot / r->pitch->team_size; }
static int index_in_team(const vs_render *r, int slot) { return slot % r->pitch->team_size; }
static const vs_robot *robot_of(const vs_render *r, const vs_world *w, int slot) {
  return &w->robot[team_of(r, slot)][index_in_team(r, slot)];
}

static void piece_name(const vs_render *r, int slot, char *name, size_t size) {
  if (slot == r->robots)
    snprintf(name, size, "ball");
  else
    snprintf(name, size, "%s%d", vs_team_name((vs_team)team_of(r, slot)), index_in_team(r, slot));
}

// The texture's bytes in the model, or NULL.
static uint8_t *texture(mjModel *m, const char *name, int *width, int *height) {
  int id = mj_name2id(m, mjOBJ_TEXTURE, name);
  if (id < 0) return NULL;
  *width = m->tex_width[id];
  *height = m->tex_height[id];
  return m->tex_rgb + m->tex_adr[id];
}

static vs_status load_model(vs_render *r, vs_error *err) {
  char path[512], why[256] = "", name[16];
  const char *file = r->def.division == VS_3V3 ? "models/vsss_visual.xml" : "models/vsss_visual_5v5.xml";
  vs_status s = vs_path_find(file, path, sizeof path, err);
  if (s != VS_OK) return s;
  r->model = mj_loadXML(path, NULL, why, sizeof why);
  if (!r->model) return vs_fail(err, VS_FAIL, "%s: %s", path, why);

  int width, height;
  uint8_t *rgb = texture(r->model, "floor", &width, &height);
  if (!rgb) return vs_fail(err, VS_FAIL, "%s: no texture 'floor'", path);
  vs_paint_floor(rgb, width, height, r->pitch);
  for (int i = 0; i <= r->robots; i++) {
    piece_name(r, i, name, sizeof name);
    int body = mj_name2id(r->model, mjOBJ_BODY, name);
    r->mocap[i] = body < 0 ? -1 : r->model->body_mocapid[body];
    if (r->mocap[i] < 0) return vs_fail(err, VS_FAIL, "%s: no mocap body '%s'", path, name);
    if (i == r->robots) break;
    if (!(rgb = texture(r->model, name, &width, &height)) || width != height)
      return vs_fail(err, VS_FAIL, "%s: no square texture '%s'", path, name);
    int team = team_of(r, i), index = index_in_team(r, i);
    vs_paint_cap(rgb, width, (vs_team)team, index, r->def.view, &r->def.cap[team][index]);
  }
  return VS_OK;
}

// A venue's goals and robots' sides are dark: team colours only where a camera may look for them, on the caps.
static void darken(mjModel *m, bool white_walls) {
  static const char *const names[] = {"blue_goal", "yellow_goal", "blue_shell", "yellow_shell",
                                      "wheel",     "wall",        "hall"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    int id = mj_name2id(m, mjOBJ_MATERIAL, names[i]);
    for (int c = 0; c < 3 && id >= 0; c++)
      m->mat_rgba[4 * id + c] = white_walls && !strcmp(names[i], "wall") ? 0.9f : 0.16f;
  }
}

// The overhead camera shows each material in its own colour: even light from everywhere, no lamp, nothing costly.
static void set_quality(vs_render *r) {
  mjModel *m = r->model;
  bool camera = r->def.view == VS_VIEW_CAMERA;
  m->vis.global.offwidth = r->def.width_px;
  m->vis.global.offheight = r->def.height_px;
  m->vis.quality.offsamples = camera ? 0 : 4; // affordable for parts of a picture
  m->vis.quality.shadowsize = 0;              // shadow.h
  for (int c = 0; c < 3; c++) {
    m->vis.headlight.ambient[c] = camera ? 1.0f : 0.38f;
    m->vis.headlight.diffuse[c] = camera ? 0.0f : 0.22f;
    m->vis.headlight.specular[c] = 0.0f;
  }
  for (int i = 0; i < m->nlight; i++) m->light_active[i] = !camera;
  for (int c = 0; c < 3; c++) r->lamp[c] = (float)m->light_dir[c];
  if (camera) darken(m, r->def.white_walls);
}

static void make_scene(vs_render *r) {
  mjv_defaultScene(&r->scene);
  mjv_makeScene(r->model, &r->scene, 300);
  mjr_defaultContext(&r->context);
  int half_steps = r->def.height_px / 180; // MuJoCo's fonts come in 50 %, 100 %, ... 300 %; 200 % suits 720 rows
  mjr_makeContext(r->model, &r->context, 50 * (half_steps < 1 ? 1 : half_steps > 6 ? 6 : half_steps));
  mjr_setBuffer(mjFB_OFFSCREEN, &r->context);
  r->scene.flags[mjRND_SHADOW] = 0;
  r->scene.flags[mjRND_REFLECTION] = 0;
  r->scene.flags[mjRND_SKYBOX] = 0;
  r->scene.flags[mjRND_FOG] = 0;
  r->scene.flags[mjRND_HAZE] = 0;
  r->has_context = true;
}

vs_pinhole vs_render_pinhole(const vs_render *r) {
  double half_x_m = r->pitch->half_length_m + r->pitch->goal_depth_m + CAMERA_BEHIND_GOAL_M;
  double half_y_m = r->pitch->half_width_m + CAMERA_BESIDE_M;
  double fit_x = r->def.width_px / (2.0 * half_x_m), fit_y = r->def.height_px / (2.0 * half_y_m);
  return (vs_pinhole){.width_px = r->def.width_px,
                      .height_px = r->def.height_px,
                      .focal_px = fmin(fit_x, fit_y) * r->def.camera_height_m,
                      .cx_px = 0.5 * r->def.width_px,
                      .cy_px = 0.5 * r->def.height_px,
                      .height_m = r->def.camera_height_m};
}

static void put(vs_render *r, int slot, bool shown, double x_m, double y_m, double z_m, double theta_rad) {
  mjtNum *pos = r->data->mocap_pos + 3 * r->mocap[slot], *quat = r->data->mocap_quat + 4 * r->mocap[slot];
  pos[0] = x_m;
  pos[1] = y_m;
  pos[2] = shown ? z_m : -9.0; // under the hall's floor
  quat[0] = cos(0.5 * theta_rad);
  quat[1] = quat[2] = 0.0;
  quat[3] = sin(0.5 * theta_rad);
}

static void put_world(vs_render *r, const vs_world *w) {
  for (int i = 0; i < r->robots; i++) {
    const vs_robot *robot = robot_of(r, w, i);
    put(r, i, robot->valid, robot->pose.x_m, robot->pose.y_m, 0.0, robot->pose.theta_rad);
  }
  put(r, r->robots, w->ball.valid, w->ball.x_m, w->ball.y_m, w->ball.z_m, 0.0);
  mj_kinematics(r->model, r->data);
  mj_comPos(r->model, r->data);
  mj_camlight(r->model, r->data);
}

static mjvGLCamera overhead(const vs_render *r) {
  vs_pinhole p = vs_render_pinhole(r);
  float half = (float)(CAMERA_NEAR_M * 0.5 * p.height_px / p.focal_px);
  return (mjvGLCamera){.pos = {0, 0, (float)p.height_m},
                       .forward = {0, 0, -1},
                       .up = {0, 1, 0},
                       .frustum_bottom = -half,
                       .frustum_top = half,
                       .frustum_near = (float)CAMERA_NEAR_M,
                       .frustum_far = 10.0f};
}

static void add_shadows(vs_render *r, const vs_world *w) {
  vs_shadow_add_walls(&r->scene, r->lamp);
  const mjtNum cube[3] = {0.5 * VS_ROBOT_SIZE_M, 0.5 * VS_ROBOT_SIZE_M, 0.5 * VS_ROBOT_SIZE_M};
  for (int i = 0; i < r->robots; i++) {
    const vs_robot *robot = robot_of(r, w, i);
    if (!robot->valid) continue;
    mjtNum centre[3] = {robot->pose.x_m, robot->pose.y_m, 0.5 * VS_ROBOT_SIZE_M};
    mjtNum c = cos(robot->pose.theta_rad), s = sin(robot->pose.theta_rad), turn[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    vs_shadow_add(&r->scene, mjGEOM_BOX, cube, centre, turn, r->lamp);
  }
  if (!w->ball.valid) return;
  const mjtNum ball[3] = {VS_BALL_RADIUS_M, VS_BALL_RADIUS_M, VS_BALL_RADIUS_M},
               upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  mjtNum centre[3] = {w->ball.x_m, w->ball.y_m, w->ball.z_m};
  vs_shadow_add(&r->scene, mjGEOM_SPHERE, ball, centre, upright, r->lamp);
}

static void set_scene(vs_render *r, const vs_world *world) {
  put_world(r, world);
  mjvOption option;
  mjvCamera camera;
  mjv_defaultOption(&option);
  mjv_defaultCamera(&camera);
  double larger = r->pitch->half_length_m / VS_FIELD_HALF_LENGTH_M; // than the field of 3 against 3
  camera.lookat[1] = -0.03 * larger;
  camera.distance = 1.78 * larger;
  camera.azimuth = 90;
  camera.elevation = -60;
  mjv_updateScene(r->model, r->data, &option, NULL, &camera, mjCAT_ALL, &r->scene);
  bool broadcast = r->def.view == VS_VIEW_BROADCAST;
  if (broadcast) add_shadows(r, world);
  mjvGLCamera eye = broadcast ? mjv_averageCamera(&r->scene.camera[0], &r->scene.camera[1]) : overhead(r);
  r->picture = (vs_tile_picture){eye, r->def.width_px, r->def.height_px};
}

// Reads what the context holds of part of the picture from (left, bottom) on, into its place in rgb.
static void read_part(vs_render *r, int left, int bottom, mjrRect part, uint8_t *rgb) {
  mjr_readPixels(r->part, NULL, (mjrRect){left, bottom, part.width, part.height}, &r->context);
  size_t row_bytes = (size_t)part.width * 3;
  for (int row = 0; row < part.height; row++) {
    size_t from_top = (size_t)(r->def.height_px - 1 - part.bottom - row);
    memcpy(rgb + (from_top * (size_t)r->def.width_px + (size_t)part.left) * 3, r->part + (size_t)row * row_bytes,
           row_bytes);
  }
}

static void draw_part(vs_render *r, mjrRect part, uint8_t *rgb) {
  if (!part.width) return;
  r->scene.camera[0] = r->scene.camera[1] = vs_tile_camera(&r->picture, part);
  mjr_render((mjrRect){0, 0, part.width, part.height}, &r->scene, &r->context);
  read_part(r, 0, 0, part, rgb);
}

static void draw_still(vs_render *r) {
  const vs_world empty = {.division = r->def.division};
  set_scene(r, &empty);
  draw_part(r, (mjrRect){0, 0, r->def.width_px, r->def.height_px}, r->still);
}

static void draw_piece(vs_render *r, bool valid, double x_m, double y_m, double low_m, double high_m, double radius_m,
                       uint8_t *rgb) {
  if (!valid) return;
  const float low[3] = {(float)(x_m - radius_m), (float)(y_m - radius_m), (float)low_m};
  const float high[3] = {(float)(x_m + radius_m), (float)(y_m + radius_m), (float)high_m};
  draw_part(r, vs_tile_around(&r->picture, low, high, r->def.view == VS_VIEW_BROADCAST ? r->lamp : NULL), rgb);
}

void vs_render_set_title(vs_render *r, const char *title) {
  snprintf(r->title, sizeof r->title, "%s", title ? title : "");
}

vs_status vs_render_new(const vs_render_def *def, vs_render **out, vs_error *err) {
  *out = NULL;
  vs_status s = check(def, err);
  if (s != VS_OK) return s;
  vs_render *r = calloc(1, sizeof *r);
  if (!r) return vs_fail(err, VS_FAIL, "out of memory");
  r->def = *def;
  r->pitch = vs_pitch_of(def->division);
  r->robots = VS_TEAMS * r->pitch->team_size;
  vs_render_set_title(r, def->title);
  size_t bytes = (size_t)def->width_px * def->height_px * 3;
  r->still = malloc(bytes);
  r->part = malloc(bytes);
  if (!r->still || !r->part) s = vs_fail(err, VS_FAIL, "out of memory");
  if (s == VS_OK) s = load_model(r, err);
  if (s == VS_OK) s = vs_gl_context_new(&r->gl, err);
  if (s == VS_OK && !vs_gl_context_bind(r->gl)) s = vs_fail(err, VS_FAIL, "EGL refuses its own OpenGL context");
  if (s != VS_OK) {
    vs_render_free(r);
    return s;
  }
  r->data = mj_makeData(r->model);
  set_quality(r);
  make_scene(r);
  draw_still(r);
  vs_gl_context_release(r->gl);
  memset(r->def.cap, 0, sizeof r->def.cap); // the caller's
  *out = r;
  return VS_OK;
}

void vs_render_free(vs_render *r) {
  if (!r) return;
  if (r->has_context) {
    vs_gl_context_bind(r->gl);
    mjr_freeContext(&r->context);
    mjv_freeScene(&r->scene);
  }
  vs_gl_context_free(r->gl);
  if (r->data) mj_deleteData(r->data);
  if (r->model) mj_deleteModel(r->model);
  free(r->still);
  free(r->part);
  free(r);
}

vs_status vs_render_world(vs_render *r, const vs_world *world, const vs_game *game, uint8_t *rgb, vs_error *err) {
  if (world->division != r->def.division)
    return vs_fail(err, VS_FAIL, "a world of %s for a renderer of %s", vs_pitch_of(world->division)->name,
                   r->pitch->name);
  if (!vs_gl_context_bind(r->gl)) return vs_fail(err, VS_FAIL, "the renderer's context is in use by another thread");
  set_scene(r, world);
  memcpy(rgb, r->still, (size_t)r->def.width_px * r->def.height_px * 3);
  for (int i = 0; i < r->robots; i++) {
    const vs_robot *robot = robot_of(r, world, i);
    draw_piece(r, robot->valid, robot->pose.x_m, robot->pose.y_m, 0.0, VS_ROBOT_SIZE_M, VS_ROBOT_SIZE_M * M_SQRT1_2,
               rgb);
  }
  const vs_ball *ball = &world->ball;
  draw_piece(r, ball->valid, ball->x_m, ball->y_m, ball->z_m - VS_BALL_RADIUS_M, ball->z_m + VS_BALL_RADIUS_M,
             VS_BALL_RADIUS_M, rgb);
  if (game && r->def.view == VS_VIEW_BROADCAST) {
    mjrRect drawn[VS_OVERLAY_LABELS];
    int labels =
        vs_render_overlay(&r->context, (mjrRect){0, 0, r->def.width_px, r->def.height_px}, game, r->title, drawn);
    for (int i = 0; i < labels; i++) read_part(r, drawn[i].left, drawn[i].bottom, drawn[i], rgb);
  }
  vs_gl_context_release(r->gl);
  return VS_OK;
}
