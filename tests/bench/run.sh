#!/bin/sh
# Runs the benchmarks: run.sh BUILD_FOLDER [what]. Each prints lines "bench NAME VALUE UNIT", medians of several runs.
folder=$1
only=$2
bad=0
ran=0
for bench in "$folder"/tests/bench/bench_*; do
  case $bench in *.d) continue ;; esac
  [ -x "$bench" ] || continue
  name=${bench##*/bench_}
  [ -z "$only" ] || [ "$only" = "$name" ] || continue
  ran=$((ran + 1))
  "$bench" || { echo "bench $name failed" >&2; bad=1; }
done
if [ -z "$only" ] || [ "$only" = python ]; then
  ran=$((ran + 1))
  sh tests/bench/python.sh "$folder" || bad=1
fi
[ "$ran" != 0 ] || { echo "no benchmark named '$only'" >&2; exit 2; }
exit $bad
