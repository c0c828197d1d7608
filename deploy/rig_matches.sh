#!/bin/sh
# Matches of `vsss field` in `vsss rig`, in real time, then as many of `vsss eval` where commands take as long as they took
# there. Prints both as rows of one table, with 95 % intervals, and how many pictures came too late in the rig.
#   sh deploy/rig_matches.sh [-n MATCHES] [-o OPPONENT] [-p POLICY] [-s SECONDS] [-S SEED] [-e EVAL_MATCHES]
# 20 matches of 120 s take 40 minutes. Real-time priority is asked for; without the right to it a busy machine is late.
set -eu
vsss=${VSSS:-$(dirname "$0")/../vsss}
matches=20 opponent=emc: policy=onnx:models/policy/field.onnx seconds=120 seed=1 eval_matches=
usage() { sed -n '2,5s/^# *//p' "$0"; }
while getopts n:o:p:s:S:e:h option; do
  case $option in
  n) matches=$OPTARG ;; o) opponent=$OPTARG ;; p) policy=$OPTARG ;; s) seconds=$OPTARG ;; S) seed=$OPTARG ;;
  e) eval_matches=$OPTARG ;;
  h) usage; exit 0 ;;
  *) usage >&2; exit 2 ;;
  esac
done
for number in "$matches" "$seconds" "$seed" "${eval_matches:-0}"; do
  case $number in '' | *[!0-9]*) echo "rig_matches: '$number': expected a whole number" >&2; exit 2 ;; esac
done
[ "$matches" -gt 0 ] || { echo "rig_matches: -n 0: expected at least one match" >&2; exit 2; }
folder=$(mktemp -d) rig='' field=''
# Another rig's messages are not ours.
lcm="udpm://239.255.76.67:$((20000 + $$ % 20000))?ttl=0"

finish() {
  [ -z "$field" ] || kill -INT "$field" 2>/dev/null || true
  [ -z "$rig" ] || kill -INT "$rig" 2>/dev/null || true
  wait
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 130' INT TERM

"$vsss" rig --rt 40 --lcm "$lcm" --opponent "$opponent" --matches "$matches" --seconds "$seconds" --seed "$seed" \
  --dir "$folder/venue" >"$folder/rig" 2>"$folder/rig.err" &
rig=$!
until grep -q 'waiting for the camera' "$folder/rig"; do
  kill -0 "$rig" 2>/dev/null || { cat "$folder/rig.err" >&2; exit 1; }
  sleep 0.1
done
"$vsss" field --rt 50 --go --lcm "$lcm" --camera "rig:$folder/venue/camera" --radio "$folder/venue/radio" \
  --policy "$policy" --stats "$folder/stats.json" >"$folder/field" 2>"$folder/field.err" &
field=$!
while kill -0 "$rig" 2>/dev/null; do
  kill -0 "$field" 2>/dev/null || { cat "$folder/field" "$folder/field.err" >&2; exit 1; }
  sleep 0.5
  played=$(grep -c ' s  end ' "$folder/rig" || true)
  if [ "$played" != "${told:-0}" ]; then
    told=$played
    echo "$played of $matches: blue $(grep ' s  end ' "$folder/rig" | tail -n 1 | sed 's/.* //') yellow" >&2
  fi
done
wait "$rig" || { cat "$folder/rig.err" >&2; exit 1; }
rig=''
kill -INT "$field"
wait "$field" || { cat "$folder/field.err" >&2; exit 1; }
field=''

# Wilson's interval of the share won; the score's by its deviation.
grep ' s  end ' "$folder/rig" | sed 's/.* //' | awk -F: '
  {n++; d = $1 - $2; won += d > 0; drawn += d == 0; for_ += $1; against += $2; sum += d; squares += d * d}
  END {
    if (!n) exit 1
    p = won / n; z = 1.96; middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    mean = sum / n; error = n > 1 ? 1.96 * sqrt((squares - n * mean * mean) / (n - 1) / n) : 0
    printf "rig   %d matches: won %.0f [%.0f, %.0f] / drawn %.0f / lost %.0f %%, goals %.2f : %.2f, score %+.2f [%.2f, %.2f]\n",
      n, 100 * p, 100 * (middle - half), 100 * (middle + half), 100 * drawn / n, 100 * (n - won - drawn) / n,
      for_ / n, against / n, mean, mean - error, mean + error}'
grep -E 'not drawn because|a command acted' "$folder/rig" | sed 's/^/      rig: /'
grep -E 'too old to decide|missing frames bridged|mid-exposure to wheel|^camera to radio' "$folder/field" | sed 's/^/      field: /'

latency_s=$(sed -n 's/^  "latency_s": \([0-9.]*\),.*/\1/p' "$folder/stats.json")
printf 'noise = true\n[latency_s]\nlow = %s\nhigh = %s\n' "$latency_s" "$latency_s" >"$folder/realism.ini"
echo "sim, $latency_s s from picture to wheel for both teams:"
nice "$vsss" eval --blue "$policy" --against "$opponent" --matches "${eval_matches:-$matches}" --seconds "$seconds" --seed "$seed" \
  --realism "$folder/realism.ini"
