#!/bin/sh
# Installs into an empty folder and builds and runs deploy/examples from that copy alone, as somebody would who has never
# seen this tree: run.sh BUILD_FOLDER [check]. One line per check, as tests/run.sh prints them.
# shellcheck disable=SC2317 # the checks are called by name
cd "$(dirname "$0")/../.." || exit 1
build=$1
only=${2:-}
root=$(mktemp -d) || exit 1
trap 'rm -rf "$root"' EXIT
prefix=$root/usr
here=$PWD
log=$PWD/$build/tests/install.log
bad=0
: >"$log"

# check NAME COMMAND...: runs it with nothing of the tree at hand.
check() {
  name=$1
  shift
  [ -z "$only" ] || [ "$only" = "$name" ] || [ "$name" = install ] || return 0
  start=$(date +%s.%N)
  echo "== $name" >>"$log"
  if ("$@") >"$root/said" 2>&1; then
    printf 'ok    install/%-32s   1 cases %6.1f s\n' "$name" "$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')"
  else
    bad=1
    printf 'FAIL  install/%s\n' "$name"
    sed 's/^/    /' "$root/said"
  fi
  cat "$root/said" >>"$log"
}
skip() { printf 'skipped install/%s: %s\n' "$1" "$2"; }

# Everything is readable by others though the one who installs says otherwise; no product of the build but what is used.
install_all() {
  (umask 077 && ${MAKE:-make} --no-print-directory install PREFIX="$prefix") || return 1
  [ -z "$(find "$prefix" ! -perm -o=r)" ] || { find "$prefix" ! -perm -o=r; return 1; }
  [ ! -e "$prefix/share/vsss/build" ] && [ -z "$(find "$prefix" -name '*.o' -o -name '*.a' -o -name '*.gen')" ] || return 1
  [ "$(readlink "$prefix/lib/libvsss.so")" = libvsss.so.1 ]
}
copy_examples() { # the installed ones, where they may be built
  cp -r "$prefix/share/vsss/deploy/examples" "$root/examples"
}
program() {
  cd "$root" && "$prefix/bin/vsss" --version && "$prefix/bin/vsss" sim --seconds 3 --blue onnx: --yellow emc: &&
    "$prefix/bin/vsss" sim --seconds 3 --blue onnx: --yellow emc: | grep 'hash' >"$root/installed" &&
    "$here/vsss" sim --seconds 3 --blue onnx: --yellow emc: | grep 'hash' >"$root/built" &&
    [ "$(sed 's/.*hash//' "$root/installed")" = "$(sed 's/.*hash//' "$root/built")" ]
}
vecenv() {
  make -s -C "$root/examples/vecenv" CFLAGS='-O2 -Wall -Wextra -Werror' && cd "$root" && examples/vecenv/loop | tee said_loop &&
    grep -qE '^1[0-9] matches, random [0-9]+ : [0-9]+ emc$' said_loop
}
# A fixed seed: the same numbers on every machine with these libraries; learning shows in the first updates already.
trainer() {
  make -s -C "$root/examples/trainer" CFLAGS='-O2 -Wall -Wextra -Werror' && cd "$root" && examples/trainer/train 40 | tee said_train &&
    awk '/^reward per decision/ {gsub(",", ""); exit !($10 > $7 + 0.001)}' said_train
}
plugin() {
  make -s -C "$root/examples/plugin" && cd "$root" &&
    "$prefix/bin/vsss" sim --seconds 10 --blue plugin:examples/plugin/team.so --yellow zero:
}
player() {
  make -s -C "$root/examples/lcm" && cd "$root" || return 1
  url="udpm://239.255.76.67:$((20000 + $$ % 20000))?ttl=0"
  examples/lcm/player yellow "$url" &
  started=$!
  "$prefix/bin/vsss" sim --seconds 3 --blue zero: --yellow "lcm:yellow?timeout_ms=20000&url=$url"
  result=$?
  kill $started
  return $result
}
cmake_package() {
  mkdir -p "$root/cmake" && cp "$root/examples/vecenv/loop.c" "$root/cmake" && cd "$root/cmake" || return 1
  cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.18)
project(loop C)
find_package(vsss 0.1 REQUIRED)
find_package(vsss 0.2 QUIET)
add_executable(loop loop.c)
target_link_libraries(loop PRIVATE vsss::vsss)
END
  cmake -S . -B build -DCMAKE_PREFIX_PATH="$prefix" && cmake --build build && ldd build/loop | grep "$prefix/lib/libvsss.so.1"
}
# Every command and its flags are in the manual page, and the completion offers them.
help_files() {
  cp "$prefix/share/man/man1/vsss.1" "$root/page" || return 1
  for command in $("$prefix/bin/vsss" --help | awk '/^  [a-z]/ {print $1}'); do
    grep -q "^\.B $command\$" "$root/page" || { echo "no $command in the page"; return 1; }
    for flag in $("$prefix/bin/vsss" help "$command" | awk '/^  --/ {print $1}'); do
      grep -qF -e "$(echo "$flag" | sed 's/-/\\-/g')" "$root/page" || { echo "no $command $flag in the page"; return 1; }
    done
  done
  [ "$(command -v bash)" ] || return 0
  bash -c '. "$1"; set -e
    COMP_WORDS=(vsss tr) COMP_CWORD=1; _vsss; [ "${COMPREPLY[*]}" = train ]
    COMP_WORDS=(vsss sim --vi) COMP_CWORD=2; _vsss; [ "${COMPREPLY[0]}" = --video ]' bash \
    "$prefix/share/bash-completion/completions/vsss"
}
uninstall() {
  ${MAKE:-make} --no-print-directory uninstall PREFIX="$prefix" && [ -z "$(find "$prefix" ! -type d)" ]
}

export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
check install install_all
[ $bad = 0 ] || exit 1
copy_examples
check program program
check help_files help_files
if [ "$(command -v pkg-config)" ]; then
  check plugin plugin
  check vecenv vecenv
  check trainer trainer
else
  skip plugin "no pkg-config (apt install pkgconf)"
  skip vecenv "no pkg-config (apt install pkgconf)"
  skip trainer "no pkg-config (apt install pkgconf)"
fi
if [ "$(command -v lcm-gen)" ] && [ "$(command -v pkg-config)" ]; then
  check player player
else
  skip player "no lcm-gen or no pkg-config (apt install liblcm-bin pkgconf)"
fi
if [ "$(command -v cmake)" ]; then check cmake cmake_package; else skip cmake "no cmake"; fi
[ -n "$only" ] || check uninstall uninstall
exit $bad
