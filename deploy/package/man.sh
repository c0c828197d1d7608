#!/bin/sh
# The manual page, from the help texts, which are printed from the flag tables: man.sh VSSS > vsss.1
vsss=$1
version=$("$vsss" --version | sed -n '1s/^vsss \([^ ]*\).*/\1/p')
escape() { sed 's/\\/\\e/g; s/-/\\-/g; s/^\([.'"'"']\)/\\\&\1/'; }
cat <<END
.TH VSSS 1 "" "vsss $version" "User Commands"
.SH NAME
vsss \\- IEEE Very Small Size Soccer: simulate, learn, play on the field
.SH SYNOPSIS
.B vsss
.I COMMAND
.RI [ flags ]
.br
.B vsss help
.I COMMAND
.br
.B vsss \\-\\-version
.SH COMMANDS
END
"$vsss" --help | awk '/^  [a-z]/ {name = $1; $1 = ""; print ".TP\n.B " name "\n" substr($0, 2)}'
for command in $("$vsss" --help | awk '/^  [a-z]/ {print $1}'); do
  printf '.SH VSSS %s\n.nf\n' "$(echo "$command" | tr '[:lower:]' '[:upper:]')"
  "$vsss" help "$command" | escape
  printf '.fi\n'
done
cat <<END
.SH EXIT STATUS
0 when all went well, 1 when the work failed, 2 when it was asked for wrongly.
.SH ENVIRONMENT
.TP
.B VSSS_HOME
folder with models/ and the other files of the program
.TP
.B LCM_DEFAULT_URL
the bus, unless a flag names one
END
