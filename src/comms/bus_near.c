#include "bus_near.h"

#include <arpa/inet.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus_internal.h"
#include "vsss/clock.h"

// A datagram of LCM with a whole message: magic, number, channel and its end, data. Numbers are big-endian.
#define HEADER 8
static const uint8_t magic[4] = {'L', 'C', '0', '2'};

vs_status vs_near_open(vs_near *n, const char *url, vs_error *err) {
  char host[64] = "";
  const char *address = url + strlen("udpm://");
  size_t length = strcspn(address, ":");
  if (length < sizeof host) memcpy(host, address, length);
  struct sockaddr_in group = {.sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(address + length + 1))};
  inet_pton(AF_INET, host, &group.sin_addr);
  struct ip_mreq member = {.imr_multiaddr = group.sin_addr, .imr_interface.s_addr = htonl(INADDR_ANY)};
  int yes = 1, fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0 || setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
      bind(fd, (const struct sockaddr *)&group, sizeof group) != 0 ||
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) != 0) {
    vs_status s = vs_fail(err, VS_FAIL, "%.200s: %s", url, strerror(errno));
    if (fd >= 0) close(fd);
    return s;
  }
  n->fd = fd;
  return VS_OK;
}

void vs_near_close(vs_near *n) {
  if (n->fd > 0) close(n->fd);
  n->fd = 0;
}

// An address is this machine's where a socket can be bound to it. The kernel lets nothing in from outside that claims to
// come from such an address.
static bool is_this_machine(struct in_addr address) {
  struct sockaddr_in own = {.sin_family = AF_INET, .sin_addr = address};
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  bool ok = fd >= 0 && bind(fd, (const struct sockaddr *)&own, sizeof own) == 0;
  if (fd >= 0) close(fd);
  return ok;
}

// Messages come in rows from one sender: it is looked up once a second, not once a message.
static bool came_from_here(vs_near *n, struct in_addr address) {
  int64_t now_us = vs_clock_monotonic_us();
  if (address.s_addr != n->last_address || now_us - n->last_us > VS_NEAR_KNOWN_US) {
    n->last_near = is_this_machine(address);
    n->last_address = address.s_addr;
    n->last_us = now_us;
  }
  return n->last_near;
}

bool vs_near_read(vs_near *n, const char **channel, const uint8_t **data, size_t *size) {
  for (;;) {
    struct sockaddr_in from = {0};
    socklen_t from_size = sizeof from;
    // MSG_TRUNC: the whole length, however much of it fits.
    ssize_t got = recvfrom(n->fd, n->bytes, sizeof n->bytes, MSG_TRUNC, (struct sockaddr *)&from, &from_size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got <= HEADER || got > (ssize_t)sizeof n->bytes || memcmp(n->bytes, magic, sizeof magic) != 0) continue;
    const uint8_t *end = memchr(n->bytes + HEADER, 0, (size_t)got - HEADER);
    vs_channel known;
    if (!end || !vs_channel_parse((const char *)n->bytes + HEADER, &known)) continue;
    if (!came_from_here(n, from.sin_addr)) {
      n->far++;
      continue;
    }
    *channel = (const char *)n->bytes + HEADER;
    *data = end + 1;
    *size = (size_t)got - (size_t)(end + 1 - n->bytes);
    return true;
  }
}
