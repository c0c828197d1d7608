// Channel names and LCM URLs: what can be said of them without LCM.
#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus_internal.h"

static const char *const names[VS_CHANNELS] = {
    [VS_CH_TRUTH] = "VSSS_TRUTH",   [VS_CH_STATE] = "VSSS_STATE", [VS_CH_DETECTIONS] = "VSSS_DETECTIONS",
    [VS_CH_POLICY] = "VSSS_POLICY", [VS_CH_CMD] = "VSSS_CMD",     [VS_CH_REFEREE] = "VSSS_REFEREE",
    [VS_CH_RADIO] = "VSSS_RADIO",   [VS_CH_STATS] = "VSSS_STATS", [VS_CH_IMAGE] = "VSSS_IMAGE",
};

const char *vs_channel_name(vs_channel channel) { return names[channel]; }

bool vs_channel_parse(const char *name, vs_channel *out) {
  for (int i = 0; i < VS_CHANNELS; i++)
    if (!strcasecmp(name, names[i]) || !strcasecmp(name, names[i] + strlen("VSSS_"))) {
      *out = (vs_channel)i;
      return true;
    }
  return false;
}

const char *vs_bus_default_url(void) {
  const char *url = getenv("LCM_DEFAULT_URL");
  return url && *url ? url : VS_BUS_DEFAULT_URL;
}

vs_status vs_bus_no_route(const char *url, vs_error *err) {
  return vs_fail(err, VS_FAIL,
                 "%.200s: no multicast route on this machine; run as root 'ip link set lo up multicast on' and "
                 "'ip route add 224.0.0.0/4 dev lo'",
                 url);
}

// Asks the kernel for a route by connecting an unused datagram socket: sends nothing.
static bool has_route(const struct sockaddr_in *address) {
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  bool ok = connect(fd, (const struct sockaddr *)address, sizeof *address) == 0;
  close(fd);
  return ok;
}

static vs_status check_options(const char *url, const char *options, const char *const known[], vs_error *err) {
  while (*options) {
    size_t key = strcspn(options, "=&"), whole = strcspn(options, "&");
    bool found = false;
    for (int i = 0; known[i]; i++) found |= strlen(known[i]) == key && !strncmp(options, known[i], key);
    if (!found || key == whole)
      return vs_fail(err, VS_USAGE, "LCM URL '%.200s': '%.*s' is no option of it (key=value, keys: %s, %s)", url,
                     (int)(whole < 80 ? whole : 80), options, known[0], known[1]);
    options += whole + (options[whole] == '&');
  }
  return VS_OK;
}

static vs_status check_udpm(const char *url, vs_error *err) {
  static const char *const known[] = {"ttl", "recv_buf_size", NULL};
  const char *address = url + strlen("udpm://");
  char host[64];
  size_t length = strcspn(address, ":?");
  snprintf(host, sizeof host, "%.*s", (int)(length < sizeof host ? length : sizeof host - 1), address);
  struct sockaddr_in to = {.sin_family = AF_INET};
  char *end = (char *)address + length;
  long port = *end == ':' ? strtol(end + 1, &end, 10) : 0;
  if (inet_pton(AF_INET, host, &to.sin_addr) != 1 || !IN_MULTICAST(ntohl(to.sin_addr.s_addr)) || port < 1 ||
      port > 65535 || (*end && *end != '?'))
    return vs_fail(err, VS_USAGE, "LCM URL '%.200s': expected a multicast address and port, such as %s", url,
                   VS_BUS_DEFAULT_URL);
  to.sin_port = htons((uint16_t)port);
  vs_status s = check_options(url, *end ? end + 1 : end, known, err);
  if (s != VS_OK) return s;
  return has_route(&to) ? VS_OK : vs_bus_no_route(url, err);
}

static vs_status check_file(const char *url, vs_error *err) {
  static const char *const known[] = {"mode", "speed", "start_timestamp", NULL};
  const char *path = url + strlen("file://"), *options = path + strcspn(path, "?");
  if (options == path) return vs_fail(err, VS_USAGE, "LCM URL '%.200s': names no file", url);
  vs_status s = check_options(url, *options ? options + 1 : options, known, err);
  if (s != VS_OK) return s;
  char name[1024];
  snprintf(name, sizeof name, "%.*s", (int)(options - path), path);
  bool write = strstr(options, "mode=w") || strstr(options, "mode=a");
  FILE *f = fopen(name, write ? "ab" : "rb");
  if (!f) return vs_fail(err, VS_FAIL, "%.200s: %s", name, strerror(errno));
  fclose(f);
  return VS_OK;
}

vs_status vs_bus_url_check(const char *url, vs_error *err) {
  if (!strncmp(url, "udpm://", 7)) return check_udpm(url, err);
  if (!strncmp(url, "file://", 7)) return check_file(url, err);
  if (!strcmp(url, "memq://")) return VS_OK;
  return vs_fail(err, VS_USAGE, "LCM URL '%.200s': expected udpm://ADDRESS:PORT?ttl=0, file://PATH?mode=w or memq://",
                 url);
}
