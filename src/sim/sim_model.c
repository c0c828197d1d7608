// Loads the MJCF, finds its parts by name and checks them against field.h and division.h.
#include "drive.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/word.h"
#include "mujoco_call.h"
#include "vsss/field.h"
#include "vsss/paths.h"

// Chosen by the agreement table of bench_sim: see tests/bench/bench_sim.c.
#define CONTACT_SUBSTEPS 5
#define PLANAR_SUBSTEPS  5

const char *vs_mujoco_version(void) { return mj_versionString(); }

static const char *const drive_names[] = {"contact", "planar", NULL};

const char *vs_drive_name(vs_drive drive) { return drive_names[drive]; }

vs_status vs_drive_parse(const char *name, vs_drive *out, vs_error *err) {
  int drive;
  vs_status s = vs_word_parse("drive", name, drive_names, &drive, err);
  if (s == VS_OK) *out = (vs_drive)drive;
  return s;
}

vs_model_def vs_model_def_default(vs_drive drive) { return (vs_model_def){.drive = drive}; }

// One load at a time: MuJoCo's parser keeps the last model's text in a global.
static pthread_mutex_t parser = PTHREAD_MUTEX_INITIALIZER;

typedef struct load_work {
  const char *path;
  mjModel *mj;
  char text[400];
} load_work;

static void load_xml(void *context) {
  load_work *work = context;
  work->mj = mj_loadXML(work->path, NULL, work->text, sizeof work->text);
  mj_freeLastXML();
}

static vs_status load_file(const char *path, mjModel **out, vs_error *err) {
  load_work work = {.path = path};
  pthread_mutex_lock(&parser);
  vs_status status = vs_mujoco_call(load_xml, &work, err);
  pthread_mutex_unlock(&parser);
  if (status != VS_OK) return vs_fail_prefix(err, "%s", path);
  *out = work.mj;
  if (work.mj) return VS_OK;
  for (char *c = work.text; *c; c++) {
    if (*c == '\n') *c = ' ';
  }
  return vs_fail(err, VS_FAIL, "%s: not a MuJoCo model: %s", path, work.text);
}

// A part by type and name; "robot" and "suffix" make names such as blue0_left.
static vs_status find(const mjModel *mj, const char *path, mjtObj type, const char *kind, const char *name, int *id,
                      vs_error *err) {
  *id = mj_name2id(mj, type, name);
  if (*id >= 0) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: no %s named '%s': use a model made for this program", path, kind, name);
}

static vs_status expect(const char *path, const char *name, const char *what, double value, double expected,
                        double tolerance, vs_error *err) {
  if (fabs(value - expected) <= tolerance) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: %s: %s is %g, but the program expects %g", path, name, what, value, expected);
}

#define TRY(call)                                                                                                      \
  do {                                                                                                                 \
    vs_status try_status = (call);                                                                                     \
    if (try_status != VS_OK) return try_status;                                                                        \
  } while (0)

static vs_status find_joint(const mjModel *mj, const char *path, const char *name, int type, int *qpos, int *qvel,
                            vs_error *err) {
  int id;
  TRY(find(mj, path, mjOBJ_JOINT, "joint", name, &id, err));
  if (mj->jnt_type[id] != type) {
    return vs_fail(err, VS_FAIL, "%s: joint '%s' has type %d, expected %d", path, name, mj->jnt_type[id], type);
  }
  if (qpos) *qpos = mj->jnt_qposadr[id];
  if (qvel) *qvel = mj->jnt_dofadr[id];
  return VS_OK;
}

static vs_status bind_wheel(vs_model *model, const char *path, robot_address *robot, const char *robot_name, int side,
                            vs_error *err) {
  const mjModel *mj = model->mj;
  char name[40];
  snprintf(name, sizeof name, "%s_%s", robot_name, side == LEFT ? "left" : "right");
  int geom, servo;
  TRY(find_joint(mj, path, name, mjJNT_HINGE, NULL, &robot->wheel_qvel[side], err));
  TRY(find(mj, path, mjOBJ_GEOM, "geom", name, &geom, err));
  TRY(find(mj, path, mjOBJ_ACTUATOR, "actuator", name, &servo, err));
  TRY(expect(path, name, "wheel radius", mj->geom_size[3 * geom], VS_WHEEL_RADIUS_M, 1e-9, err));
  const double *place = mj->body_pos + 3 * mj->geom_bodyid[geom];
  double half_track = side == LEFT ? VS_HALF_TRACK_M : -VS_HALF_TRACK_M;
  TRY(expect(path, name, "distance from the middle", place[1], half_track, 1e-9, err));
  TRY(expect(path, name, "axle height", place[2], VS_WHEEL_RADIUS_M, 1e-9, err));
  robot->servo[side] = servo;
  const double *limit = mj->actuator_forcerange + 2 * servo;
  TRY(expect(path, name, "servo gain", mj->actuator_gainprm[mjNGAIN * servo], VS_SERVO_GAIN_NMSPRAD, 1e-9, err));
  TRY(expect(path, name, "servo speed gain", -mj->actuator_biasprm[mjNBIAS * servo + 2], VS_SERVO_GAIN_NMSPRAD, 1e-9,
             err));
  TRY(expect(path, name, "torque limit", limit[1], VS_SERVO_LIMIT_NM, 1e-9, err));
  TRY(expect(path, name, "torque limit backwards", -limit[0], VS_SERVO_LIMIT_NM, 1e-9, err));
  TRY(expect(path, name, "rotor inertia", mj->dof_armature[robot->wheel_qvel[side]], ROTOR_INERTIA_KGM2, 1e-12, err));
  return VS_OK;
}

