#!/bin/sh
# What a packager needs: the Debian package asks for every library that deploy/setup.sh installs to build against, and the
# packager's CPPFLAGS, CFLAGS, CXXFLAGS and LDFLAGS reach every compiler and linker.
cd "$(dirname "$0")/../.." || exit 1
bad=0
say() {
  echo "$1"
  bad=1
}
wanted=$(sed -n '/^# What each package is for/,/^# The names/p' deploy/setup.sh | grep -oE '(z?lib[a-z0-9.-]*-(dev|bin)|[a-z-]+-compiler)( |$)' |
  tr -d ' ' | sort -u)
[ "$wanted" ] || say "deploy/setup.sh: no packages found"
depends=$(sed -n '/^Build-Depends:/,/^Standards/p' deploy/debian/control | tr ',| ' '\n')
for package in $wanted; do
  printf '%s\n' "$depends" | grep -qx "$package" || say "deploy/debian/control: Build-Depends lacks $package, which setup.sh installs"
done

# A folder of its own: other flags would have everything in build/plain compiled again.
commands=$(make -nB V=1 B=build/lint CPPFLAGS=-DCPP_MARK CFLAGS=-DC_MARK CXXFLAGS=-DCXX_MARK LDFLAGS=-Wl,-z,now all build/lint/libvsss.so 2>/dev/null |
  sed -e :a -e '/\\$/N; s/\\\n//; ta')
rm -rf build/lint
[ "$(printf '%s\n' "$commands" | grep -c ' -c -o ')" -gt 100 ] || say "make -n shows no compilers"
without() { # what, of which commands, the flag
  missing=$(printf '%s\n' "$commands" | grep -E -e "$2" | grep -vF -e "$3" | cut -c 1-200)
  [ -z "$missing" ] || { say "$1 without $3:"; printf '%s\n' "$missing" | sed 's/^/  /'; }
}
without "compiled" ' -c -o ' -DCPP_MARK
without "compiled" '^(cc|gcc|clang) .* -c -o ' -DC_MARK
without "compiled" '^(c[+][+]|g[+][+]|clang[+][+]) .* -c -o ' -DCXX_MARK
without "linked" '^(cc|c[+][+]|gcc|g[+][+]|clang|clang[+][+]) [^|]* -o (vsss|[^ ]*[.]so[^ ]*) ' -Wl,-z,now
exit $bad
