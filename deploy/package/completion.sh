#!/bin/sh
# Completion for bash, from the help texts, which are printed from the flag tables: completion.sh VSSS > completions/vsss
vsss=$1
commands=$("$vsss" --help | awk '/^  [a-z]/ {print $1}' | tr '\n' ' ')
schemes=$("$vsss" help eval | awk '/^Players/ {on = 1; next} /^$/ {on = 0} on {print $1}' | tr '\n' ' ')
cat <<END
# Made by deploy/package/completion.sh.
_vsss() {
  local word=\${COMP_WORDS[COMP_CWORD]} before=\${COMP_WORDS[COMP_CWORD-1]} flags uris
  COMPREPLY=()
  if [ "\$COMP_CWORD" = 1 ] || { [ "\$COMP_CWORD" = 2 ] && [ "\$before" = help ]; }; then
    COMPREPLY=(\$(compgen -W "$commands help --help --version" -- "\$word"))
    return
  fi
  case \${COMP_WORDS[1]} in
END
for command in $commands; do
  "$vsss" help "$command" | awk -v command="$command" '
    /^  --/ {flags = flags " " $1; if ($2 ~ /^URI/) uris = uris (uris == "" ? "" : "|") $1}
    END {printf "  %s) flags=\"%s\" uris=\"%s\" ;;\n", command, substr(flags, 2), uris}'
done
cat <<END
  esac
  if [ -n "\$uris" ] && [[ \$before =~ ^(\$uris)\$ ]]; then
    COMPREPLY=(\$(compgen -W "$schemes" -- "\$word"))
    compopt -o nospace
  elif [[ \$word == -* ]]; then
    COMPREPLY=(\$(compgen -W "\$flags" -- "\$word"))
  else
    compopt -o default
  fi
}
# A colon is part of a word here, as in onnx:FILE.
COMP_WORDBREAKS=\${COMP_WORDBREAKS//:/}
complete -F _vsss vsss
END
