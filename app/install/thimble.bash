# Bash completion of thimble. Commands, options, and names of scenes and arms come from the output of the program, so
# they are never out of date. Other words are completed as files.
_thimble_names() {
  compgen -W "$("${COMP_WORDS[0]}" run --list 2>/dev/null |
    sed -n "/^$1:/,/^[A-Z]/s/^  \([^ ][^ ]*\) .*/\1/p")" -- "$2"
}
# _thimble_options COMMAND: the options in the help of the command
_thimble_options() {
  "${COMP_WORDS[0]}" ${1:+"$1"} --help 2>/dev/null |
    sed -nE 's/^  ((-[a-z],)?--[a-z0-9-]+(,--[a-z0-9-]+)*).*/\1/p' | tr ',' ' '
}
# _thimble_choices COMMAND OPTION: the values of an option, if its help lists them in braces; a long list has several lines
_thimble_choices() {
  "${COMP_WORDS[0]}" ${1:+"$1"} --help 2>/dev/null | awk -v option="$2" '
    /^  -/ { inside = 0 }
    $1 == option || $1 ~ "(^|,)" option "$" { inside = 1 }
    inside { text = text $0 }
    inside && /}/ { exit }
    END { if (sub(/^[^{]*{/, "", text) && sub(/}.*/, "", text)) { gsub(/[, ]+/, " ", text); print text } }'
}
_thimble() {
  local before=${COMP_WORDS[COMP_CWORD - 1]} choices
  local word=${COMP_WORDS[COMP_CWORD]} words=() i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${COMP_WORDS[i]} == -* ]] || words+=("${COMP_WORDS[i]}")
  done
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(_thimble_options "${words[0]:-}")" -- "$word")
  elif [[ $before == --hold-to-run ]]; then
    mapfile -t COMPREPLY < <(compgen -W "button key" -- "$word")
  elif [[ $before == --?* ]] && choices=$(_thimble_choices "${words[0]:-}" "$before") && [ -n "$choices" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
  elif ((${#words[@]} == 0)) || [[ ${words[0]} == @(study|mesh) && ${#words[@]} == 1 ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" ${words[0]:+"${words[0]}"} --help 2>/dev/null |
      sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\).*/\1/p')" -- "$word")
  elif [[ $before == --arm ]]; then
    mapfile -t COMPREPLY < <(_thimble_names Arms "$word")
  elif ((${#words[@]} == 1)) && [[ ${words[0]} == @(run|shot|tune|bench) ]] ||
    [[ ${words[*]} == "study gating" || $before == --scene ]]; then
    mapfile -t COMPREPLY < <(_thimble_names Scenes "$word")
  fi
  ((${#COMPREPLY[@]} > 0)) || mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -o filenames -F _thimble thimble
