#!/bin/sh
# two_machines.sh LISTENER SPEAKER: two commands on two machines, as far as one can be two: network namespaces joined by a
# cable, that see nothing else. The listener is started first and interrupted when the speaker has ended; its output is what
# is printed. Exit 77: this machine does not allow it.
set -u
a=vsssc$$ b=vsssd$$
clean() {
  ip netns del "$a" 2>/dev/null
  ip netns del "$b" 2>/dev/null
}
trap clean EXIT
trap 'exit 1' INT TERM
command -v ip >/dev/null || exit 77
{
  ip netns add "$a" && ip netns add "$b" &&
    ip link add name "$a" netns "$a" type veth peer name "$b" netns "$b" &&
    ip -n "$a" addr add 10.213.9.1/30 dev "$a" && ip -n "$b" addr add 10.213.9.2/30 dev "$b" &&
    ip -n "$a" link set "$a" up && ip -n "$b" link set "$b" up &&
    ip -n "$a" link set lo up && ip -n "$b" link set lo up &&
    ip -n "$a" route add 224.0.0.0/4 dev "$a" && ip -n "$b" route add 224.0.0.0/4 dev "$b"
} 2>/dev/null || exit 77
# shellcheck disable=SC2086
ip netns exec "$a" $1 </dev/null &
listener=$!
# It says when it listens only to a person: spoken to again and again, one of the times it does.
for _ in 1 2 3 4 5 6; do
  sleep 0.5
  # shellcheck disable=SC2086
  ip netns exec "$b" $2 >/dev/null 2>&1 </dev/null
done
kill -INT "$listener"
wait "$listener"
