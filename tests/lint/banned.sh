#!/bin/sh
# What the library may not do: print, exit, draw from the C library's generator, use functions that overrun buffers.
# Only src/cli prints and exits. And no path of one machine, no address, no note to self anywhere.
cd "$(dirname "$0")/../.." || exit 1
bad=0
report() { # message, matches
  [ -z "$2" ] || { echo "$1"; echo "$2" | sed 's/^/  /'; bad=1; }
}
code='src/*.c src/*.h src/*.cpp include/*.h'
set -f # patterns are for git, not for the shell
search() { git grep -InE "$@" || :; }
report "buffers without a size, or a hidden generator:" \
  "$(search '(^|[^a-zA-Z_])(gets|strcpy|strcat|sprintf|vsprintf|strtok|rand|srand|random)\(' -- $code)"
# mujoco_call.c: MuJoCo's error handler may not return, and aborts where no call of ours is there to jump back to.
# player_process.c: the ends of the processes that it forks.
report "the library prints or exits (only src/cli may):" \
  "$(search '(^|[^a-zA-Z_])(printf|puts|putchar|perror|exit|abort|_exit)\(|(stdout|stderr)[^_a-z]' -- $code ':!src/cli' ':!src/sim/mujoco_call.c' ':!src/policy/player_process.c')"
report "left open:" "$(search 'TODO|FIXME|(^|[^X])XXX([^X]|$)|not implemented' -- src include tests/*.c deploy models lcm_types)"
report "an address or a path of one machine:" "$(search 'https?://|(^|[^.[:alnum:]])/(w[o]rk|home/[a-z]+)/' -- . ':!LICENSE')"
report "-ffast-math:" "$(search -e '-ffast-math|-Ofast' -- Makefile deploy src)"
exit $bad
