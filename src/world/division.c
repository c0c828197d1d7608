#include "vsss/division.h"

#include <stddef.h>

#include "base/word.h"
#include "vsss/field.h"
#include "vsss/world.h"

static const vs_pitch fields[VS_DIVISIONS] = {
    [VS_3V3] = {.name = "3v3",
                .team_size = VS_TEAM_SIZE,
                .half_length_m = VS_FIELD_HALF_LENGTH_M,
                .half_width_m = VS_FIELD_HALF_WIDTH_M,
                .goal_half_width_m = VS_GOAL_HALF_WIDTH_M,
                .goal_depth_m = VS_GOAL_DEPTH_M,
                .corner_m = VS_CORNER_M,
                .area_depth_m = VS_AREA_DEPTH_M,
                .area_half_width_m = VS_AREA_HALF_WIDTH_M,
                .penalty_mark_x_m = VS_PENALTY_MARK_X_M,
                .free_ball_mark_x_m = VS_FREE_BALL_MARK_X_M,
                .free_ball_mark_y_m = VS_FREE_BALL_MARK_Y_M,
                .free_ball_robot_m = VS_FREE_BALL_ROBOT_M,
                .circle_radius_m = VS_CIRCLE_RADIUS_M,
                .goal_kick_x_m = VS_GOAL_KICK_X_M,
                .goal_kick_y_m = VS_GOAL_KICK_Y_M},
    [VS_5V5] = {.name = "5v5",
                .team_size = 5,
                .half_length_m = 1.1,
                .half_width_m = 0.9,
                .goal_half_width_m = 0.20,
                .goal_depth_m = 0.15,
                .corner_m = 0.07,
                .area_depth_m = 0.15,
                .area_half_width_m = 0.25,
                .penalty_mark_x_m = 0.725,
                .free_ball_mark_x_m = 0.55,
                .free_ball_mark_y_m = 0.60,
                .free_ball_robot_m = 0.25,
                .circle_radius_m = 0.25,
                .goal_kick_x_m = 0.95,
                .goal_kick_y_m = 0.25},
};

const vs_pitch *vs_pitch_of(vs_division division) {
  return &fields[(unsigned)division < VS_DIVISIONS ? division : VS_3V3];
}

vs_status vs_division_parse(const char *name, vs_division *out, vs_error *err) {
  const char *const names[] = {fields[VS_3V3].name, fields[VS_5V5].name, NULL};
  int division;
  vs_status s = vs_word_parse("division", name, names, &division, err);
  if (s == VS_OK) *out = (vs_division)division;
  return s;
}

vs_status vs_division_wants_3v3(vs_division division, const char *what, vs_error *err) {
  if (division == VS_3V3) return VS_OK;
  return vs_fail(err, VS_USAGE,
                 "%s plays 3v3 only, not %s: use --division 3v3, or a scripted player (emc:, inf:, emc22:, random:)",
                 what, vs_pitch_of(division)->name);
}
