#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/serve.h"

vs_ports vs_ports_default(void) {
  return (vs_ports){.vision = 10002, .command = 20011, .team = {20013, 20012}, .referee = 10003, .placer = 10004};
}

static int *port_named(vs_ports *ports, const char *name, size_t length) {
  const struct {
    const char *name;
    int *port;
  } row[] = {{"vision", &ports->vision},          {"command", &ports->command}, {"blue", &ports->team[VS_BLUE]},
             {"yellow", &ports->team[VS_YELLOW]}, {"referee", &ports->referee}, {"placement", &ports->placer}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    if (strlen(row[i].name) == length && strncmp(row[i].name, name, length) == 0) return row[i].port;
  return NULL;
}

static vs_status shift(const char *text, vs_ports *out, vs_error *err) {
  char *end;
  long by = strtol(text + 1, &end, 10);
  if (end == text + 1 || *end || by < 0 || by > 40000)
    return vs_fail(err, VS_USAGE, "--ports %.60s: +N adds N, 0 to 40000, to every port", text);
  int *all[] = {&out->vision, &out->command, &out->team[0], &out->team[1], &out->referee, &out->placer};
  for (int i = 0; i < 6; i++) *all[i] += (int)by;
  return VS_OK;
}

vs_status vs_ports_parse(const char *text, vs_ports *out, vs_error *err) {
  if (*text == '+') return shift(text, out, err);
  for (const char *at = text; *at;) {
    size_t name = strcspn(at, "=,");
    int *port = at[name] == '=' ? port_named(out, at, name) : NULL;
    char *end = NULL;
    long number = port ? strtol(at + name + 1, &end, 10) : 0;
    if (!port || end == at + name + 1 || (*end && *end != ',') || number < 1024 || number > 65535)
      return vs_fail(err, VS_USAGE,
                     "--ports %.80s: at '%.40s': +N, or NAME=PORT,... with vision, command, blue, yellow, referee or "
                     "placement and 1024 to 65535",
                     text, at);
    *port = (int)number;
    at = *end ? end + 1 : end;
  }
  return VS_OK;
}
