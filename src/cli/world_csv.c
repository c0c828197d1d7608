#include "world_csv.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

vs_status vs_world_csv_open(const char *path, vs_world_csv *out, vs_error *err) {
  out->file = NULL;
  if (!path) return VS_OK;
  snprintf(out->path, sizeof out->path, "%s", path);
  out->file = fopen(path, "w");
  if (!out->file) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  fprintf(out->file, "time_us,seq,event");
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    const char *team = vs_team_name((vs_team)(i / VS_TEAM_SIZE));
    int n = i % VS_TEAM_SIZE;
    fprintf(out->file, ",%s%d_valid,%s%d_x_m,%s%d_y_m,%s%d_theta_rad", team, n, team, n, team, n, team, n);
  }
  fprintf(out->file, ",ball_valid,ball_x_m,ball_y_m\n");
  return VS_OK;
}

void vs_world_csv_write(vs_world_csv *csv, const vs_world *w, vs_event_kind event) {
  if (!csv->file) return;
  fprintf(csv->file, "%" PRId64 ",%" PRIu32 ",%s", w->time_us, w->seq, vs_event_name(event));
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    const vs_robot *r = &w->robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    fprintf(csv->file, ",%d,%.6f,%.6f,%.6f", r->valid, r->pose.x_m, r->pose.y_m, r->pose.theta_rad);
  }
  fprintf(csv->file, ",%d,%.6f,%.6f\n", w->ball.valid, w->ball.x_m, w->ball.y_m);
}

vs_status vs_world_csv_close(vs_world_csv *csv, vs_error *err) {
  if (!csv->file) return VS_OK;
  bool bad = ferror(csv->file) != 0;
  bad = fclose(csv->file) != 0 || bad;
  csv->file = NULL;
  return bad ? vs_fail(err, VS_FAIL, "%s: not written completely; is the disk full?", csv->path) : VS_OK;
}
