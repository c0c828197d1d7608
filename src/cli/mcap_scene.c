#include "mcap_scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "vsss/field.h"

// docs.foxglove.dev, message schemas: SceneUpdate, SceneEntity, CubePrimitive, SpherePrimitive, ArrowPrimitive.
#define NUMBER             "{\"type\":\"number\"}"
#define OBJECT(properties) "{\"type\":\"object\",\"properties\":{" properties "}}"
#define ARRAY(items)       "{\"type\":\"array\",\"items\":" items "}"
#define XYZ                "\"x\":" NUMBER ",\"y\":" NUMBER ",\"z\":" NUMBER
#define POSE               OBJECT("\"position\":" OBJECT(XYZ) ",\"orientation\":" OBJECT(XYZ ",\"w\":" NUMBER))
#define COLOR              OBJECT("\"r\":" NUMBER ",\"g\":" NUMBER ",\"b\":" NUMBER ",\"a\":" NUMBER)
#define SOLID              ARRAY(OBJECT("\"pose\":" POSE ",\"size\":" OBJECT(XYZ) ",\"color\":" COLOR))
#define ARROWS                                                                                                         \
  ARRAY(OBJECT("\"pose\":" POSE ",\"shaft_length\":" NUMBER ",\"shaft_diameter\":" NUMBER ",\"head_length\":" NUMBER   \
               ",\"head_diameter\":" NUMBER ",\"color\":" COLOR))
#define TIME OBJECT("\"sec\":{\"type\":\"integer\"},\"nsec\":{\"type\":\"integer\"}")

const char mcap_scene_schema[] = OBJECT("\"deletions\":" ARRAY("{\"type\":\"object\"}") ",\"entities\":" ARRAY(
    OBJECT("\"timestamp\":" TIME ",\"frame_id\":{\"type\":\"string\"},\"id\":{\"type\":\"string\"},\"lifetime\":" TIME
           ",\"frame_locked\":{\"type\":\"boolean\"},\"cubes\":" SOLID ",\"spheres\":" SOLID ",\"arrows\":" ARROWS)));

typedef struct text {
  char *out;
  size_t used;
} text;

static void add(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(text *t, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(t->out + t->used, MCAP_SCENE_JSON_MAX - t->used, format, list);
  va_end(list);
  if (n > 0) t->used += (size_t)n;
  if (t->used >= MCAP_SCENE_JSON_MAX) t->used = MCAP_SCENE_JSON_MAX - 1;
}

static void begin_entity(text *t, const char *id, uint64_t time_ns) {
  add(t,
      "{\"timestamp\":{\"sec\":%" PRIu64 ",\"nsec\":%" PRIu64 "},\"frame_id\":\"field\",\"id\":\"%s\","
      "\"lifetime\":{\"sec\":0,\"nsec\":0},\"frame_locked\":false,",
      time_ns / 1000000000, time_ns % 1000000000, id);
}

static void add_pose(text *t, double x_m, double y_m, double z_m, double theta_rad) {
  add(t,
      "\"pose\":{\"position\":{\"x\":%.4f,\"y\":%.4f,\"z\":%.4f},\"orientation\":{\"x\":0,\"y\":0,\"z\":%.5f,"
      "\"w\":%.5f}}",
      x_m, y_m, z_m, sin(theta_rad / 2), cos(theta_rad / 2));
}

typedef struct colour {
  double r, g, b;
} colour;
static void add_colour(text *t, colour c) { add(t, ",\"color\":{\"r\":%g,\"g\":%g,\"b\":%g,\"a\":1}}", c.r, c.g, c.b); }

static void add_solid(text *t, const vs_pose *p, double z_m, double x_size_m, double y_size_m, double z_size_m,
                      colour c) {
  add(t, "{");
  add_pose(t, p->x_m, p->y_m, z_m, p->theta_rad);
  add(t, ",\"size\":{\"x\":%g,\"y\":%g,\"z\":%g}", x_size_m, y_size_m, z_size_m);
  add_colour(t, c);
}

static void add_robots(text *t, const vs_world *w, uint64_t time_ns) {
  static const colour of[VS_TEAMS] = {{0.1, 0.3, 1}, {1, 0.85, 0.1}};
  const colour white = {1, 1, 1};
  int cubes = 0, arrows = 0;
  begin_entity(t, "robots", time_ns);
  add(t, "\"cubes\":[");
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0, n = vs_team_size(w); i < n; i++) {
      const vs_robot *r = &w->robot[team][i];
      if (!r->valid) continue;
      add(t, "%s", cubes++ ? "," : "");
      add_solid(t, &r->pose, VS_ROBOT_SIZE_M / 2, VS_ROBOT_SIZE_M, VS_ROBOT_SIZE_M, VS_ROBOT_SIZE_M, of[team]);
    }
  add(t, "],\"arrows\":["); // where they look, on their lids
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0, n = vs_team_size(w); i < n; i++) {
      const vs_robot *r = &w->robot[team][i];
      if (!r->valid) continue;
      add(t, "%s{", arrows++ ? "," : "");
      add_pose(t, r->pose.x_m, r->pose.y_m, VS_ROBOT_SIZE_M + 0.005, r->pose.theta_rad);
      add(t, ",\"shaft_length\":0.03,\"shaft_diameter\":0.01,\"head_length\":0.02,\"head_diameter\":0.02");
      add_colour(t, white);
    }
  add(t, "]}");
}

static void add_ball(text *t, const vs_ball *b, uint64_t time_ns) {
  const vs_pose at = {b->x_m, b->y_m, 0};
  const colour orange = {1, 0.45, 0};
  begin_entity(t, "ball", time_ns);
  add(t, "\"spheres\":[");
  if (b->valid) add_solid(t, &at, b->z_m, 2 * VS_BALL_RADIUS_M, 2 * VS_BALL_RADIUS_M, 2 * VS_BALL_RADIUS_M, orange);
  add(t, "]}");
}

static void add_field(text *t, const vs_pitch *pitch, uint64_t time_ns) {
  const colour floor = {0.1, 0.1, 0.1}, goal = {0.3, 0.3, 0.3};
  const double thick_m = 0.002, goal_x_m = pitch->half_length_m + pitch->goal_depth_m / 2;
  begin_entity(t, "field", time_ns);
  add(t, "\"cubes\":[");
  add_solid(t, &(vs_pose){0, 0, 0}, -thick_m / 2, 2 * pitch->half_length_m, 2 * pitch->half_width_m, thick_m, floor);
  for (int side = -1; side <= 1; side += 2) {
    add(t, ",");
    add_solid(t, &(vs_pose){side * goal_x_m, 0, 0}, -thick_m / 2, pitch->goal_depth_m, 2 * pitch->goal_half_width_m,
              thick_m, goal);
  }
  add(t, "]}");
}

void mcap_scene(const vs_world *w, uint64_t time_ns, bool with_field, char out[MCAP_SCENE_JSON_MAX]) {
  text t = {out, 0};
  add(&t, "{\"deletions\":[],\"entities\":[");
  if (with_field) {
    add_field(&t, vs_pitch_of(w->division), time_ns);
    add(&t, ",");
  }
  add_robots(&t, w, time_ns);
  add(&t, ",");
  add_ball(&t, &w->ball, time_ns);
  add(&t, "]}");
}
