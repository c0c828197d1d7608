// vsss sim: matches between two players, watched or as fast as they go.
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "json_text.h"
#include "message_text.h"
#include "report.h"
#include "vsss/clock.h"
#include "watch.h"

// LISTENERS_PACE: how many times real time a match goes that others listen to over UDP. At full speed a logger on the same
// machine lost two messages in three; at this pace (1,800 a second) none.
enum { MAX_WATCHERS = 4, LISTENERS_PACE = 10 };

typedef struct sim_command {
  vs_match_flags match;
  const char *uri[VS_TEAMS];
  int matches, only; // only: --match, 0: all
  vs_flag_list name;
  bool realtime, json;
  const char *lcm, *video;

  vs_env_def env;
  vs_watcher watcher[MAX_WATCHERS];
  int watchers;
  vs_match_result *results;
  vs_progress progress;
  int done;
  bool events_shown;
  int pace; // times real time; 0: as fast as it goes
  int64_t pace_start_us, paced_frames;
} sim_command;

// The terminal: events as lines, score and clock as one line that rewrites itself.

static void print_event(const vs_event *event, const vs_referee *referee) {
  const vs_game *game = &referee->game;
  char text[64];
  vs_event_text(event, text, sizeof text);
  printf("%7.2f s  %s", event->time_s, text);
  if (event->kind == VS_EVENT_GOAL || event->kind == VS_EVENT_END)
    printf("  %d : %d", game->score[VS_BLUE], game->score[VS_YELLOW]);
  if (referee->half == VS_HALF_SHOOT_OUT)
    printf("  (%d : %d of %d, %d kicks)", referee->kicks_scored[VS_BLUE], referee->kicks_scored[VS_YELLOW],
           referee->kicks[VS_BLUE], referee->kicks[VS_YELLOW]);
  printf("\n");
  fflush(stdout);
}

static const char *name_of(const sim_command *c, int team) {
  return team < c->name.count ? c->name.value[team] : c->uri[team];
}

static vs_status show_frame(void *state, const vs_watch_view *view, vs_error *err) {
  (void)err;
  sim_command *c = state;
  const vs_game *game = vs_env_game(view->env);
  if (c->events_shown && view->event->kind != VS_EVENT_NONE) {
    vs_progress_clear(&c->progress);
    print_event(view->event, vs_env_referee(view->env));
  }
  char text[160];
  snprintf(text, sizeof text, "%s %d : %d %s  %5.1f s", name_of(c, VS_BLUE), game->score[VS_BLUE],
           game->score[VS_YELLOW], name_of(c, VS_YELLOW), game->time_s);
  vs_progress_show(&c->progress, (view->match + game->time_s / game->duration_s) / c->matches, text);
  return VS_OK;
}

// A frame every 1/30 s of the wall clock, times the pace.
static vs_status keep_pace(void *state, const vs_watch_view *view, vs_error *err) {
  (void)view;
  (void)err;
  sim_command *c = state;
  if (c->paced_frames == 0) c->pace_start_us = vs_clock_monotonic_us();
  vs_clock_sleep_until_us(c->pace_start_us + c->paced_frames * 1000000 / (c->pace * VS_CAMERA_HZ));
  c->paced_frames++;
  return VS_OK;
}

// UDP drops what a listener has no room for, and neither end hears of it; files and this process's own memory wait.
static int pace_of(const sim_command *c) {
  if (c->realtime) return 1;
  return c->lcm && !strncmp(c->lcm, "udpm", 4) ? LISTENERS_PACE : 0;
}

// Opens what was asked for. A default bus without a multicast route is told and left out.
static vs_status open_watchers(sim_command *c, vs_error *err) {
  vs_status s = VS_OK;
  if (c->lcm || c->realtime) {
    s = vs_watch_bus(c->lcm, c->uri, &c->watcher[c->watchers], err);
    if (s == VS_OK) {
      c->watchers++;
    } else if (!c->lcm) {
      fprintf(stderr, "vsss sim: nothing is published: %s\n", err->text);
      s = VS_OK;
    }
  }
  if (s == VS_OK && c->video) {
    char title[128];
    snprintf(title, sizeof title, "%s  %s", name_of(c, VS_BLUE), name_of(c, VS_YELLOW));
    s = vs_watch_video(c->video, title, vs_model_division(c->env.model), &c->watcher[c->watchers], err);
    if (s == VS_OK) c->watchers++;
  }
  c->pace = pace_of(c);
  if (s == VS_OK && c->pace) c->watcher[c->watchers++] = (vs_watcher){c, keep_pace, NULL};
  if (s == VS_OK && c->pace == LISTENERS_PACE)
    fprintf(stderr,
            "vsss sim: %d times real time, so that listeners keep up; a file takes all at full speed: --lcm "
            "'file://PATH?mode=w'\n",
            LISTENERS_PACE);
  return s;
}

