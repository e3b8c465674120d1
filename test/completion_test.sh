#!/usr/bin/env bash
# Completes command lines as bash does after the Tab key. Usage: completion_test.sh EXERCISE3 COMPLETION CHECK_FRAMES
set -euo pipefail
program=$1
cd "$(mktemp -d)"
trap 'rm -rf "$PWD"' EXIT
touch chain.txt 'two words.txt'
mkdir charts
source "$2"

# expect WORDS REPLIES: the last word is completed; bash splits words also at =
expect() {
  local line=${1//=/ = } expected=$2
  IFS=' ' read -r -a COMP_WORDS <<< "$program $line"
  [[ $line = *' ' || -z $line ]] && COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  _spring_pendulum "$program" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
  local IFS=,
  [ "${COMPREPLY[*]}" = "$expected" ] || { echo "'$line': '${COMPREPLY[*]}' instead of '$expected'"; exit 1; }
}

expect 'Eu' 'Euler'
expect 'runge' 'Runge-Kutta-2,Runge-Kutta-4'
expect 'Euler ch' 'chain.txt,charts'
expect 'Euler --time' '--time-step'
expect 'Euler --particles ch' 'chain.txt,charts'
expect 'Euler -p ch' 'chain.txt,charts'
expect 'Euler --output ch' 'charts'
expect 'Euler -o ch' 'charts'
expect 'Euler --reference ' 'auto,always,never'
expect 'Euler --time-step ' ''
expect 'Euler --check ch' 'chain.txt,charts'
expect 'Euler -/ ch' 'chain.txt,charts'
expect 'Euler two' 'two words.txt'
expect 'Euler --start=' 'file,at_rest'
expect '--par' '--particles'
program=$3
expect 'ch' 'charts'
expect 'charts ch' 'charts'
expect 'charts --method runge' 'Runge-Kutta-2,Runge-Kutta-4'
expect 'charts --particles ch' 'chain.txt,charts'
expect 'charts --li' '--list-methods'
