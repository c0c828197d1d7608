#!/bin/sh
# Checks the includes of every source file against src/LAYERS.
cd "$(dirname "$0")/../.." || exit 1
find src include -name '*.c' -o -name '*.h' -o -name '*.cpp' | sort | xargs awk '
  BEGIN {
    while ((getline line < "src/LAYERS") > 0) {
      if (line ~ /^#/ || line == "") continue
      n = split(line, w, /[ :]+/)
      if (w[1] == "header") { owner[w[2]] = w[3]; continue }
      known[w[1]] = 1
      for (i = 2; i <= n; i++) if (w[i] != "") allowed[w[1], w[i]] = 1
    }
  }
  FNR == 1 {
    n = split(FILENAME, p, "/")
    if (p[1] == "src") me = p[2]
    else { me = p[n]; sub(/\.h$/, "", me); if (!(me in owner)) { print FILENAME ": header has no owner in src/LAYERS"; bad = 1; me = ""; } else me = owner[me] }
    if (me != "" && !(me in known)) { print FILENAME ": module " me " is not in src/LAYERS"; bad = 1 }
  }
  /^[ \t]*#[ \t]*include[ \t]*"/ {
    match($0, /"[^"]*"/); inc = substr($0, RSTART + 1, RLENGTH - 2)
    n = split(inc, p, "/")
    if (p[1] == "vsss") { h = p[n]; sub(/\.h$/, "", h); to = owner[h]; if (to == "") { print FILENAME ":" FNR ": " inc " has no owner in src/LAYERS"; bad = 1; next } }
    else if (n > 1 && (p[1] in known)) to = p[1]
    else next
    if (me != "" && to != me && !((me, to) in allowed)) { print FILENAME ":" FNR ": " me " may not include " inc " (" to ")"; bad = 1 }
  }
  END { exit bad }
'
