#!/bin/sh
# Runs every check of tests/lint; each prints what it found and exits non-zero on a finding.
cd "$(dirname "$0")/.." || exit 1
bad=0
for check in tests/lint/*.sh; do
  if sh "$check"; then echo "ok    $check"; else echo "FAIL  $check"; bad=1; fi
done
exit $bad
