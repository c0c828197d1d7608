// A network namespace for this process and what it starts: loopback and multicast, and nothing else.
#define _GNU_SOURCE // unshare
#include <errno.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "own_network.h"

static bool write_text(const char *path, const char *text) {
  int file = open(path, O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  bool whole = write(file, text, strlen(text)) == (ssize_t)strlen(text);
  close(file);
  return whole;
}

// Without the right to make one, a user may in a user namespace, in which it stays who it is.
static bool unshare_network(void) {
  char user[64], group[64];
  snprintf(user, sizeof user, "%u %u 1", geteuid(), geteuid());
  snprintf(group, sizeof group, "%u %u 1", getegid(), getegid());
  if (unshare(CLONE_NEWNET) == 0) return true;
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  // Not mapped, files would belong to nobody; some systems refuse it, and files can still be written.
  write_text("/proc/self/uid_map", user);
  write_text("/proc/self/setgroups", "deny");
  write_text("/proc/self/gid_map", group);
  return true;
}

// Loopback up, and all multicast over it: clients join without naming an interface.
static bool open_loopback(void) {
  int s = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (s < 0) return false;
  struct ifreq lo = {.ifr_name = "lo", .ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST};
  char device[] = "lo";
  struct rtentry route = {.rt_flags = RTF_UP, .rt_dev = device};
  struct sockaddr_in to = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(0xE0000000)}; // 224.0.0.0/4
  memcpy(&route.rt_dst, &to, sizeof to);
  to.sin_addr.s_addr = htonl(0xF0000000);
  memcpy(&route.rt_genmask, &to, sizeof to);
  bool ok = ioctl(s, SIOCSIFFLAGS, &lo) == 0 && ioctl(s, SIOCADDRT, &route) == 0;
  close(s);
  return ok;
}

vs_status own_network_enter(vs_error *err) {
  if (!unshare_network())
    return vs_fail(err, VS_FAIL, "this system gives no network namespace of its own (%s)", strerror(errno));
  if (!open_loopback())
    return vs_fail(err, VS_FAIL, "the loopback of the new network namespace cannot be opened (%s)", strerror(errno));
  return VS_OK;
}
