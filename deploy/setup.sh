#!/bin/sh
# Makes a bare Debian 12 or 13 ready and builds vsss: sh deploy/setup.sh [--dev] [--minimal] [--no-build]
#   --dev       also the tools of `make lint`
#   --minimal   without Java (the window of ./vsss spy) and libtorch (--learner torch, some tests)
#   --no-build  only install
# Run it as root or with sudo at hand, as often as you like: what is there is left alone (a second run takes seconds).
# Packages come from the machine's own apt sources; on Debian 12, which has no ONNX Runtime, its library comes out of
# the PyPI wheel and its headers out of Debian 13's package, both checked by sha256, both under build/.
set -eu
cd "$(dirname "$0")/.."

dev=
minimal=
build=yes
for word; do
  case $word in
  --dev) dev=yes ;;
  --minimal) minimal=yes ;;
  --no-build) build= ;;
  --help | -h)
    sed -n '2,8s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  *)
    echo "setup.sh: unknown word '$word' (known: --dev, --minimal, --no-build)" >&2
    exit 2
    ;;
  esac
done

# shellcheck disable=SC1091
. /etc/os-release
say() { echo "setup: $*"; }
die() {
  echo "setup: $*" >&2
  exit 1
}

case ${ID:-}:${VERSION_ID:-} in
debian:12) release=bookworm ;;
debian:13) release=trixie ;;
*) die "this is ${PRETTY_NAME:-an unknown system}; vsss is made for Debian 12 and 13 (elsewhere install the packages that 'make' names and run make)" ;;
esac

# What each package is for:
packages="
build-essential     compiler and make
libmujoco-dev       physics
liblcm-dev          messages between programs
liblcm-bin          lcm-gen, lcm-logger, lcm-logplayer
liblcm-java libjchart2d-java default-jre default-jdk-headless  ./vsss spy (lcm-spy is a Java program)
libprotobuf-c-dev protobuf-c-compiler  the simulation league's network messages (serve)
libcivetweb-dev     the page of ./vsss view
libopencv-dev       cameras, calibration, images
libapriltag-dev     robot tags
libjpeg62-turbo-dev  pictures of MJPG cameras, faster than by OpenCV
libegl-dev libgl-dev libegl-mesa0 libgl1-mesa-dri  off-screen pictures
ffmpeg              videos
gnuplot-nox         ./vsss plot
libdnnl-dev         matrix products of the learner (a quarter faster than OpenBLAS)
libopenblas-dev     the same where there is no oneDNN, and its baseline in the benchmark
libtorch-dev        --learner torch, oracle of the learner's tests
libopenmpi-dev openmpi-bin  training on many machines
libcmocka-dev zlib1g-dev    tests
pkgconf             how other programs find libvsss: deploy/examples, and their test
python3             tests: a client of the league written from its protocol alone
"
if [ $release = trixie ]; then
  packages="$packages
libonnxruntime-dev  learned policies"
else
  packages="$packages
ca-certificates python3-pip unzip  to fetch ONNX Runtime, which Debian 12 lacks"
fi
if [ "$dev" ]; then
  packages="$packages
clang-format cppcheck shellcheck  make lint
python3-pip python3-venv  make wheel, tests of the Python package
python3-torch       its examples that learn
chromium-headless-shell  the test of view's page in a real browser
iproute2            network namespaces, for the test of training on two hosts
locales             a decimal comma, for the tests of the library in a program that has one"
fi

if [ "$minimal" ]; then
  packages=$(printf '%s\n' "$packages" | grep -v -e '^liblcm-java ' -e '^libtorch-dev ')
fi

# The names are the words before two spaces in a row.
names=$(printf '%s\n' "$packages" | sed 's/  .*//')
missing=
for name in $names; do
  case $(dpkg-query -W -f '${Status}' "$name" 2>/dev/null) in
  *"ok installed") ;;
  *) missing="$missing $name" ;;
  esac
done

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "root is needed for: $* (run this as root, or install sudo)"
  fi
}

if [ "$missing" ]; then
  say "a bare machine downloads about 600 packages here (0.6 GB, 2.5 GB on the disk); with the build that takes 5 to 15 minutes"
  [ "$minimal" ] || say "(--minimal leaves out Java and libtorch)"
  say "installing:$missing"
  as_root apt-get update -q
  # shellcheck disable=SC2086 # a list of words
  LC_ALL=C apt-get install --no-install-recommends --assume-no $missing 2>/dev/null |
    sed -n 's/^\(Need to get .*\) of archives\./setup: \1/p; s/^After this operation, \(.*\) of additional.*/setup: \1 on the disk/p' || :
  # shellcheck disable=SC2086 # a list of words
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
else
  say "all packages are installed"
fi

