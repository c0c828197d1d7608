#!/bin/sh
# Runs deploy/python/examples for a minute altogether: examples.sh BUILD_FOLDER. Those that learn want torch: Debian's
# python3-torch is enough (setup.sh --dev), Stable-Baselines3 comes from pip. What is not there is skipped, and said.
cd "$(dirname "$0")/../.." || exit 1
folder=${1:-build/plain}
python=${VSSS_PYTHON:-/usr/bin/python3}
"$python" -m pip --version >/dev/null 2>&1 || {
  echo "skipped python examples: $python has no pip"
  exit 0
}
version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
torch=$("$python" -c 'import torch; print(torch.__version__)' 2>/dev/null)
case $torch in
'') wanted=$(sh tests/python/pins.sh "$version") learning= ;;
1.* | 2.[0-2].*) # these want NumPy 1
  wanted="numpy==1.26.4 gymnasium==1.2.0 pettingzoo==1.26.1 onnxruntime==1.22.1 pandas==2.2.3 cloudpickle==3.1.1 matplotlib==3.10.1"
  learning=stable-baselines3==2.4.1
  ;;
*)
  wanted="numpy==2.2.6 gymnasium==1.2.0 pettingzoo==1.26.1 onnxruntime==1.22.1 pandas==2.2.3 cloudpickle==3.1.1 matplotlib==3.10.1"
  learning=stable-baselines3==2.7.0
  ;;
esac
[ "$wanted" ] || {
  echo "skipped python examples: Python $version is not one of 3.9 to 3.13"
  exit 0
}
site=build/python/examples-$version
if [ "$(cat "$site/.made" 2>/dev/null)" != "$wanted $learning" ]; then
  rm -rf "$site"
  mkdir -p "$site"
  pip_into_site() { "$python" -m pip install -q --disable-pip-version-check --no-warn-conflicts --target "$site" "$@" >>"$site.log" 2>&1; }
  : >"$site.log"
  fetched=yes
  # shellcheck disable=SC2086 # a list of words
  pip_into_site $wanted || fetched=
  if [ "$fetched" ] && [ "$learning" ]; then pip_into_site --no-deps "$learning" || fetched=; fi
  if [ ! "$fetched" ]; then
    echo "skipped python examples: pip could not fetch $wanted $learning: $(grep -i error "$site.log" | head -n 1)"
    exit 0
  fi
  echo "$wanted $learning" >"$site/.made"
fi
export PYTHONPATH="$PWD/$site:$PWD/deploy/python" PYTHONFAULTHANDLER=1 PYTHONDONTWRITEBYTECODE=1
export VSSS_LIBRARY="$PWD/$folder/libvsss.so" OMP_NUM_THREADS=1
bad=0
example() { # name, what its output must hold, arguments...
  name=$1 expected=$2
  shift 2
  log=$folder/tests/python_example_$name.log
  if timeout 300 "$python" "deploy/python/examples/$name.py" "$@" >"$log" 2>&1 && grep -qE "$expected" "$log"; then
    printf 'ok    python example %-24s %s\n' "$name" "$(tail -n 1 "$log")"
  else
    bad=1
    echo "FAIL  python example $name"
    sed 's/^/    /' "$log"
  fi
}
example pettingzoo_loop 'match 1: ' --seconds 10
example strategy_against_emc 'matches against emc:' --matches 4 --match-seconds 30
if [ "$learning" ]; then
  example cleanrl_ppo 'transitions, .*reward' --seconds 15
  example sb3_ppo '^trained: ' --seconds 20
  # Learning itself: more than when it began, in any case on a machine that is not dead slow.
  awk '/^untrained/ {before = $2} /^trained/ {after = $2} END {exit !(after > before)}' \
    "$folder/tests/python_example_sb3_ppo.log" || { echo "FAIL  python example sb3_ppo learned nothing"; bad=1; }
else
  echo "skipped python examples that learn: $python has no torch (apt install python3-torch)"
fi
exit $bad
