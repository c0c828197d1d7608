#!/bin/sh
# run.sh BUILD_FOLDER SECONDS: runs every fuzz target for so long; status 1 where one found something.
folder=$1
seconds=$2
bad=0
mkdir -p "$folder/found"
for target in "$folder"/fuzz_*; do
  [ -x "$target" ] || continue
  name=${target##*/fuzz_}
  mkdir -p "$folder/corpus/$name" "$folder/seeds/$name"
  set -- "$folder/corpus/$name" "$folder/seeds/$name"
  [ ! -d "tests/fuzz/seeds/$name" ] || set -- "$@" "tests/fuzz/seeds/$name"
  [ "$name" != files ] || set -- "$@" deploy/config deploy/calibration
  if VSSS_SEEDS="$folder/seeds/$name" ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 "$target" \
    -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 -max_len=16384 \
    -artifact_prefix="$folder/found/$name-" -print_final_stats=1 "$@" >"$folder/found/$name.log" 2>&1; then
    printf 'ok    fuzz %-12s %s inputs\n' "$name" "$(sed -n 's/^stat::number_of_executed_units: //p' "$folder/found/$name.log")"
  else
    bad=1
    printf 'FAIL  fuzz %s: %s\n' "$name" "$folder/found/$name.log"
    tail -40 "$folder/found/$name.log"
  fi
  rm -f /tmp/vsss_fuzz_*
done
exit $bad
