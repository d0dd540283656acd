# Completion of thread in bash: the program itself says what may follow.
_thread()
{
  local IFS=$'\n' word=${COMP_WORDS[COMP_CWORD]}
  [[ $word == = ]] && word=
  mapfile -t COMPREPLY < <(compgen -W "$(thread complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null | cut -f 1)" -- "$word")
}
complete -o default -F _thread thread
