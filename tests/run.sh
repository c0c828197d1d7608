#!/bin/sh
# Runs the built tests: run.sh BUILD_FOLDER [module/file | 'module/ ...' | '!module/ ...': all of these, or all but these].
# One line per binary, the output of what failed; what did not check
# anything is named as skipped, with its reason. With the plain flavour also the Python package's tests (python/NAME) and
# those of an installed copy (install/NAME). Closes with "N passed, N failed, N skipped".
folder=$1
only=${2:-}
passed=0
failed=0
skipped=0

wanted() { # short name, name
  [ "$only" ] || return 0
  case $only in
  !*) case " ${only#!} " in *" ${1%%/*}/ "*) return 1 ;; esac ;;
  */\ * | */) case " $only " in *" ${1%%/*}/ "*) ;; *) return 1 ;; esac ;;
  *) [ "$1" = "$only" ] || [ "$2" = "$only" ] ;;
  esac
}

one_binary() {
  start=$(date +%s.%N)
  # A run in the background ignores signals that the tests send to what they start.
  if env --default-signal=HUP,INT,QUIT,TERM "$1" >"$1.log" 2>&1; then
    cases=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$1.log" | awk '{n += $1} END {print n + 0}')
    # cmocka names what was skipped where it happens and once more at the end.
    awk '/^note: /{why = ": " substr($0, 7)} /^\[  SKIPPED \] [^ ]+$/ && !seen[$4]++ {print "skipped " file ": " $4 why; why = ""}' \
      file="$2" "$1.log" >"$1.skipped"
    left_out=$(grep -c . "$1.skipped")
    if [ $((cases + left_out)) = 0 ]; then # it ended before its first test
      left_out=1
      echo "skipped $2: all: $(sed -n 's/^note: //p' "$1.log" | head -n 1)" >"$1.skipped"
    fi
    passed=$((passed + cases))
    skipped=$((skipped + left_out))
    printf 'ok    %-40s %3d cases %6.1f s\n' "$2" "$cases" "$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')"
    cat "$1.skipped"
    grep -h '^note: .*not run' "$1.log" # a part of a test that passed
  else
    failed=$((failed + 1))
    printf 'FAIL  %s\n' "$2"
    sed 's/^/    /' "$1.log"
  fi
}

# Another runner, whose lines are those above.
other() {
  sh "$@" | tee "$folder/tests/other.lines"
  passed=$((passed + $(awk '$1 == "ok" {n += $3} END {print n + 0}' "$folder/tests/other.lines")))
  failed=$((failed + $(grep -c '^FAIL ' "$folder/tests/other.lines")))
  skipped=$((skipped + $(grep -c '^skipped ' "$folder/tests/other.lines")))
}

for test in "$folder"/tests/*/test_* "$folder"/tests/*/*/test_*; do
  case $test in *.d | *.o | *.so | *.log | *.skipped) continue ;; esac
  if [ ! -x "$test" ] || [ ! -f "$test" ]; then continue; fi
  name=${test#"$folder"/tests/}
  short=$(echo "$name" | sed 's#/test_#/#')
  [ -e "tests/$name.c" ] || continue # its source is gone
  if wanted "$short" "$name"; then one_binary "$test" "$short"; fi
done
if [ "$folder" = build/plain ]; then
  case $only in '' | python/*) other tests/python/run.sh "$folder" "${only#python/}" ;; esac
  case $only in '' | install/*) other tests/install/run.sh "$folder" "${only#install/}" ;; esac
fi
if [ $((passed + failed + skipped)) = 0 ]; then
  echo "no test named '$only' (names look like base/rng)" >&2
  exit 2
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
