#!/bin/sh
# The library's boundary: the stable headers (first line "// Stable...") need and name stable headers only, every function in them is
# marked VSSS_API, no other header marks one; and where the library is built and up to date, it exports exactly these functions and
# calls nothing that changes the process it is in.
cd "$(dirname "$0")/../.." || exit 1
bad=0
say() {
  echo "$1"
  bad=1
}
stable=" $(grep -l '^// Stable' include/vsss/*.h | tr '\n' ' ')"
for header in $stable; do
  # shellcheck disable=SC2013 # names of headers have no spaces
  for need in $(grep -oE '^#include "vsss/[a-z_0-9]*\.h' "$header" | cut -d'"' -f2); do
    case $stable in *" include/$need "*) ;; *) say "$header: needs $need, which is not stable" ;; esac
  done
  # Nor does a comment send the reader to one that is not installed; and the page that lists them has them all.
  # shellcheck disable=SC2013
  for need in $(grep -oE '\b[a-z_]+\.h\b' "$header" | sort -u); do
    [ ! -e "include/vsss/$need" ] || case $stable in *" include/vsss/$need "*) ;; *) say "$header: names $need, which is not stable" ;; esac
  done
  grep -qF "\`${header##*/}\`" deploy/docs/library.md || say "deploy/docs/library.md: lacks ${header##*/}"
  unmarked=$(grep -nE '^(const )?[a-z_0-9]+ \**vss?s?_[a-z_0-9]+\(' "$header" | grep -v ':typedef')
  [ -z "$unmarked" ] || say "$header: without VSSS_API: $unmarked"
done
for header in $(git grep -lE '^VSSS_API ' -- include src); do
  case $stable in *" $header "*) ;; *) say "$header: marks VSSS_API but is not stable" ;; esac
done
library=build/plain/libvsss.so
if [ -e $library ] && [ -z "$(find include/vsss src -newer $library -name "*.[ch]")" ]; then
  marked=$(for header in $stable; do cc -E -P -Iinclude -DVSSS_API=@API@ "$header"; done | tr '\n' ' ' | tr ';' '\n' |
    sed -n 's/.*@API@[^(]*[ *]\(vss*_[a-z_0-9]*\)(.*/\1/p' | sort -u)
  exported=$(nm -D --defined-only $library | awk '{print $3}' | sort -u)
  [ "$marked" = "$exported" ] || {
    say "$library does not export exactly what VSSS_API marks (make library brings it up to date):"
    printf '%s\n' "$marked" "$exported" | sort | uniq -u | sed 's/^/  /'
  }
  calls=$(nm -D -u $library | awk '{print $2}' | sed 's/@.*//' |
    grep -xE 'setenv|putenv|unsetenv|dup2|dup3|freopen|chdir|exit|_exit|abort|setlocale|printf|puts|perror')
  [ -z "$calls" ] || say "$library calls what changes its process: $calls"
fi
exit $bad
