#include "match_flags.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

vs_match_flags vs_match_flags_default(void) {
  long processors = sysconf(_SC_NPROCESSORS_ONLN);
  return (vs_match_flags){.division = "3v3",
                          .drive = "contact",
                          .rules = "paper",
                          .placement = "paper",
                          .predicts = "learned",
                          .seed = 1,
                          .threads = processors > 0 ? (int)processors : 1};
}

vs_status vs_match_flags_open(vs_match_flags *flags, vs_model **model, vs_env_def *env, vs_error *err) {
  vs_division division;
  vs_drive drive;
  vs_rules rules;
  vs_placement_mode placement;
  vs_realism realism = vs_realism_default();
  vs_predicts predicts;
  vs_status s = vs_division_parse(flags->division, &division, err);
  if (s == VS_OK) s = vs_drive_parse(flags->drive, &drive, err);
  if (s == VS_OK) s = vs_rules_parse(flags->rules, &rules, err);
  if (s == VS_OK) s = vs_placement_parse(flags->placement, &placement, err);
  if (s == VS_OK) s = vs_predicts_parse(flags->predicts, &predicts, err);
  if (s == VS_OK && flags->realism) s = vs_realism_load(flags->realism, &realism, err);
  if (s != VS_OK) return s;

  vs_model_def model_def = vs_model_def_default(drive);
  model_def.division = division;
  s = vs_model_load(&model_def, model, err);
  if (s != VS_OK) return s;
  *env = vs_env_def_default(*model);
  env->referee = vs_referee_def_default(rules);
  env->referee.placement = placement;
  if (flags->seconds > 0) vs_referee_def_lasts(&env->referee, flags->seconds);
  env->referee.knockout = flags->knockout;
  flags->seconds = env->referee.duration_s;
  env->realism = realism;
  env->predicts = predicts;
  return VS_OK;
}

void vs_match_flags_about(const char *about, char *out, size_t size) {
  const char *scheme, *help;
  size_t used = (size_t)snprintf(out, size, "%s\n\nPlayers (URI):", about);
  for (int i = 0; used < size && vs_player_scheme(i, &scheme, &help); i++)
    used += (size_t)snprintf(out + used, size - used, "\n  %-10s %s", scheme, help);
}

void vs_match_flags_describe(const vs_match_flags *flags, char *out, size_t size) {
  bool threes = !strcmp(flags->division, "3v3");
  snprintf(out, size, "%s%s%s drive, %s rules%s, %s placement, %g s, seed %" PRIu64 "%s%s",
           threes ? "" : flags->division, threes ? "" : ", ", flags->drive, flags->rules,
           flags->knockout ? ", knockout" : "", flags->placement, flags->seconds, flags->seed,
           flags->realism ? ", realism " : "", flags->realism ? flags->realism : "");
}
