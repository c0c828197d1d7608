#!/bin/sh
# tests/run.sh counts what passed and what was skipped, by the words of both cmockas (Debian 13's names the group in its sums).
cd "$(dirname "$0")/../.." || exit 1
root=$(mktemp -d) || exit 1
trap 'rm -rf "$root"' EXIT
mkdir -p "$root/tests/base"
bad=0
for group in "" "tests: "; do
  cat >"$root/tests/base/test_rng" <<END
#!/bin/sh
echo "[ RUN      ] a_case"
echo "note: no such thing here"
echo "[  SKIPPED ] a_case"
echo "[==========] ${group}4 test(s) run."
echo "[  PASSED  ] 3 test(s)."
echo "[  SKIPPED ] ${group}1 test(s), listed below:"
echo "[  SKIPPED ] a_case"
END
  chmod +x "$root/tests/base/test_rng"
  said=$(sh tests/run.sh "$root" base/rng)
  case $said in
  *"skipped base/rng: a_case: no such thing here
3 passed, 0 failed, 1 skipped") ;;
  *) bad=1 && echo "tests/run.sh says: $said" ;;
  esac
done
exit $bad
