#include "field_report.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static double ms(double us) { return 1e-3 * us; }

void vs_field_report_print(const vs_field_stats *s) {
  printf("\n%-16s %8s %9s %9s %9s %9s %9s %9s\n", "ms", "frames", "mean", "p50", "p95", "p99", "p99.9", "max");
  for (int i = 0; i < VS_STAGES; i++) {
    const vs_histogram *h = &s->stage[i];
    printf("%-16s %8llu %9.3f %9.3f %9.3f %9.3f %9.3f %9.3f\n", vs_stage_name((vs_stage)i),
           (unsigned long long)h->count, ms(vs_histogram_mean_us(h)), ms(vs_histogram_quantile_us(h, 0.5)),
           ms(vs_histogram_quantile_us(h, 0.95)), ms(vs_histogram_quantile_us(h, 0.99)),
           ms(vs_histogram_quantile_us(h, 0.999)), ms((double)h->max_us));
  }
  printf("\n%lld frames, %lld dropped, %lld too old to decide on; %lld decisions, %lld missed\n", (long long)s->frames,
         (long long)s->dropped, (long long)s->too_old, (long long)s->decisions, (long long)s->missed_ticks);
  printf("%lld missing frames bridged; camera lost %lld times, back %lld times; player failed %lld times\n",
         (long long)s->bridged, (long long)s->camera_lost, (long long)s->camera_reopened,
         (long long)s->player_failures);
  printf("mid-exposure to wheel: %.0f ms, %s\n", ms(1e6 * s->latency_s),
         s->latency_told ? "as the robots' motion told" : "as given: the robots' motion did not tell");
  printf("stopped:");
  for (int i = 0; i < VS_SAFETY_STATES; i++)
    if (s->entered[i] && i != VS_SAFETY_RUNNING)
      printf(" %s %llu,", vs_safety_name((vs_safety_state)i), (unsigned long long)s->entered[i]);
  printf(" released %llu times\n", (unsigned long long)s->entered[VS_SAFETY_RUNNING]);
  printf("radio: %lld frames written, %lld dropped, device reopened %lld times; referee spoke %lld times\n",
         (long long)s->serial.sent, (long long)s->serial.dropped, (long long)s->serial.reopened, (long long)s->events);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_radio_robot_state *r = &s->robot[i];
    if (r->heard)
      printf("robot %d: %.2f V, took %d frames, refused %d, round trip %.1f ms\n", i, 1e-3 * r->last.battery_mv,
             r->last.rx_ok, r->last.rx_bad, ms((double)r->round_trip_us));
  }
}

vs_status vs_field_report_json(const char *path, const vs_field_stats *s, vs_error *err) {
  FILE *f = fopen(path, "w");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  fprintf(f, "{\n  \"frames\": %lld,\n  \"dropped\": %lld,\n  \"too_old\": %lld,\n", (long long)s->frames,
          (long long)s->dropped, (long long)s->too_old);
  fprintf(f, "  \"decisions\": %lld,\n  \"missed_ticks\": %lld,\n  \"referee_events\": %lld,\n",
          (long long)s->decisions, (long long)s->missed_ticks, (long long)s->events);
  fprintf(f, "  \"latency_s\": %.4f,\n  \"latency_told\": %s,\n", s->latency_s, s->latency_told ? "true" : "false");
  fprintf(f, "  \"bridged\": %lld,\n  \"camera_lost\": %lld,\n  \"camera_reopened\": %lld,\n", (long long)s->bridged,
          (long long)s->camera_lost, (long long)s->camera_reopened);
  fprintf(f, "  \"player_failures\": %lld,\n  \"entered\": {", (long long)s->player_failures);
  for (int i = 0; i < VS_SAFETY_STATES; i++)
    fprintf(f, "%s\"%s\": %llu", i ? ", " : "", vs_safety_name((vs_safety_state)i), (unsigned long long)s->entered[i]);
  fprintf(f, "},\n");
  fprintf(f, "  \"radio_sent\": %lld,\n  \"radio_dropped\": %lld,\n  \"lost_messages\": %lld,\n",
          (long long)s->serial.sent, (long long)s->serial.dropped, (long long)s->lost_messages);
  fprintf(f, "  \"stages\": [");
  for (int i = 0; i < VS_STAGES; i++) {
    const vs_histogram *h = &s->stage[i];
    fprintf(f,
            "%s\n    {\"name\": \"%s\", \"count\": %llu, \"mean_us\": %.1f, \"p50_us\": %.1f, \"p95_us\": %.1f, "
            "\"p99_us\": %.1f, \"p999_us\": %.1f, \"max_us\": %lld, \"max_at_us\": %lld}",
            i ? "," : "", vs_stage_name((vs_stage)i), (unsigned long long)h->count, vs_histogram_mean_us(h),
            vs_histogram_quantile_us(h, 0.5), vs_histogram_quantile_us(h, 0.95), vs_histogram_quantile_us(h, 0.99),
            vs_histogram_quantile_us(h, 0.999), (long long)h->max_us, (long long)h->max_at_us);
  }
  fprintf(f, "\n  ]\n}\n");
  bool bad = ferror(f) != 0;
  bad = fclose(f) != 0 || bad;
  return bad ? vs_fail(err, VS_FAIL, "%s: not written completely; is the disk full?", path) : VS_OK;
}
