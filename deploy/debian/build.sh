#!/bin/sh
# Builds the Debian packages of this commit into build/debian: sh deploy/debian/build.sh. Wants what deploy/setup.sh installs, and
# debhelper. On Debian 12 the ONNX Runtime that setup.sh fetched goes into libvsss1; on 13 its package is recommended.
set -eu
cd "$(dirname "$0")/../.."
command -v dh >/dev/null || { echo "build.sh: debhelper is missing: apt install debhelper" >&2; exit 1; }
part() { sed -n "s/^#define VSSS_VERSION_$1 //p" include/vsss/version.h; }
version=$(part MAJOR).$(part MINOR).$(part PATCH)
commit=$(git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown)
tree=build/debian/vsss-$version
rm -rf build/debian
mkdir -p "$tree"
git ls-files -z | xargs -0 tar -cf - | tar -xf - -C "$tree"
cp -r deploy/debian "$tree/debian"
[ ! -d build/onnxruntime ] || { mkdir -p "$tree/build" && cp -r build/onnxruntime "$tree/build"; }
# The release is said once, in version.h; the date is the commit's.
cat >"$tree/debian/changelog" <<END
vsss ($version) unstable; urgency=medium

  * See deploy/docs/CHANGELOG.md. Built from commit $commit.

 -- the vsss authors <vsss@localhost>  $(git log -1 --format=%aD 2>/dev/null || date -R)
END
(cd "$tree" && COMMIT=$commit dpkg-buildpackage -b -us -uc -d "$@")
rm -rf "$tree"
ls -l build/debian/*.deb
