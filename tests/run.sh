#!/bin/sh
# Runs the built tests: run.sh BUILD_FOLDER [module/file]. Prints one line per binary, the output of what failed, and
# closes with "N passed, N failed".
folder=$1
only=$2
passed=0
failed=0
for test in "$folder"/tests/*/test_* "$folder"/tests/*/*/test_*; do
  case $test in *.d | *.o | *.so | *.log) continue ;; esac
  [ -x "$test" ] || continue
  name=${test#"$folder"/tests/}
  short=$(echo "$name" | sed 's#/test_#/#')
  [ -z "$only" ] || [ "$short" = "$only" ] || [ "$name" = "$only" ] || continue
  start=$(date +%s.%N)
  if "$test" >"$test.log" 2>&1; then
    cases=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$test.log" | awk '{n += $1} END {print n + 0}')
    passed=$((passed + cases))
    printf 'ok    %-40s %3d cases %6.1f s\n' "$short" "$cases" "$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')"
    grep -h '^note: ' "$test.log"
  else
    failed=$((failed + 1))
    printf 'FAIL  %s\n' "$short"
    sed 's/^/    /' "$test.log"
  fi
done
if [ "$passed" = 0 ] && [ "$failed" = 0 ]; then
  echo "no test named '$only' (names look like base/rng)" >&2
  exit 2
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
