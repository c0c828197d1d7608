// The ranges of field.md, Ranges: default, reading them from an INI file, drawing one episode from them.
#include "vsss/sensor_model.h"

#include <stddef.h>
#include <stdio.h>

#include "vsss/config.h"
#include "vsss/geom.h"

typedef struct row {
  const char *name;
  size_t offset;
  double fixed;    // low == high of the default
  double min, max; // allowed
  const char *help;
} row;

#define ROW(field, fixed, min, max, help)                                                                              \
  { #field, offsetof(vs_realism, field), fixed, min, max, help }
static const row rows[] = {
    ROW(noise_scale, 1, 0, 10, "times the paper's noise"),
    ROW(position_bias_m, 0, 0, 0.1, "constant offset of all positions"),
    ROW(heading_bias_rad, 0, 0, 0.5, "constant offset of all headings"),
    ROW(position_scale, 1, 0.8, 1.2, "scale of all positions"),
    ROW(latency_s, 0, 0, 0.2, "capture to wheel"),
    ROW(latency_jitter_s, 0, 0, 0.03, "each frame's change of the latency"),
    ROW(detection_loss, 0, 0, 0.9, "probability per object and frame"),
    ROW(detection_burst_frames, 1, 1, 30, "length of a loss"),
    ROW(radio_loss, 0, 0, 0.9, "probability per team and frame"),
    ROW(radio_burst_frames, 1, 1, 30, "length of a loss"),
    ROW(motor_tau_s, 0, 0, 1, "first-order lag of the wheels"),
    ROW(wheel_gain, 1, 0.5, 1.5, "reached / commanded speed, each wheel"),
    ROW(wheel_limit_scale, 1, 0.3, 1.2, "battery: scale of the highest wheel speed"),
    ROW(dead_zone_radps, 0, 0, 10, "commands below do nothing"),
    ROW(wheel_radius_scale, 1, 0.9, 1.1, "each robot"),
    ROW(track_scale, 1, 0.9, 1.05, "each robot"),
    ROW(com_offset_m, 0, -0.01, 0.01, "centre of mass off the middle, each robot and axis"),
    ROW(floor_friction_scale, 1, 0.3, 2, "times 0.9"),
    ROW(robot_mass_scale, 1, 0.5, 2, "times 0.425 kg"),
    ROW(ball_mass_scale, 1, 0.5, 2, "times 46 g"),
    ROW(ball_rolling_scale, 1, 0, 10, "times 0.20 m/s2"),
    ROW(ball_restitution, 0.6, 0.05, 0.95, "rebound at walls"),
    ROW(push_per_s, 0, 0, 30, "random shoves of each robot"),
    ROW(push_mps, 0, 0, 1, "largest change of its velocity by a shove"),
};
#undef ROW
#define ROWS (sizeof rows / sizeof *rows)

static vs_range *range_of(vs_realism *realism, size_t i) { return (vs_range *)((char *)realism + rows[i].offset); }

vs_realism vs_realism_default(void) {
  vs_realism realism = {.noise = true};
  for (size_t i = 0; i < ROWS; i++) *range_of(&realism, i) = (vs_range){rows[i].fixed, rows[i].fixed};
  return realism;
}

// From a file, or where text is given from that, under the name of path.
static vs_status read_ranges(const char *path, const char *text, vs_realism *out, vs_error *err) {
  vs_realism realism = vs_realism_default();
  char names[2 * ROWS][48];
  enum { FIRST = 3 };
  vs_config_key schema[2 * ROWS + FIRST + 1] = {
      {.name = "noise", .type = VS_CONFIG_BOOL, .target = &realism.noise},
      {.name = "ideal_share", .type = VS_CONFIG_REAL, .target = &realism.ideal_share, .min = 0, .max = 1},
      {.name = "never_seen_share", .type = VS_CONFIG_REAL, .target = &realism.never_seen_share, .min = 0, .max = 1}};
  for (size_t i = 0; i < 2 * ROWS; i++) {
    const row *from = &rows[i / 2];
    vs_range *range = range_of(&realism, i / 2);
    snprintf(names[i], sizeof names[i], "%s.%s", from->name, i % 2 ? "high" : "low");
    schema[i + FIRST] = (vs_config_key){.name = names[i],
                                        .type = VS_CONFIG_REAL,
                                        .target = i % 2 ? &range->high : &range->low,
                                        .min = from->min,
                                        .max = from->max,
                                        .help = from->help};
  }
  vs_status status = text ? vs_config_parse(path, text, schema, err) : vs_config_load(path, schema, err);
  if (status != VS_OK) return status;
  for (size_t i = 0; i < ROWS; i++) {
    const vs_range *range = range_of(&realism, i);
    if (range->low <= range->high) continue;
    return vs_fail(err, VS_USAGE, "%s: [%s] low = %g is above high = %g: give both, low first", path, rows[i].name,
                   range->low, range->high);
  }
  *out = realism;
  return VS_OK;
}

vs_status vs_realism_load(const char *path, vs_realism *out, vs_error *err) {
  return read_ranges(path, NULL, out, err);
}

vs_status vs_realism_parse(const char *name_for_errors, const char *text, vs_realism *out, vs_error *err) {
  return read_ranges(name_for_errors, text, out, err);
}

static double draw(vs_rng *rng, vs_range range) { return vs_rng_range(rng, range.low, range.high); }

static void draw_robot(const vs_realism *r, vs_rng *rng, int team, int index, vs_sim_params *params) {
  for (int k = 0; k < 2; k++) {
    params->wheel_gain[team][index][k] = draw(rng, r->wheel_gain);
    params->com_offset_m[team][index][k] = draw(rng, r->com_offset_m);
  }
  params->wheel_radius_scale[team][index] = draw(rng, r->wheel_radius_scale);
  params->track_scale[team][index] = draw(rng, r->track_scale);
}

vs_sim_params vs_realism_draw(const vs_realism *r, uint64_t seed) {
  vs_rng rng = vs_rng_make(seed, 1);
  vs_sim_params params = vs_sim_params_default();
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) draw_robot(r, &rng, i / VS_TEAM_SIZE, i % VS_TEAM_SIZE, &params);
  params.wheel_limit_scale = draw(&rng, r->wheel_limit_scale);
  params.motor_tau_s = draw(&rng, r->motor_tau_s);
  params.dead_zone_radps = draw(&rng, r->dead_zone_radps);
  params.floor_friction_scale = draw(&rng, r->floor_friction_scale);
  params.robot_mass_scale = draw(&rng, r->robot_mass_scale);
  params.ball_mass_scale = draw(&rng, r->ball_mass_scale);
  params.ball_rolling_scale = draw(&rng, r->ball_rolling_scale);
  params.ball_restitution = draw(&rng, r->ball_restitution);
  params.push_per_s = draw(&rng, r->push_per_s);
  params.push_mps = draw(&rng, r->push_mps);
  params.push_seed = vs_seed_mix(seed, 2);
  // The robots of larger teams last: what a seed means to 3 against 3 stays.
  for (int i = VS_TEAM_SIZE; i < VS_TEAM_MOST; i++)
    for (int t = 0; t < VS_TEAMS; t++) draw_robot(r, &rng, t, i, &params);
  return params;
}
