# Completion of thimble in bash: commands and options are asked of the program itself, so that they
# are never out of date, and so are the names of scenes and arms; what is neither is a file.
_thimble_names() {
  compgen -W "$("${COMP_WORDS[0]}" run --list 2>/dev/null |
    sed -n "/^$1:/,/^[A-Z]/s/^  \([^ ][^ ]*\) .*/\1/p")" -- "$2"
}
_thimble() {
  local word=${COMP_WORDS[COMP_CWORD]} words=() i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${COMP_WORDS[i]} == -* ]] || words+=("${COMP_WORDS[i]}")
  done
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" ${words[0]:+"${words[0]}"} --help 2>/dev/null |
      grep -oE '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,')" -- "$word")
  elif ((${#words[@]} == 0)) || [[ ${words[0]} == @(study|mesh) && ${#words[@]} == 1 ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" ${words[0]:+"${words[0]}"} --help 2>/dev/null |
      sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\).*/\1/p')" -- "$word")
  elif [[ ${COMP_WORDS[COMP_CWORD - 1]} == --arm ]]; then
    mapfile -t COMPREPLY < <(_thimble_names Arms "$word")
  elif ((${#words[@]} == 1)) && [[ ${words[0]} == @(run|shot|tune|bench) ]] ||
    [[ ${words[*]} == "study gating" || ${COMP_WORDS[COMP_CWORD - 1]} == --scene ]]; then
    mapfile -t COMPREPLY < <(_thimble_names Scenes "$word")
  fi
  ((${#COMPREPLY[@]} > 0)) || mapfile -t COMPREPLY < <(compgen -f -- "$word")
}
complete -o filenames -F _thimble thimble
