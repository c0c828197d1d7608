#!/bin/sh
# Every page that code or another page names is in the tree, and links lead somewhere.
cd "$(dirname "$0")/../.." || exit 1
bad=0
for page in $(git grep -ohE '\b[A-Za-z0-9_]+(\.(pt|es))?\.md\b' -- src include tests models deploy Makefile README.md CONTRIBUTING.md | sort -u); do
  [ -n "$(git ls-files -co --exclude-standard "*/$page" "$page")" ] || { echo "$page is named by: $(git grep -lF "$page" | tr '\n' ' ')and is not in the tree"; bad=1; }
done
for file in $(git ls-files -co --exclude-standard '*.md'); do
  # shellcheck disable=SC2013 # links have no spaces
  for link in $(grep -oE '\]\([^)#:]+\)' "$file" | sed 's/^](//; s/)$//'); do
    [ -e "$(dirname "$file")/$link" ] || { echo "$file: links to $link, which is not there"; bad=1; }
  done
done
exit $bad
