// Datagrams of the league: unicast and multicast over IPv4, never blocking. Unless an interface is named, nothing leaves
// the machine (TTL 0) and nothing from another is heard.
#ifndef VSSS_UDP_H
#define VSSS_UDP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Plain data around a socket; {-1} where closed.
typedef struct vs_udp {
  int fd;
  uint32_t to_address; // of a sender, network order
  uint16_t to_port;    // network order
  int own_addresses;   // of this machine, the only senders that are heard; 0: all are
  uint32_t own[16];
} vs_udp;
#define VS_UDP_CLOSED ((vs_udp){.fd = -1})

// interface: name ("eth0") or own IPv4 address; NULL: loopback.
// listen: unicast, on loopback alone or, with an interface, on all addresses. VS_FAIL: port in use, with its holder.
vs_status vs_udp_listen(int port, const char *interface, vs_udp *out, vs_error *err);
// join: hears a multicast group, beside others who do. Without an interface: on loopback and on the default route's.
vs_status vs_udp_join(const char *group, int port, const char *interface, vs_udp *out, vs_error *err);
// sender: to a group or an address; through loopback with TTL 0, through an interface with TTL 1.
vs_status vs_udp_sender(const char *address, int port, const char *interface, vs_udp *out, vs_error *err);
void vs_udp_close(vs_udp *udp); // a closed one is allowed

// False: none waits. size is the datagram's own, also where that is larger than out.
bool vs_udp_receive(const vs_udp *udp, uint8_t *out, size_t out_size, size_t *size);
bool vs_udp_send(const vs_udp *udp, const uint8_t *data, size_t size); // false: not sent

// Waits until one of n has a datagram, at most until a moment of the monotonic clock. False: none has.
bool vs_udp_wait(const vs_udp *const udp[], int n, int64_t until_us);

// Holds a name for this process as long as it lives, so that two do not send on one group and port. VS_FAIL: held, with
// the holder. The result is closed with vs_udp_close.
vs_status vs_udp_claim(const char *group, int port, vs_udp *out, vs_error *err);

// "process 123 (./vsss serve)", or "another process" where that cannot be seen. Linux's /proc.
void vs_udp_port_holder(int port, char *out, size_t out_size);

#ifdef __cplusplus
}
#endif
#endif
