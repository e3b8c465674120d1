#!/usr/bin/env bash
# Records topics into a bag until it is interrupted, and fails if no bag was written.
# Usage: record.sh BAG TOPIC ...
set -euo pipefail

[ $# -ge 2 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
bag=$1; shift
[[ $bag = *.bag ]] || bag+=.bag
topics=()
for argument in "$@"; do [[ $argument = __* ]] || topics+=("$argument"); done

fail() { printf '\n[FATAL] no bag was written to %s: %s\n' "$(realpath -m "$bag")" "$1" >&2; exit 1; }
mkdir -p "$(dirname "$bag")" 2> /dev/null || fail "the folder cannot be created"
[ -w "$(dirname "$bag")" ] || fail "no permission to write in the folder"
# An earlier bag stays until rosbag renames the new one over it.
earlier=$(stat -c %i "$bag" 2> /dev/null || true)
[ ! -e "$bag" ] || { [ -f "$bag" ] && [ -w "$bag" ]; } || fail "the existing bag cannot be replaced"

# In a separate process group, so that the recorder gets only the SIGINT of this script.
setsid env --default-signal=INT rosrun rosbag record -O "$bag" "${topics[@]}" & recorder=$!
trap 'kill -INT "$recorder" 2> /dev/null' INT TERM
status=0
until wait "$recorder"; do status=$?; kill -0 "$recorder" 2> /dev/null || break; done
[ -f "$bag" ] && [ "$(stat -c %i "$bag")" != "$earlier" ] || fail "the recorder ended with status $status"
