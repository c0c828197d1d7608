#!/bin/sh
# Benchmarks of the Python package: python.sh BUILD_FOLDER. Needs what tests/python/run.sh has fetched.
folder=$1
python=${VSSS_PYTHON:-}
for candidate in python3 /usr/bin/python3; do
  [ "$python" ] || { "$candidate" -m pip --version >/dev/null 2>&1 && python=$candidate; }
done
version=$("${python:-false}" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
site=build/python/site-$version
[ -e "$site/.made" ] || { echo "bench python: skipped, run make test T=python/vector first"; exit 0; }
PYTHONPATH="$PWD/$site:$PWD/deploy/python" VSSS_LIBRARY="$PWD/$folder/libvsss.so" "$python" tests/bench/bench_python.py