# --- ONNX Runtime on Debian 12 ---------------------------------------------------------------------------------------
ort_version=1.21.1
ort_dir=build/onnxruntime
header_sha256=7783e9664bdb0b1b36145b5c8587dd1bc9a399aa000edf2e3dd03003cafc6882
case $(dpkg --print-architecture) in
amd64) wheel_platform=manylinux_2_28_x86_64 wheel_sha256=982dcc04a6688e1af9e3da1d4ef2bdeb11417cf3f8dde81f8f721043c1919a4f ;;
arm64) wheel_platform=manylinux_2_28_aarch64 wheel_sha256=4b6a29a1767b92d543091349f5397a1c7619eaca746cd1bc47f8b4ec5a9f1a6c ;;
*) wheel_platform="" wheel_sha256="" ;;
esac

check_sha256() { # file, expected
  actual=$(sha256sum "$1" | cut -d' ' -f1)
  [ "$actual" = "$2" ] || die "$1: sha256 is $actual, expected $2; it is not the file this project was made with"
}

fetch_library() {
  say "fetching ONNX Runtime $ort_version out of its PyPI wheel"
  rm -rf build/wheel
  mkdir -p build/wheel $ort_dir/lib
  printf 'onnxruntime==%s --hash=sha256:%s\n' $ort_version "$wheel_sha256" >build/wheel/requirements.txt
  python=python3 # the first one with pip: a version manager's may come without
  $python -m pip --version >/dev/null 2>&1 || python=/usr/bin/python3
  $python -m pip download -q --no-deps --only-binary=:all: --require-hashes --python-version 3.11 --implementation cp \
    --abi cp311 --platform $wheel_platform -d build/wheel -r build/wheel/requirements.txt ||
    die "pip could not fetch onnxruntime==$ort_version (its reason is above): mend the network or pip's configuration and run this again"
  unzip -q -o build/wheel/onnxruntime-*.whl 'onnxruntime/capi/libonnxruntime.so.*' 'onnxruntime/LICENSE' \
    'onnxruntime/ThirdPartyNotices.txt' -d build/wheel/unpacked
  cp build/wheel/unpacked/onnxruntime/LICENSE build/wheel/unpacked/onnxruntime/ThirdPartyNotices.txt $ort_dir
  cp build/wheel/unpacked/onnxruntime/capi/libonnxruntime.so.$ort_version $ort_dir/lib/
  ln -sf libonnxruntime.so.$ort_version $ort_dir/lib/libonnxruntime.so.1
  ln -sf libonnxruntime.so.1 $ort_dir/lib/libonnxruntime.so
  rm -rf build/wheel
}

# Debian 13's index, from the mirror this machine already uses, in an apt folder of our own: the system's sources and
# lists stay as they are.
fetch_headers() {
  say "fetching ONNX Runtime's headers out of Debian 13's libonnxruntime-dev"
  mirrors=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    awk -v r=$release '$2 == r && $3 == "main" && !seen[$1]++ {print $1}')
  if [ -z "$mirrors" ]; then # no index yet: everything was installed without one
    as_root apt-get update -q
    mirrors=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
      awk -v r=$release '$2 == r && $3 == "main" && !seen[$1]++ {print $1}')
  fi
  [ "$mirrors" ] || die "apt knows no source for $release main; add one to /etc/apt/sources.list and run this again"
  rm -rf build/apt
  mkdir -p build/apt/lists/partial build/apt/cache/archives/partial build/apt/parts $ort_dir/include
  for mirror in $mirrors; do
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror trixie main"
  done >build/apt/sources.list
  here=$(pwd)
  set -- -q -o Dir::Etc::SourceList="$here/build/apt/sources.list" -o Dir::Etc::SourceParts="$here/build/apt/parts" \
    -o Dir::State::Lists="$here/build/apt/lists" -o Dir::Cache="$here/build/apt/cache" -o APT::Sandbox::User=root -o Acquire::IndexTargets::deb::DEP-11::DefaultEnabled=false
  apt-get "$@" update
  (cd build/apt && apt-get "$@" download libonnxruntime-dev)
  dpkg -x build/apt/libonnxruntime-dev_*.deb build/apt/unpacked
  check_sha256 build/apt/unpacked/usr/include/onnxruntime/onnxruntime_c_api.h $header_sha256
  cp build/apt/unpacked/usr/include/onnxruntime/*.h $ort_dir/include/
  rm -rf build/apt
}

if [ $release = bookworm ]; then
  [ "$wheel_platform" ] || die "ONNX Runtime has no wheel for $(dpkg --print-architecture); use Debian 13 there"
  [ -e $ort_dir/lib/libonnxruntime.so.1 ] || fetch_library
  [ -e $ort_dir/include/onnxruntime_c_api.h ] || fetch_headers
  say "ONNX Runtime $ort_version is in $ort_dir"
fi

if [ "$build" ]; then
  say "building"
  make -j"$(nproc)" all
  say "done: try ./vsss sim"
fi
