#!/bin/sh
# The shell scripts, by shellcheck.
cd "$(dirname "$0")/../.." || exit 1
command -v shellcheck >/dev/null || { echo "shellcheck is missing: sh deploy/setup.sh --dev"; exit 1; }
# SC2016: programs for awk and formats for apt stand in single quotes on purpose. SC2046, SC2086: lists of our own words.
git ls-files -z '*.sh' .ci/run | xargs -0 shellcheck -e SC2016,SC2046,SC2086
