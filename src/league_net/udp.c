#define _GNU_SOURCE
#include "vsss/udp.h"

#include <arpa/inet.h>
#include <errno.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "process_name.h"
#include "vsss/clock.h"

// Bursts of a whole match's frames in --sync must not be lost while a client thinks.
#define RECEIVE_BUFFER (1 << 20)

static vs_status find_interface(const char *name, struct in_addr *out, vs_error *err) {
  if (!name) {
    out->s_addr = htonl(INADDR_LOOPBACK);
    return VS_OK;
  }
  struct in_addr wanted;
  bool is_address = inet_pton(AF_INET, name, &wanted) == 1;
  struct ifaddrs *list = NULL;
  char known[256] = "";
  if (getifaddrs(&list) != 0) return vs_fail(err, VS_FAIL, "interface %s: %s", name, strerror(errno));
  bool found = false;
  for (const struct ifaddrs *i = list; i && !found; i = i->ifa_next) {
    if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET || !(i->ifa_flags & IFF_UP)) continue;
    *out = ((const struct sockaddr_in *)i->ifa_addr)->sin_addr;
    found = is_address ? out->s_addr == wanted.s_addr : strcmp(i->ifa_name, name) == 0;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", i->ifa_name);
  }
  freeifaddrs(list);
  return found
             ? VS_OK
             : vs_fail(err, VS_USAGE, "interface '%.40s' is not up or has no IPv4 address; there are %s", name, known);
}

// Addresses of this machine.
static void list_own(vs_udp *udp) {
  struct ifaddrs *list = NULL;
  udp->own[udp->own_addresses++] = htonl(INADDR_LOOPBACK);
  if (getifaddrs(&list) != 0) return;
  for (const struct ifaddrs *i = list; i; i = i->ifa_next)
    if (i->ifa_addr && i->ifa_addr->sa_family == AF_INET && udp->own_addresses < 16)
      udp->own[udp->own_addresses++] = ((const struct sockaddr_in *)i->ifa_addr)->sin_addr.s_addr;
  freeifaddrs(list);
}

static bool is_own(const vs_udp *udp, uint32_t address) {
  for (int i = 0; i < udp->own_addresses; i++)
    if (udp->own[i] == address) return true;
  return udp->own_addresses == 0;
}

