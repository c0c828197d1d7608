#!/bin/sh
# Static analysis by cppcheck: errors, warnings, portability.
cd "$(dirname "$0")/../.." || exit 1
command -v cppcheck >/dev/null || { echo "cppcheck is missing: sh deploy/setup.sh --dev"; exit 1; }
cppcheck --quiet --std=c11 --language=c --enable=warning,portability --inline-suppr --error-exitcode=1 \
  --suppress=missingIncludeSystem --suppress=unknownMacro -j 2 -Iinclude -Isrc $(git ls-files 'src/*.c')
