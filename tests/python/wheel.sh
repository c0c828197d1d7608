#!/bin/sh
# Builds the wheel and tests it in a fresh environment of each Python that is here (3.9 to 3.13): the package's tests, run
# from elsewhere, and that nothing but the wheel, glibc and GCC's libraries is loaded. Skips, and says so, without venv or
# registry. wheel.sh [version...]
cd "$(dirname "$0")/../.." || exit 1
sh deploy/python/wheel.sh >build/wheel.log 2>&1 || {
  if grep -q 'pip could not fetch\|no python3 with pip' build/wheel.log; then
    echo "skipped wheel: $(grep wheel: build/wheel.log | tail -n 1)"
    exit 0
  fi
  cat build/wheel.log
  exit 1
}
tail -n 1 build/wheel.log
wheel=$(echo "$PWD"/build/dist/*.whl)
python_of() { # version: a command that works, or one that a version manager keeps
  for p in "$(command -v "python$1")" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
    [ -x "$p" ] && "$p" -c 'import venv, ensurepip' 2>/dev/null && echo "$p" && return
  done
}
bad=0
tried=0
[ $# != 0 ] || set -- 3.9 3.10 3.11 3.12 3.13
for version; do
  python=$(python_of "$version")
  [ "$python" ] || continue
  tried=$((tried + 1))
  venv=build/python/venv-$version
  log=build/python/venv-$version.log
  start=$(date +%s)
  rm -rf "$venv"
  wanted=$(sh tests/python/pins.sh "$version")
  # shellcheck disable=SC2086 # a list of words
  if ! { "$python" -m venv "$venv" && "$venv/bin/python" -m pip install -q --disable-pip-version-check "$wheel" $wanted; } >"$log" 2>&1; then
    echo "skipped wheel on Python $version: $(grep -i error "$log" | head -n 1)"
    continue
  fi
  if (
    unset PYTHONPATH VSSS_LIBRARY VSSS_HOME VSSS_ONNXRUNTIME
    root=$PWD
    cd "$root/$venv" && cp -r "$root/tests/python" tests && cd tests || exit 1
    export PYTHONFAULTHANDLER=1
    ../bin/python - <<'EOF' || exit 1
import pathlib, sys, vsss
env = vsss.make_vec(2, opponent="emc:", drive="contact")
env.reset(seed=1)
env.step(env.action_space.sample())
here = pathlib.Path(sys.prefix).resolve()
maps = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
ours = [m for m in maps if "vsss" in m or "mujoco" in m]
assert any("libmujoco" in m for m in ours) and all(m.startswith(str(here)) for m in ours), ours
known = ("libc.", "libm.", "libdl.", "libpthread.", "libutil.", "librt.", "ld-linux", "libstdc++.", "libgcc_s.", "libz.")
python = [str(here), str(pathlib.Path(sys.base_prefix).resolve()), "/usr/lib/python3"]
other = [m for m in maps if not m.startswith(tuple(python)) and not pathlib.Path(m).name.startswith(known)]
print("loaded from elsewhere:", other)
assert not [m for m in other if any(w in m for w in ("ccd", "qhull", "tinyxml", "lodepng", "lcm", "apriltag"))], other
EOF
    ../bin/python -m unittest -v
  ) >>"$log" 2>&1; then
    printf 'ok    wheel on Python %-6s %3d cases %4d s\n' "$version" "$(grep -c '\.\.\. ok$' "$log")" $(($(date +%s) - start))
    sed -n "s/^.*\.\.\. skipped '\(.*\)'$/skipped on Python $version: \1/p" "$log"
    rm -rf "$venv"
  else
    bad=1
    echo "FAIL  wheel on Python $version"
    sed 's/^/    /' "$log"
  fi
done
[ "$tried" != 0 ] || echo "skipped wheel: no Python 3.9 to 3.13 with venv (apt install python3-venv)"
exit $bad
