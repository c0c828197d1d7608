#!/bin/sh
# Runs the benchmarks of peer projects beside ours, in one run on one core, and prints ours, theirs and the ratio.
#   peers.sh BUILD_FOLDER [--install | --python]     --python: only what the Python package is compared with
# VSSS_PEERS_PYTHONS  folder of one Python environment per peer: rsim psim rsoccer sb3 envpool
#                     (default build/peers; --install makes them with python3.10, 3.11 and 3.12 where those exist)
# A peer that is not installed is named and left out.
set -u
folder=$1
pythons=${VSSS_PEERS_PYTHONS:-build/peers}
mkdir -p "$pythons" "$folder/peers"
scripts=$PWD/tests/bench/peers
pythons=$(cd "$pythons" && pwd)
scratch=$(cd "$folder/peers" && pwd) # some peers leave files where they run

python_of() { # version: a command, or one that a version manager keeps
  # A version manager's shim may be there and refuse: only one that runs as this version counts.
  runs() { "$1" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$2')" 2>/dev/null; }
  runs "python$1" "$1" && { command -v "python$1"; return; }
  for p in "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
    runs "$p" "$1" && { echo "$p"; return; }
  done
}

install_peer() { # name, python version, packages...
  name=$1 version=$2
  shift 2
  python=$(python_of "$version")
  [ "$python" ] || { echo "peers: $name needs Python $version, which is not here"; return; }
  [ -d "$pythons/$name" ] || "$python" -m venv "$pythons/$name" || return
  echo "peers: installing $name"
  "$pythons/$name/bin/pip" install -q "pip<24" "setuptools<66" "wheel<0.39" 2>/dev/null
  "$pythons/$name/bin/pip" install -q "$@"
}

if [ "${2:-}" = --install ]; then
  install_peer rsim 3.10 rc-robosim==1.2 "numpy<2"
  install_peer psim 3.11 "pSim[all]==0.2.4"
  install_peer rsoccer 3.10 rc-robosim==1.2 rsoccer-gym==1.4 gym==0.21.0 "numpy<1.24" "protobuf<3.21" "pyglet<2"
  install_peer sb3 3.10 torch "numpy<2" stable-baselines3 pettingzoo rc-robosim==1.2 rsoccer-gym==1.4 gym==0.21.0 "protobuf<3.21" "pyglet<2"
  install_peer envpool 3.12 envpool==1.2.7 torch
  exit
fi

# run NAME SCRIPT ARGUMENTS...: the "peer KEY VALUE" lines of tests/bench/peers/SCRIPT.py, run by the Python of peer NAME;
# peer KEY gives the last of them.
theirs=""
run() {
  name=$1 script=$2
  shift 2
  [ -x "$pythons/$name/bin/python" ] || { echo "peers: $name is not installed (tests/bench/peers.sh $folder --install)" >&2; return 1; }
  said=$(cd "$scratch" && PYTHONDONTWRITEBYTECODE=1 taskset -c 1 "$pythons/$name/bin/python" "$scripts/$script.py" "$@" 2>"$scratch/log" |
    grep '^peer ') || { echo "peers: $name ($script) failed: $(tail -n 1 "$scratch/log")" >&2; return 1; }
  theirs="$theirs
$said"
}
peer() { printf '%s\n' "$theirs" | awk -v n="$1" '$1 == "peer" && $2 == n {v = $3} END {if (v != "") print v}'; }

# ours: "bench NAME VALUE UNIT" lines of our own benchmarks, run now on the same core.
ours=$([ "${2:-}" = --python ] || for what in env learn; do
  [ -x "$folder/tests/bench/bench_$what" ] && OPENBLAS_NUM_THREADS=1 taskset -c 1 "$folder/tests/bench/bench_$what"
done)
our() { printf '%s\n' "$ours" | awk -v n="$1" '$1 == "bench" && $2 == n {print $3; exit}'; }

compare() { # label, our value, their value, unit
  [ "$3" ] || return 0 # said why above
  [ "$2" ] || { echo "peers: our own figure for $1 is missing" >&2; return 0; }
  printf 'bench %-44s %10.2f ratio  (ours %.1f, theirs %.1f %s)\n' "$1" \
    "$(echo "$2 $3" | awk '{print $1 / $2}')" "$2" "$3" "$4"
}

compare_core() {
  planar=$(our env_planar_per_core)
  contact=$(our env_contact_per_core)
  learner=$(our learner_transitions_per_s_1_core)
  learner_fp32=$(our learner_fp32_transitions_per_s_1_core)
  whole=$(our train_transitions_per_s_1_core)

  run rsim rsim
  run psim psim
  run rsoccer rsoccer
  run envpool envpool_soccer
  compare planar/rsim_raw "$planar" "$(peer rsim)" "simulated s/s"
  compare planar/rsim_raw_with_contacts "$planar" "$(peer rsim_hold)" "simulated s/s"
  compare contact/rsim_raw "$contact" "$(peer rsim)" "simulated s/s"
  compare contact/rsim_raw_with_contacts "$contact" "$(peer rsim_hold)" "simulated s/s"
  compare planar/rsoccer_environment "$planar" "$(peer rsoccer)" "simulated s/s"
  compare planar/psim_raw_2d "$planar" "$(peer psim)" "simulated s/s"
  compare planar/psim_environment "$planar" "$(peer psim_zoo)" "simulated s/s"
  compare planar/envpool_soccer "$planar" "$(peer envpool)" "simulated s/s"
  run sb3 torch_learner
  compare learner_fp32/torch_learner "$learner_fp32" "$(peer torch_learner)" "transitions/s per core"
  compare learner/torch_learner "$learner" "$(peer torch_learner)" "transitions/s per core; bf16 where the processor has it"
  run envpool envpool_ppo
  compare train/envpool_soccer_torch_ppo "$whole" "$(peer envpool_ppo)" "transitions/s per core"
}

# The Python package on the same core: environments one beside one, and PPO of the same library on both.
ours_python() { # NAME of the environment of a peer, what...
  name=$1
  shift
  [ -x "$pythons/$name/bin/python" ] || return 0
  PYTHONPATH=$PWD/deploy/python VSSS_LIBRARY=$PWD/$folder/libvsss.so taskset -c 1 "$pythons/$name/bin/python" \
    tests/bench/bench_python.py "$@" 2>"$scratch/log" || echo "peers: bench_python failed: $(tail -n 1 "$scratch/log")" >&2
}
compare_python() {
  [ "$theirs" ] || { run rsoccer rsoccer; run psim psim; run envpool envpool_soccer; }
  ours="$ours
$(ours_python sb3 envs)"
  compare python_vss_v0/rsoccer_vss_v0 "$(our python_vss_v0_steps)" "$(peer rsoccer_steps)" "steps of 25 ms/s"
  compare python_parallel_env/psim_environment "$(our python_parallel_env_steps)" "$(peer psim_zoo_steps | awk '{print $1 * 6}')" "robots' transitions/s, theirs 1/60 s, ours 1/10 s"
  compare python_vec_64_both/envpool_soccer "$(our python_vec_64_both_steps)" "$(peer envpool_players)" "players' transitions/s, theirs 25 ms, ours 100 ms"
  run sb3 sb3_rsoccer && sb3_defaults=$(peer sb3_rsoccer)
  # In turns, since other work on the machine comes and goes; medians.
  sb3_in_turns vss_v0_as_peers
  sb3_in_turns vss_v0_batch_512 --batch 512 --epochs 4
  sb3_in_turns matches --batch 512 --epochs 4
}

median() { sort -n | awk '{v[NR] = $1} END {if (NR) print v[int((NR + 1) / 2)]}'; }

# which of bench_python.py, arguments of the peers' script
sb3_in_turns() {
  how=$1
  shift
  for turn in 1 2 3; do
    ours_python sb3 sb3 --sb3 "$how" --seconds 10
    run sb3 sb3_rsoccer --seconds 10 "$@" && echo "bench theirs $(peer sb3_rsoccer) turn $turn"
  done >"$scratch/turns"
  compare "python_sb3_$how/sb3_rsoccer" "$(awk -v n="python_sb3_$how" '$2 == n {print $3}' "$scratch/turns" | median)" \
    "$(awk '$2 == "theirs" {print $3}' "$scratch/turns" | median)" \
    "transitions/s; our learner takes $(awk -v n="python_sb3_${how}_learner" '$2 == n {print $3}' "$scratch/turns" | median) % of the time"
}

[ "${2:-}" = --python ] || compare_core
compare_python
[ "${2:-}" = --python ] || compare train/sb3_rsoccer "$whole" "${sb3_defaults:-}" "transitions/s per core"