static vs_status bind_robot(vs_model *model, const char *path, int index, vs_error *err) {
  const mjModel *mj = model->mj;
  robot_address *robot = &model->robot[index];
  char name[32], joint[40];
  snprintf(name, sizeof name, "%s%d", vs_team_name((vs_team)team_of(model, index)), index_in_team(model, index));
  TRY(find(mj, path, mjOBJ_BODY, "body", name, &robot->body, err));
  if (model->drive == VS_DRIVE_CONTACT) {
    TRY(find_joint(mj, path, name, mjJNT_FREE, &robot->qpos, &robot->qvel, err));
    for (int side = LEFT; side < SIDES; side++) TRY(bind_wheel(model, path, robot, name, side, err));
  } else {
    static const struct {
      const char *suffix;
      int type;
    } part[3] = {{"x", mjJNT_SLIDE}, {"y", mjJNT_SLIDE}, {"yaw", mjJNT_HINGE}};
    for (int i = 2; i >= 0; i--) { // last: x, whose address is the first of three
      snprintf(joint, sizeof joint, "%s_%s", name, part[i].suffix);
      TRY(find_joint(mj, path, joint, part[i].type, &robot->qpos, &robot->qvel, err));
    }
  }
  int hull;
  TRY(find(mj, path, mjOBJ_GEOM, "geom", name, &hull, err));
  const double *half = mj->geom_size + 3 * hull;
  TRY(expect(path, name, "half length", half[0], VS_ROBOT_SIZE_M / 2, 1e-9, err));
  TRY(expect(path, name, "half width", half[1], VS_ROBOT_SIZE_M / 2, 1e-9, err));
  TRY(expect(path, name, "height", mj->geom_pos[3 * hull + 2] + half[2], VS_ROBOT_HEIGHT_M, 1e-9, err));
  return expect(path, name, "mass", mj->body_subtreemass[robot->body], VS_ROBOT_MASS_KG, 1e-9, err);
}

// The inner face of a wall plane, and the corner of the blocks beside the goal mouths.
static vs_status check_field(const mjModel *mj, const vs_pitch *field, const char *path, vs_error *err) {
  const double goal_end = field->half_length_m + field->goal_depth_m, corner = field->corner_m / 2;
  const double corner_x = field->half_length_m - corner, corner_y = field->half_width_m - corner;
  const double end_y = (field->half_width_m + field->goal_half_width_m) / 2;
  const struct {
    const char *name;
    double x, y;
  } wall[] = {
      {"wall_left", 0, field->half_width_m},
      {"wall_right", 0, -field->half_width_m},
      {"goal_blue", -goal_end, 0},
      {"goal_yellow", goal_end, 0},
      {"corner_1", corner_x, corner_y},
      {"corner_2", -corner_x, corner_y},
      {"corner_3", -corner_x, -corner_y},
      {"corner_4", corner_x, -corner_y},
      {"end_1", goal_end, end_y},
      {"end_2", -goal_end, end_y},
      {"end_3", -goal_end, -end_y},
      {"end_4", goal_end, -end_y},
  };
  for (size_t i = 0; i < sizeof wall / sizeof *wall; i++) {
    int geom;
    TRY(find(mj, path, mjOBJ_GEOM, "geom", wall[i].name, &geom, err));
    TRY(expect(path, wall[i].name, "x", mj->geom_pos[3 * geom], wall[i].x, 1e-9, err));
    TRY(expect(path, wall[i].name, "y", mj->geom_pos[3 * geom + 1], wall[i].y, 1e-9, err));
    if (mj->geom_type[geom] != mjGEOM_BOX) continue;
    const double *half = mj->geom_size + 3 * geom;
    TRY(expect(path, wall[i].name, "half depth", half[0], field->goal_depth_m, 1e-9, err));
    TRY(expect(path, wall[i].name, "half width", half[1], (field->half_width_m - field->goal_half_width_m) / 2, 1e-9,
               err));
  }
  return VS_OK;
}