static vs_status open_socket(vs_udp *out, vs_error *err) {
  *out = (vs_udp){.fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  return out->fd >= 0 ? VS_OK : vs_fail(err, VS_FAIL, "no socket: %s", strerror(errno));
}

static vs_status give_up(vs_udp *udp, vs_error *err, const char *what, const char *address, int port) {
  vs_status s = vs_fail(err, VS_FAIL, "%s %s:%d: %s", what, address, port, strerror(errno));
  vs_udp_close(udp);
  return s;
}

vs_status vs_udp_listen(int port, const char *interface, vs_udp *out, vs_error *err) {
  struct in_addr own;
  *out = VS_UDP_CLOSED;
  vs_status s = find_interface(interface, &own, err);
  if (s == VS_OK) s = open_socket(out, err);
  if (s != VS_OK) return s;
  int size = RECEIVE_BUFFER;
  setsockopt(out->fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr = own};
  if (interface) at.sin_addr.s_addr = htonl(INADDR_ANY);
  if (bind(out->fd, (const struct sockaddr *)&at, sizeof at) == 0) return VS_OK;
  if (errno != EADDRINUSE) return give_up(out, err, "cannot listen on", interface ? "0.0.0.0" : "127.0.0.1", port);
  vs_udp_close(out);
  char holder[160];
  vs_udp_port_holder(port, holder, sizeof holder);
  return vs_fail(err, VS_FAIL, "UDP port %d is in use by %s: stop that, or take other ports (--ports +10)", port,
                 holder);
}

vs_status vs_udp_join(const char *group, int port, const char *interface, vs_udp *out, vs_error *err) {
  struct ip_mreq request = {0};
  *out = VS_UDP_CLOSED;
  vs_status s = find_interface(interface, &request.imr_interface, err);
  if (s == VS_OK) s = open_socket(out, err);
  if (s != VS_OK) return s;
  int yes = 1, no = 0, size = RECEIVE_BUFFER;
  setsockopt(out->fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(out->fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  setsockopt(out->fd, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no); // of the interface that was asked for only
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  inet_pton(AF_INET, group, &at.sin_addr);
  request.imr_multiaddr = at.sin_addr;
  if (bind(out->fd, (const struct sockaddr *)&at, sizeof at) != 0 ||
      setsockopt(out->fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) != 0)
    return give_up(out, err, "cannot join", group, port);
  if (interface) return VS_OK;
  list_own(out);
  request.imr_interface.s_addr = htonl(INADDR_ANY); // fails on a machine without a route: then nobody sends that way
  setsockopt(out->fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request);
  return VS_OK;
}

vs_status vs_udp_sender(const char *address, int port, const char *interface, vs_udp *out, vs_error *err) {
  struct in_addr own, to;
  *out = VS_UDP_CLOSED;
  if (inet_pton(AF_INET, address, &to) != 1)
    return vs_fail(err, VS_USAGE, "address '%.60s': expected an IPv4 address", address);
  vs_status s = find_interface(interface, &own, err);
  if (s == VS_OK) s = open_socket(out, err);
  if (s != VS_OK) return s;
  out->to_address = to.s_addr;
  out->to_port = htons((uint16_t)port);
  unsigned char ttl = interface ? 1 : 0, loop = 1;
  if (IN_MULTICAST(ntohl(to.s_addr)) && (setsockopt(out->fd, IPPROTO_IP, IP_MULTICAST_IF, &own, sizeof own) != 0 ||
                                         setsockopt(out->fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) != 0 ||
                                         setsockopt(out->fd, IPPROTO_IP, IP_MULTICAST_LOOP, &loop, sizeof loop) != 0))
    return give_up(out, err, "cannot send to", address, port);
  return VS_OK;
}

void vs_udp_close(vs_udp *udp) {
  if (udp->fd >= 0) close(udp->fd);
  *udp = VS_UDP_CLOSED;
}

bool vs_udp_receive(const vs_udp *udp, uint8_t *out, size_t out_size, size_t *size) {
  if (udp->fd < 0) return false;
  for (;;) {
    struct sockaddr_in from = {0};
    socklen_t from_size = sizeof from;
    ssize_t n = recvfrom(udp->fd, out, out_size, MSG_TRUNC, (struct sockaddr *)&from, &from_size);
    if (n >= 0 && !is_own(udp, from.sin_addr.s_addr)) continue;
    if (n >= 0) {
      *size = (size_t)n;
      return true;
    }
    // ECONNREFUSED and the like are reports about what was sent, not about what comes.
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EBADF) return false;
    if (errno != EINTR && errno != ECONNREFUSED) return false;
  }
}

bool vs_udp_send(const vs_udp *udp, const uint8_t *data, size_t size) {
  if (udp->fd < 0) return false;
  struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = udp->to_port, .sin_addr = {udp->to_address}};
  return sendto(udp->fd, data, size, 0, (const struct sockaddr *)&to, sizeof to) == (ssize_t)size;
}

bool vs_udp_wait(const vs_udp *const udp[], int n, int64_t until_us) {
  struct pollfd list[16];
  int count = 0;
  for (int i = 0; i < n && count < 16; i++)
    if (udp[i]->fd >= 0) list[count++] = (struct pollfd){.fd = udp[i]->fd, .events = POLLIN};
  int64_t left_us = until_us - vs_clock_monotonic_us();
  if (left_us < 0) left_us = 0;
  struct timespec left = {.tv_sec = left_us / 1000000, .tv_nsec = left_us % 1000000 * 1000};
  return ppoll(list, (nfds_t)count, &left, NULL) > 0;
}

// The holder of an abstract Unix socket is known by asking it.
vs_status vs_udp_claim(const char *group, int port, vs_udp *out, vs_error *err) {
  struct sockaddr_un name = {.sun_family = AF_UNIX};
  int length = snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "vsss-%s:%d", group, port);
  socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)length);
  *out = (vs_udp){.fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  if (out->fd < 0) return vs_fail(err, VS_FAIL, "no socket: %s", strerror(errno));
  if (bind(out->fd, (const struct sockaddr *)&name, size) == 0 && listen(out->fd, 1) == 0) return VS_OK;
  if (errno != EADDRINUSE) return give_up(out, err, "cannot claim", group, port);
  struct ucred peer;
  socklen_t peer_size = sizeof peer;
  char holder[160] = "another process";
  if (connect(out->fd, (const struct sockaddr *)&name, size) == 0 &&
      getsockopt(out->fd, SOL_SOCKET, SO_PEERCRED, &peer, &peer_size) == 0)
    vs_process_name(peer.pid, holder, sizeof holder);
  vs_udp_close(out);
  return vs_fail(err, VS_FAIL, "%s:%d is in use by %s: stop that, or take other ports (--ports +10)", group, port,
                 holder);
}
