#!/bin/sh
# Layout by .clang-format. Versions of clang-format differ in details: Debian 12's (14) decides, others are skipped.
cd "$(dirname "$0")/../.." || exit 1
command -v clang-format >/dev/null || { echo "clang-format is missing: sh deploy/setup.sh --dev"; exit 1; }
clang-format --version | grep -q 'version 14\.' || { echo "note: $(clang-format --version): not 14, layout not checked"; exit 0; }
bad=$(git ls-files 'src/*.c' 'src/*.h' 'src/*.cpp' 'include/*.h' 'tests/*.c' 'tests/*.h' 'deploy/*.c' | while read -r f; do
  clang-format "$f" | cmp -s - "$f" || echo "$f: run clang-format -i on it"
done)
[ -z "$bad" ] || { echo "$bad"; exit 1; }
