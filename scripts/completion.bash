# Completion in bash for Exercise3, check_frames and record_bag: options, their values, methods and files. All names
# come from the program's --help. Installed where bash-completion finds it; else: source this file.

# Completes the word with paths: -f all, -d folders.
_spring_pendulum_paths() {
  mapfile -t COMPREPLY < <(compgen "$1" -- "$word")
}

_spring_pendulum() {
  local program=$1 word=$2 previous=$3 help values= methods option reset
  COMPREPLY=()
  help=$("$program" --help 2> /dev/null) || return
  # Bash splits --option=value into three words.
  [ "$previous" = = ] && previous=${COMP_WORDS[COMP_CWORD - 2]}
  case $previous in -p) previous=--particles ;; -o) previous=--output ;; esac
  # A placeholder follows its option after one space, the description of a switch after several.
  [[ $previous =~ ^--[a-z-]+$ ]] && values=$(sed -nE "s/^ +(-. \[ )?$previous( \])? ([^ ]+)( .*)?$/\3/p" <<< "$help")
  case $previous,$values in
    -*,FILE) _spring_pendulum_paths -f; return ;;
    -*,DIR) _spring_pendulum_paths -d; return ;;
    -*,*'|'*) COMPREPLY=($(compgen -W "${values//|/ }" -- "$word")); return ;;
    -*,METHOD) ;;
    -*,?*) return ;;  # a number
    *) if [[ $word != -* && $help = *' DIR ... [options]'* ]]; then
         _spring_pendulum_paths -d; return
       fi ;;
  esac
  if [[ $word = -* ]]; then
    COMPREPLY=($(compgen -W "$(sed -nE 's/^ +(-. \[ )?(--[a-z-]+).*/\2/p' <<< "$help")" -- "$word"))
    return
  fi
  methods=$(sed -n 's/^Methods: //p' <<< "$help")
  for option in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [ "$values" = METHOD ] && break
    case ", $methods," in *", $option,"*) _spring_pendulum_paths -f; return ;; esac
  done
  reset=$(shopt -p nocasematch) || true
  shopt -s nocasematch
  for option in ${methods//,/}; do
    [[ $option = "$word"* ]] && COMPREPLY+=("$option")
  done
  $reset
}
complete -o filenames -F _spring_pendulum Exercise3 check_frames record_bag
complete -o filenames -o default -F _spring_pendulum sweep
