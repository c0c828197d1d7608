#!/bin/sh
# Finds what this machine has for the optional parts of vsss and writes, under the folder given:
#   features.mk   HAVE_NAME := version (empty: missing), read by deploy/features.mk
#   features.txt  one line per feature for people: found and version, or missing and what to install
# Both are only touched when they change, so that make rebuilds exactly when the machine did.
folder=$1
mkdir -p "$folder" || exit 1
mk=$folder/features.mk.new
txt=$folder/features.txt.new
: >"$mk"
: >"$txt"

version_of() { dpkg-query -W -f '${Version}\n' "$@" 2>/dev/null | head -n 1 | sed 's/^[0-9]*://; s/[-+].*//'; }

# feature NAME PACKAGE WHAT-FOR FILE...: found when every FILE (a shell pattern each) exists.
feature() {
  name=$1 package=$2 purpose=$3
  shift 3
  found=yes
  for pattern; do
    # shellcheck disable=SC2086 # the pattern is meant to expand
    set -- $pattern
    [ -e "$1" ] || found=
  done
  if [ "$found" ]; then
    version=$(version_of "$package")
    printf 'HAVE_%s := %s\n' "$name" "${version:-yes}" >>"$mk"
    printf '%-12s found    %-10s %s\n' "$name" "${version:-here}" "$purpose" >>"$txt"
  else
    printf 'HAVE_%s :=\n' "$name" >>"$mk"
    printf '%-12s missing  %-10s %s: apt install %s (or sh deploy/setup.sh)\n' "$name" '' "$purpose" "$package" >>"$txt"
  fi
}

feature MUJOCO libmujoco-dev "physics (required)" /usr/include/mujoco/mujoco.h
feature LCM liblcm-dev "messages, logger, replay, spy" /usr/include/lcm/lcm.h /usr/bin/lcm-gen
feature PROTOBUFC libprotobuf-c-dev "the league's network: serve" /usr/include/protobuf-c/protobuf-c.h /usr/bin/protoc-c
feature CIVETWEB libcivetweb-dev "the page of view" /usr/include/civetweb.h
feature APRILTAG libapriltag-dev "robot tags" /usr/include/apriltag/apriltag.h
feature OPENCV libopencv-dev "cameras, calibration, images" /usr/include/opencv4/opencv2/core.hpp
feature JPEG libjpeg62-turbo-dev "cameras that give MJPG, faster" /usr/include/jpeglib.h
feature EGL libegl-dev "rendering: video and rig" /usr/include/EGL/egl.h
feature ONEDNN libdnnl-dev "training, faster" /usr/include/oneapi/dnnl/dnnl.h
feature OPENBLAS libopenblas-dev "training" '/usr/include/*/cblas.h'
feature TORCH libtorch-dev "training with libtorch, oracle of the tests" /usr/include/torch/csrc/api/include/torch/torch.h
feature MPI libopenmpi-dev "training on many machines" '/usr/lib/*/openmpi/include/mpi.h'
feature CMOCKA libcmocka-dev "tests" /usr/include/cmocka.h
if [ -f /usr/include/onnxruntime/onnxruntime_c_api.h ]; then
  feature ONNXRUNTIME libonnxruntime-dev "learned policies" /usr/include/onnxruntime/onnxruntime_c_api.h
else
  feature ONNXRUNTIME onnxruntime "learned policies" build/onnxruntime/include/onnxruntime_c_api.h build/onnxruntime/lib/libonnxruntime.so.1
  # Debian 12 has no package of it: only setup.sh brings it.
  sed -i 's/apt install onnxruntime (or \(sh [^)]*\))/\1/' "$txt"
fi

keep_or_replace() { if cmp -s "$1.new" "$1"; then rm "$1.new"; else mv "$1.new" "$1"; fi; }
keep_or_replace "$folder/features.mk"
keep_or_replace "$folder/features.txt"
