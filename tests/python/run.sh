#!/bin/sh
# Tests of deploy/python with the library of this checkout: run.sh BUILD_FOLDER [test module].
# VSSS_PYTHON: the interpreter (default: the first python3 that has pip). What the package needs comes from pip, at fixed
# versions, into build/python; without it (no pip, no registry) the tests are skipped, and the line says why.
cd "$(dirname "$0")/../.." || exit 1
folder=$1
only=${2:-}
python=${VSSS_PYTHON:-}
for candidate in python3 /usr/bin/python3; do
  [ "$python" ] || { "$candidate" -m pip --version >/dev/null 2>&1 && python=$candidate; }
done
skip() {
  echo "skipped python: $*"
  exit 0
}
[ "$python" ] || skip "no python3 with pip (apt install python3-pip)"
version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
site=build/python/site-$version
wanted=$(sh tests/python/pins.sh "$version")
[ "$wanted" ] || skip "Python $version is not one of 3.9 to 3.13"
if [ "$(cat "$site/.made" 2>/dev/null)" != "$wanted" ]; then
  rm -rf "$site"
  mkdir -p "$site"
  # shellcheck disable=SC2086 # a list of words
  "$python" -m pip install -q --disable-pip-version-check --no-warn-conflicts --target "$site" $wanted >"$site.log" 2>&1 ||
    skip "pip could not fetch $wanted: $(grep -i error "$site.log" | head -n 1)"
  echo "$wanted" >"$site/.made"
fi
export PYTHONPATH="$PWD/$site:$PWD/deploy/python" PYTHONFAULTHANDLER=1 PYTHONDONTWRITEBYTECODE=1
export VSSS_LIBRARY="$PWD/$folder/libvsss.so"
bad=0
for test in tests/python/test_*.py; do
  name=$(basename "$test" .py)
  [ -z "$only" ] || [ "$name" = "$only" ] || [ "$name" = "test_$only" ] || continue
  log=$folder/tests/python_$name.log
  start=$(date +%s.%N)
  # A run in the background ignores interrupts, which tests send to what they start.
  if (cd tests/python && env --default-signal=INT "$python" -W error::DeprecationWarning:vsss -m unittest -v "$name") >"$log" 2>&1; then
    printf 'ok    python/%-33s %3d cases %6.1f s\n' "${name#test_}" "$(grep -c '\.\.\. ok' "$log")" \
      "$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')"
    sed -n "s/^.*\.\.\. skipped '\(.*\)'$/skipped python\/${name#test_}: \1/p" "$log"
  else
    bad=1
    printf 'FAIL  python/%s\n' "${name#test_}"
    sed 's/^/    /' "$log"
  fi
done
exit $bad
