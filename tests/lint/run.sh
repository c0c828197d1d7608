#!/bin/sh
# Runs every check in this folder; each prints what it found and exits non-zero on a finding.
cd "$(dirname "$0")/../.." || exit 1
bad=0
for check in tests/lint/*.sh; do
  [ "$check" = tests/lint/run.sh ] && continue
  if sh "$check"; then echo "ok    $check"; else echo "FAIL  $check"; bad=1; fi
done
exit $bad