// Frictions that both drives must share: MuJoCo's contacts here, drive.h's numbers in the planar drive.
static vs_status check_floor_contacts(const mjModel *mj, const char *path, vs_error *err) {
  int floor, ball;
  TRY(find(mj, path, mjOBJ_GEOM, "geom", "floor", &floor, err));
  TRY(find(mj, path, mjOBJ_GEOM, "geom", "ball", &ball, err));
  for (int pair = 0; pair < mj->npair; pair++) {
    int other = mj->pair_geom1[pair] == floor ? mj->pair_geom2[pair] : mj->pair_geom1[pair];
    if (mj->pair_geom1[pair] != floor && mj->pair_geom2[pair] != floor) continue;
    const double *friction = mj->pair_friction + 5 * pair;
    const char *name = mj_id2name(mj, mjOBJ_GEOM, other);
    if (other == ball) {
      TRY(expect(path, name, "sliding friction", friction[0], BALL_FRICTION, 1e-9, err));
      TRY(expect(path, name, "rolling friction", friction[3], BALL_ROLLING_M, 1e-9, err));
    } else if (mj->pair_dim[pair] > 1) { // a wheel; skids have none
      TRY(expect(path, name, "friction", friction[0], WHEEL_FRICTION, 1e-9, err));
    }
  }
  return VS_OK;
}

static vs_status bind(vs_model *model, const char *path, vs_error *err) {
  const mjModel *mj = model->mj;
  TRY(check_field(mj, model->field, path, err));
  int geom;
  TRY(find(mj, path, mjOBJ_GEOM, "geom", "ball", &geom, err));
  TRY(find(mj, path, mjOBJ_BODY, "body", "ball", &model->ball_body, err));
  if (model->drive == VS_DRIVE_CONTACT) {
    TRY(find_joint(mj, path, "ball", mjJNT_FREE, &model->ball_qpos, &model->ball_qvel, err));
    TRY(check_floor_contacts(mj, path, err));
  } else {
    TRY(find_joint(mj, path, "ball", mjJNT_BALL, NULL, NULL, err));
    TRY(find_joint(mj, path, "ball_y", mjJNT_SLIDE, NULL, NULL, err));
    TRY(find_joint(mj, path, "ball_x", mjJNT_SLIDE, &model->ball_qpos, &model->ball_qvel, err));
  }
  TRY(expect(path, "ball", "radius", mj->geom_size[3 * geom], VS_BALL_RADIUS_M, 1e-9, err));
  TRY(expect(path, "ball", "mass", mj->body_mass[model->ball_body], VS_BALL_MASS_KG, 1e-9, err));
  for (int i = 0; i < model->robots; i++) TRY(bind_robot(model, path, i, err));
  if (mj->npair > PAIRS_MOST)
    return vs_fail(err, VS_FAIL, "%s: %d contact pairs, at most %d", path, mj->npair, PAIRS_MOST);
  return VS_OK;
}

vs_status vs_model_load(const vs_model_def *def, vs_model **out, vs_error *err) {
  char path[512], relative[64];
  if (def->path) {
    snprintf(path, sizeof path, "%s", def->path);
  } else {
    snprintf(relative, sizeof relative, "models/vsss_%s%s%s.xml", vs_drive_name(def->drive),
             def->division == VS_3V3 ? "" : "_", def->division == VS_3V3 ? "" : vs_pitch_of(def->division)->name);
    TRY(vs_path_find(relative, path, sizeof path, err));
  }
  if (def->substeps_per_frame < 0 || def->substeps_per_frame > 1000) {
    return vs_fail(err, VS_USAGE, "%d physics steps per frame: use 1 to 1000, or 0 for the default",
                   def->substeps_per_frame);
  }
  if (def->frame_hz < 0 || def->frame_hz > 1000)
    return vs_fail(err, VS_USAGE, "%d frames per second: use 1 to 1000, or 0 for the camera's", def->frame_hz);
  if (def->drive == VS_DRIVE_PLANAR) vs_outline_install();
  vs_model *model = calloc(1, sizeof *model);
  if (!model) return vs_fail(err, VS_FAIL, "out of memory");
  model->drive = def->drive;
  model->division = def->division;
  model->field = vs_pitch_of(def->division);
  model->robots = VS_TEAMS * model->field->team_size;
  model->frame_hz = def->frame_hz ? def->frame_hz : VS_CAMERA_HZ;
  model->substeps = def->substeps_per_frame;
  if (!model->substeps) model->substeps = def->drive == VS_DRIVE_PLANAR ? PLANAR_SUBSTEPS : CONTACT_SUBSTEPS;
  vs_status status = load_file(path, &model->mj, err);
  if (status == VS_OK) status = bind(model, path, err);
  if (status != VS_OK) {
    vs_model_free(model);
    return status;
  }
  model->mj->opt.timestep = 1.0 / model->frame_hz / model->substeps;
  vs_nearby_bind(model);
  *out = model;
  return VS_OK;
}

void vs_model_free(vs_model *model) {
  if (!model) return;
  if (model->mj) mj_deleteModel(model->mj);
  free(model);
}

double vs_model_step_s(const vs_model *model) { return model->mj->opt.timestep; }
int vs_model_frame_hz(const vs_model *model) { return model->frame_hz; }
int vs_model_substeps(const vs_model *model) { return model->substeps; }
vs_drive vs_model_drive(const vs_model *model) { return model->drive; }
vs_division vs_model_division(const vs_model *model) { return model->division; }
const void *vs_model_mjmodel(const vs_model *model) { return model->mj; }
