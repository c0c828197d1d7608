#!/bin/sh
# Tests mirror the tree: tests/<module>/test_<file>.c names in its first line the file under test, which exists.
cd "$(dirname "$0")/../.." || exit 1
bad=0
for test in $(git ls-files 'tests/*/test_*.c'); do
  first=$(head -n 1 "$test")
  files=$(printf '%s\n' "$first" | grep -oE '(src|include|models|lcm_types|deploy|tests)/[A-Za-z0-9_./]*[A-Za-z0-9_]')
  [ -n "$files" ] || { echo "$test: the first line names no file under test: $first"; bad=1; continue; }
  for file in $files; do
    [ -e "$file" ] || { echo "$test: tests $file, which is not there"; bad=1; }
  done
done
exit $bad
