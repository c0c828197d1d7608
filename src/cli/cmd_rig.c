// vsss rig: a venue without hardware.
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "vsss/rig.h"
#include "world_csv.h"

typedef struct options {
  const char *opponent, *team, *folder, *rules, *drive, *truth, *lcm, *own_tags, *their_tags, *config;
  vs_rig_optics optics;
  double exposure_ms;
  bool white_walls;
  double seconds;
  uint64_t seed;
  int matches, width, height, rt, delay;
  bool at_once, no_lcm, help;
} options;

static const char about[] =
    "A venue without hardware, in real time: the simulator, an overhead camera, a referee that places the robots, and\n"
    "the robots' firmware behind a serial device. `vsss field` plays in it exactly as on a real field. Pictures go "
    "out\n"
    "over a Unix socket (DIR/camera): it tells each side when the other is gone and leaves nothing to clean up after "
    "a\n"
    "crash, which shared memory would. Play starts when somebody opens the camera.";

static vs_status parse(int argc, char **argv, options *o, vs_error *err) {
  *o = (options){.opponent = "random:",
                 .team = "blue",
                 .rules = "paper",
                 .drive = "contact",
                 .own_tags = "april",
                 .their_tags = "patch",
                 .seconds = 0,
                 .seed = 1,
                 .width = 640,
                 .height = 480};
  const vs_flag flags[] = {
      {"opponent", VS_FLAG_TEXT, &o->opponent, "URI", "who plays the other team", 0, 0},
      {"team", VS_FLAG_TEXT, &o->team, "TEAM", "which team has tags and radios: blue or yellow", 0, 0},
      {"seconds", VS_FLAG_REAL, &o->seconds, "S", "length of a match; 0: 120, or the league's 600", 0, 86400},
      {"matches", VS_FLAG_INT, &o->matches, "N", "then stop; 0: until Ctrl-C", 0, 1000000},
      {"rules", VS_FLAG_TEXT, &o->rules, "RULES", "paper or league", 0, 0},
      {"drive", VS_FLAG_TEXT, &o->drive, "DRIVE", "contact or planar", 0, 0},
      {"seed", VS_FLAG_SEED, &o->seed, "N", "of placements and opponents", 0, 0},
      {"width", VS_FLAG_INT, &o->width, "PX", "of the camera's pictures", 64, 3840},
      {"height", VS_FLAG_INT, &o->height, "PX", "of the camera's pictures", 64, 2160},
      {"own-tags", VS_FLAG_TEXT, &o->own_tags, "KIND", "what the own team wears: april, aruco, colour", 0, 0},
      {"their-tags", VS_FLAG_TEXT, &o->their_tags, "KIND", "what the other team wears: patch, aruco, colour", 0, 0},
      {"white-walls", VS_FLAG_SWITCH, &o->white_walls, NULL, "as LARC 2026 has them, instead of dark ones", 0, 0},
      {"noise", VS_FLAG_REAL, &o->optics.noise, "GREYS", "of the camera: its deviation in grey levels", 0, 40},
      {"uneven-light", VS_FLAG_REAL, &o->optics.uneven, "SHARE", "of the light that the darkest corner lacks", 0, 0.95},
      {"blur", VS_FLAG_REAL, &o->optics.blur_px, "PX", "deviation of the lens's blur", 0, 3},
      {"lens", VS_FLAG_REAL, &o->optics.lens_k1, "K1", "radial distortion, below 0 a barrel; calib.ini has it", -0.4,
       0.4},
      {"exposure", VS_FLAG_REAL, &o->exposure_ms, "MS", "motion blur: five pictures within it are drawn as one", 0, 33},
      {"robot-delay", VS_FLAG_INT, &o->delay, "FRAMES", "by which the own robots act late, as slow electronics do", 0,
       10},
      {"opponent-at-once", VS_FLAG_SWITCH, &o->at_once, NULL,
       "the other team acts without delay; else it waits for its commands as long as the own one does", 0, 0},
      {"dir", VS_FLAG_TEXT, &o->folder, "DIR", "where camera, radio and calib.ini are put", 0, 0},
      {"config", VS_FLAG_TEXT, &o->config, "FILE", "a field.ini: its [radio] tells the robots' numbers and key", 0, 0},
      {"truth", VS_FLAG_TEXT, &o->truth, "FILE", "write the true world of every picture as CSV", 0, 0},
      {"rt", VS_FLAG_INT, &o->rt, "PRIO", "real-time priority, such as 40, and locked memory; 0: none", 0, 99},
      {"lcm", VS_FLAG_TEXT, &o->lcm, "URL", "of VSSS_TRUTH and VSSS_REFEREE", 0, 0},
      {"no-lcm", VS_FLAG_SWITCH, &o->no_lcm, NULL, "publish nothing", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  return vs_args_parse(argc, argv, "rig [--opponent URI] [--team blue|yellow] [--seconds S] [--matches N]", about,
                       flags, NULL, &o->help, err);
}

static vs_status take_radio(const char *path, vs_rig_def *def, vs_error *err) {
  static vs_field_config config;
  vs_status s = vs_field_config_load(path, &config, err);
  if (s != VS_OK) return s;
  memcpy(def->radio_id, config.def.radio_id, sizeof def->radio_id);
  def->key = config.def.key;
  return VS_OK;
}

static vs_status fill(const options *o, const char *folder, vs_rig_def *def, vs_error *err) {
  def->opponent = o->opponent;
  def->seed = o->seed;
  def->white_walls = o->white_walls;
  def->optics = o->optics;
  def->optics.exposure_s = 1e-3 * o->exposure_ms;
  def->delay_frames = o->delay;
  def->opponent_at_once = o->at_once;
  def->width_px = o->width;
  def->height_px = o->height;
  def->folder = folder;
  def->lcm = !o->no_lcm;
  def->lcm_url = o->lcm;
  vs_rules rules;
  vs_status s = vs_cli_team("--team", o->team, &def->team, err);
  if (s == VS_OK) s = vs_mark_parse("--own-tags", o->own_tags, false, &def->own, err);
  if (s == VS_OK) s = vs_mark_parse("--their-tags", o->their_tags, true, &def->their, err);
  if (s == VS_OK && o->config) s = take_radio(o->config, def, err);
  if (s == VS_OK) s = vs_rules_parse(o->rules, &rules, err);
  if (s != VS_OK) return s;
  def->referee = vs_referee_def_default(rules);
  if (o->seconds > 0) def->referee.duration_s = o->seconds;
  return VS_OK;
}

static void print_paths(const vs_rig *rig, const vs_rig_def *def, const char *config, const char *note) {
  printf("camera  rig:%s  %dx%d, 30 pictures a second\n", vs_rig_camera_path(rig), def->width_px, def->height_px);
  printf("radio   %s\n", vs_rig_radio_path(rig));
  printf("calib   %s\n", vs_rig_calib_path(rig));
  char camera[PATH_MAX + 8], line[4 * PATH_MAX];
  snprintf(camera, sizeof camera, "rig:%s", vs_rig_camera_path(rig));
  const char *words[16] = {"field",    "--go",
                           "--team",   vs_team_name(def->team),
                           "--camera", camera,
                           "--radio",  vs_rig_radio_path(rig),
                           "--calib",  vs_rig_calib_path(rig)};
  int n = 10;
  if (def->own != VS_MARK_APRIL) words[n++] = "--own-tags", words[n++] = vs_mark_name(def->own);
  if (def->their != VS_MARK_PATCH) words[n++] = "--their-tags", words[n++] = vs_mark_name(def->their);
  if (config) words[n++] = "--config", words[n++] = config;
  vs_cli_command(vs_cli_program, n, words, line, sizeof line);
  printf("play    %s\n", line);
  printf("%swaiting for the camera to be opened\n", note);
  fflush(stdout);
}

static void print_event(const vs_rig *rig, const vs_event *event, vs_progress *progress) {
  if (event->kind == VS_EVENT_NONE) return;
  const vs_game *game = vs_rig_game(rig);
  vs_progress_clear(progress);
  printf("%6.1f s  %-9s %-6s  %d:%d\n", event->time_s, vs_event_name(event->kind), vs_team_name(event->team),
         game->score[VS_BLUE], game->score[VS_YELLOW]);
  fflush(stdout);
}

static void show_progress(vs_progress *progress, vs_rig *rig, const vs_rig_step_result *step) {
  const vs_game *game = vs_rig_game(rig);
  vs_rig_stats stats = vs_rig_get_stats(rig);
  char text[120];
  snprintf(text, sizeof text, "blue %d:%d yellow  %s  radio frames %lld", game->score[VS_BLUE], game->score[VS_YELLOW],
           !step->playing           ? "waiting"
           : stats.camera.connected ? "watched"
                                    : "nobody watches",
           (long long)stats.commands);
  vs_progress_show(progress, game->duration_s > 0 ? game->time_s / game->duration_s : 0, text);
}

static vs_status run(const options *o, vs_rig *rig, vs_error *err) {
  vs_world_csv truth;
  vs_status s = vs_world_csv_open(o->truth, &truth, err);
  if (s != VS_OK) return s;
  vs_progress progress;
  vs_progress_start(&progress);
  int over = 0;
  while (s == VS_OK && !vs_cli_interrupted() && (o->matches == 0 || over < o->matches)) {
    vs_rig_step_result step;
    s = vs_rig_step(rig, &step, err);
    if (s != VS_OK) break;
    vs_world_csv_write(&truth, &step.truth, step.event.kind);
    print_event(rig, &step.event, &progress);
    show_progress(&progress, rig, &step);
    over += step.over;
  }
  vs_progress_clear(&progress);
  vs_error at_close = {0};
  if (vs_world_csv_close(&truth, &at_close) != VS_OK && s == VS_OK) return vs_fail(err, VS_FAIL, "%s", at_close.text);
  return s;
}

static void print_summary(vs_rig *rig) {
  vs_rig_stats s = vs_rig_get_stats(rig);
  const vs_game *game = vs_rig_game(rig);
  printf("blue %d:%d yellow after %.1f s\n", game->score[VS_BLUE], game->score[VS_YELLOW], game->time_s);
  printf("ball touched %lld times, driven in %lld of %lld frames, %lld radio frames taken\n", (long long)s.touches,
         (long long)s.driven, (long long)s.frames, (long long)s.commands);
  if (s.act_s > 0) printf("a command acted %.1f ms after its bytes came, in the mean\n", 1e3 * s.act_s);
  printf("pictures: %lld sent, %lld replaced by newer ones, %lld not drawn because the machine was late\n",
         (long long)s.camera.sent, (long long)s.camera.dropped, (long long)s.late);
}

int cmd_rig(int argc, char **argv) {
  options o;
  vs_error err = {0};
  vs_drive drive;
  vs_model *model = NULL;
  vs_rig *rig = NULL;
  char folder[256], note[600];
  vs_status s = parse(argc, argv, &o, &err);
  if (s == VS_OK && o.help) return 0;
  vs_rig_default_path("", folder, sizeof folder);
  folder[strlen(folder) - 1] = '\0'; // the slash
  if (s == VS_OK) s = vs_drive_parse(o.drive, &drive, &err);
  vs_rig_def def = vs_rig_def_default(NULL);
  if (s == VS_OK) s = fill(&o, o.folder ? o.folder : folder, &def, &err);
  if (s == VS_OK && o.rt) vs_cli_realtime(o.rt);
  if (s == VS_OK) {
    vs_model_def model_def = vs_model_def_default(drive);
    s = vs_model_load(&model_def, &model, &err);
  }
  def.model = model;
  if (s == VS_OK) s = vs_rig_new(&def, &rig, note, sizeof note, &err);
  if (s == VS_OK) {
    vs_cli_catch_interrupts();
    print_paths(rig, &def, o.config, note);
    s = run(&o, rig, &err);
    print_summary(rig);
  }
  vs_rig_free(rig);
  vs_model_free(model);
  return s == VS_OK ? 0 : vs_cli_error("rig", &err);
}