static vs_status close_watchers(sim_command *c, vs_status s, vs_error *err) {
  for (int i = 0; i < c->watchers; i++) {
    if (!c->watcher[i].close) continue;
    vs_status closed = c->watcher[i].close(c->watcher[i].state, s == VS_OK ? err : NULL);
    if (s == VS_OK) s = closed;
  }
  return s;
}

static vs_status tell_watchers(sim_command *c, vs_env *env, int match, const vs_event *event, vs_error *err) {
  const vs_watch_view view = {env, match, event};
  for (int i = 0; i < c->watchers; i++) {
    vs_status s = c->watcher[i].frame(c->watcher[i].state, &view, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

// One match, frame by frame, under the eyes of the watchers. The result holds what was played, even after Ctrl-C.
static vs_status play_watched(sim_command *c, vs_env *env, int match, vs_error *err) {
  vs_match_result *r = &c->results[match];
  r->seed = vs_seed_mix(c->match.seed, (uint64_t)(c->only ? c->only - 1 : match));
  vs_status s = vs_env_reset(env, r->seed, err);
  vs_event event = {.kind = VS_EVENT_KICK_OFF, .team = VS_BLUE};
  vs_idle idle = {0};
  if (s == VS_OK) s = tell_watchers(c, env, match, &event, err);
  while (s == VS_OK && !vs_env_over(env) && !vs_cli_interrupted()) {
    s = vs_env_frame(env, &event, err);
    if (s != VS_OK) break;
    vs_match_watch(r, &idle, env, &event);
    s = tell_watchers(c, env, match, &event, err);
  }
  vs_match_end(env, r);
  return s;
}

static void print_head(const sim_command *c) {
  if (c->json) return;
  char about[160];
  vs_match_flags_describe(&c->match, about, sizeof about);
  printf("%s (blue) against %s (yellow): %s", name_of(c, VS_BLUE), name_of(c, VS_YELLOW), about);
  if (c->only) printf(", match %d", c->only);
  printf("\n\n");
  fflush(stdout);
}

static vs_status play_one_after_another(sim_command *c, vs_error *err) {
  c->watcher[c->watchers++] = (vs_watcher){c, show_frame, NULL};
  c->events_shown = c->matches == 1 && !c->json;
  vs_status s = open_watchers(c, err);
  vs_env *env = NULL;
  if (s == VS_OK) s = vs_env_new(&c->env, &env, err);
  if (s == VS_OK) print_head(c);
  for (; s == VS_OK && c->done < c->matches && !vs_cli_interrupted(); c->done++) s = play_watched(c, env, c->done, err);
  vs_env_free(env);
  return close_watchers(c, s, err);
}

static bool match_done(void *context, int index, const vs_match_result *result) {
  (void)index;
  sim_command *c = context;
  c->done++;
  char text[160];
  snprintf(text, sizeof text, "%d of %d matches, last %d : %d", c->done, c->matches, result->score[VS_BLUE],
           result->score[VS_YELLOW]);
  vs_progress_show(&c->progress, (double)c->done / c->matches, text);
  return !vs_cli_interrupted();
}

static vs_status play_over_threads(sim_command *c, vs_error *err) {
  print_head(c);
  vs_series_def def = {.env = c->env,
                       .matches = c->matches,
                       .threads = c->match.threads,
                       .seed = c->match.seed,
                       .progress = match_done,
                       .go_on = vs_cli_go_on,
                       .context = c};
  return vs_series_play(&def, c->results, err);
}

static void print_match(const sim_command *c, double wall_s) {
  const vs_match_result *r = &c->results[0];
  printf("\n%-12s %10s %10s\n", "", "blue", "yellow");
  printf("%-12s ", "player");
  vs_report_name(stdout, name_of(c, VS_BLUE), -10);
  printf(" ");
  vs_report_name(stdout, name_of(c, VS_YELLOW), -10);
  printf("\n");
  printf("%-12s %10d %10d\n", "goals", r->score[VS_BLUE], r->score[VS_YELLOW]);
  printf("%-12s %10d %10d\n", "penalties", r->events[VS_BLUE][VS_EVENT_PENALTY],
         r->events[VS_YELLOW][VS_EVENT_PENALTY]);
  vs_rules rules = c->env.referee.rules;
  if (rules != VS_RULES_PAPER)
    printf("%-12s %10d %10d\n", "goal kicks", r->events[VS_BLUE][VS_EVENT_GOAL_KICK],
           r->events[VS_YELLOW][VS_EVENT_GOAL_KICK]);
  if (rules == VS_RULES_SERIE_A_2023 || rules == VS_RULES_LARC_2026)
    printf("%-12s %10d %10d\n", "free kicks", r->events[VS_BLUE][VS_EVENT_FREE_KICK],
           r->events[VS_YELLOW][VS_EVENT_FREE_KICK]);
  printf("%-12s %10d\n", "free balls",
         r->events[VS_BLUE][VS_EVENT_FREE_BALL] + r->events[VS_YELLOW][VS_EVENT_FREE_BALL]);
  if (r->half == VS_HALF_SHOOT_OUT)
    printf("%-12s %10d %10d\n", "shoot-out", r->shoot_out[VS_BLUE], r->shoot_out[VS_YELLOW]);
  if (c->match.knockout && r->played)
    printf("\n%s wins%s\n", vs_team_name((vs_team)vs_match_winner(r)),
           r->lot                         ? " by lot"
           : r->half == VS_HALF_SHOOT_OUT ? " the shoot-out"
           : r->half >= VS_HALF_EXTRA_1   ? " in extra time"
                                          : "");
  for (int t = 0; t < VS_TEAMS; t++) vs_report_idle(stdout, name_of(c, t), r->idle_warnings[t], r->idle_sent_off[t]);
  printf("\n%s%.1f s played in %.2f s (%.0f times real time), hash %016" PRIx64 "\n",
         r->played ? "" : "stopped: ", r->time_s, wall_s, r->time_s / wall_s, r->hash);
}

static void print_series(const sim_command *c, const vs_series_summary *summary, double wall_s) {
  vs_report_table_head(stdout);
  vs_report_table_row(stdout, name_of(c, VS_YELLOW), summary);
  printf("\n");
  vs_report_restarts_head(stdout);
  vs_report_restarts_row(stdout, name_of(c, VS_YELLOW), summary);
  vs_report_knockout(stdout, name_of(c, VS_YELLOW), summary);
  for (int t = 0; t < VS_TEAMS; t++)
    vs_report_idle(stdout, name_of(c, t), summary->idle_warnings[t], summary->idle_sent_off[t]);
  double played_s = summary->mean_time_s * summary->matches;
  if (summary->matches < c->matches) printf("\nstopped: %d of %d matches\n", summary->matches, c->matches);
  printf("\n%.0f s played in %.1f s (%.0f times real time)\n", played_s, wall_s, played_s / wall_s);
}

static void print_json(const sim_command *c, const vs_series_summary *summary, double wall_s) {
  printf("{\"command\": \"sim\", \"blue\": ");
  vs_json_put(stdout, c->uri[VS_BLUE]);
  printf(", \"yellow\": ");
  vs_json_put(stdout, c->uri[VS_YELLOW]);
  printf(", ");
  vs_report_json_flags(stdout, &c->match);
  printf(", \"complete\": %s, \"wall_s\": %.3f,\n \"summary\": ", summary->matches == c->matches ? "true" : "false",
         wall_s);
  vs_report_json_summary(stdout, summary);
  printf(",\n \"matches\": ");
  vs_report_json_matches(stdout, c->results, c->matches);
  printf("}\n");
}

static vs_status play(sim_command *c, vs_error *err) {
  int64_t start_us = vs_clock_monotonic_us();
  vs_progress_start(&c->progress);
  bool watched = c->matches == 1 || c->realtime || c->lcm || c->video;
  vs_status s = watched ? play_one_after_another(c, err) : play_over_threads(c, err);
  vs_progress_clear(&c->progress);
  double wall_s = (double)(vs_clock_monotonic_us() - start_us) * 1e-6;
  vs_series_summary summary;
  if (s == VS_OK) s = vs_series_sum_up(c->results, c->matches, &summary, err);
  if (s != VS_OK) return s;
  if (c->json)
    print_json(c, &summary, wall_s);
  else if (c->matches == 1)
    print_match(c, wall_s);
  else
    print_series(c, &summary, wall_s);
  return VS_OK;
}

// Our policy, unless this build or this checkout cannot play it.
static const char *default_blue(void) {
  vs_player *player = NULL;
  vs_error why = {0};
  vs_status s = vs_player_open("onnx:", &player, &why);
  vs_player_close(player);
  if (s == VS_OK) return "onnx:";
  fprintf(stderr, "vsss sim: emc: plays blue: %s\n", why.text);
  return "emc:";
}

// Of the scripted players the one that has the largest share of the goals against our policy (release.md).
#define DEFAULT_YELLOW "emc22:"

int cmd_sim(int argc, char **argv) {
  sim_command c = {.match = vs_match_flags_default(), .uri = {NULL, DEFAULT_YELLOW}, .matches = 1};
  const vs_flag flags[] = {
      {"blue", VS_FLAG_TEXT, &c.uri[VS_BLUE], "URI", "player that attacks +x [onnx:, our policy; 5v5: emc:]", 0, 0},
      {"yellow", VS_FLAG_TEXT, &c.uri[VS_YELLOW], "URI", "player that attacks -x", 0, 0},
      {"matches", VS_FLAG_INT, &c.matches, "N", "how many", 1, 1000000},
      {"match", VS_FLAG_INT, &c.only, "K", "only match K of the series that --seed begins, as it was; 0: all", 0,
       1000000},
      {"name", VS_FLAG_LIST, &c.name, "NAME", "what tables and video call blue; given again, yellow", 0, 0},
      VS_MATCH_FLAG_ROWS(c.match),
      {"realtime", VS_FLAG_SWITCH, &c.realtime, NULL, "at the pace of the clock, published over LCM", 0, 0},
      {"lcm", VS_FLAG_TEXT, &c.lcm, "URL",
       "publish there: udpm://239.255.76.67:7667?ttl=1 (at 10 times real time), file://PATH?mode=w", 0, 0},
      {"video", VS_FLAG_TEXT, &c.video, "FILE", "write an MP4 of the matches", 0, 0},
      {"json", VS_FLAG_SWITCH, &c.json, NULL, "one JSON object on standard output, nothing else", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  bool help;
  vs_error err = {0};
  char about[2048];
  vs_match_flags_about("Plays matches between two players in the simulator, as fast as they go.", about, sizeof about);
  vs_status s = vs_args_parse(argc, argv, "sim [flags]", about, flags, NULL, &help, &err);
  if (help) return 0;
  if (s == VS_OK && c.name.count > VS_TEAMS) s = vs_fail(&err, VS_USAGE, "--name: given more than twice");
  if (s == VS_OK && c.only && c.matches > 1)
    s = vs_fail(&err, VS_USAGE, "--match plays one match: leave --matches out");
  vs_model *model = NULL;
  if (s == VS_OK) s = vs_match_flags_open(&c.match, &model, &c.env, &err);
  // Our policy is 3 against 3's.
  bool threes = s == VS_OK && vs_model_division(model) == VS_3V3;
  if (s == VS_OK && !c.uri[VS_BLUE]) c.uri[VS_BLUE] = threes ? default_blue() : "emc:";
  if (s == VS_OK) {
    for (int t = 0; t < VS_TEAMS; t++) c.env.player[t] = c.uri[t];
    c.results = calloc((size_t)c.matches, sizeof *c.results);
    if (!c.results) s = vs_fail(&err, VS_FAIL, "out of memory for %d matches", c.matches);
  }
  vs_cli_catch_interrupts();
  if (s == VS_OK) s = play(&c, &err);
  free(c.results);
  vs_model_free(model);
  return s == VS_OK ? 0 : vs_cli_error("sim", &err);
}
