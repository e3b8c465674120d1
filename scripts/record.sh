#!/usr/bin/env bash
# Records topics into a bag until it is interrupted, and fails if no bag was written.
# Usage: record.sh BAG TOPIC ...
set -euo pipefail

# A script starts its jobs with SIGINT ignored, which no trap undoes.
[ -n "${RECORD_TAKES_SIGINT-}" ] || RECORD_TAKES_SIGINT=1 exec env --default-signal=INT bash "$0" "$@"
asked=
trap 'asked=1; [ -z "${recorder-}" ] || kill -INT "$recorder" 2> /dev/null || :' HUP INT TERM

[ $# -ge 2 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
bag=$1; shift
[[ $bag = *.bag ]] || bag+=.bag
bag=$(realpath -m -- "$bag")  # of a symbolic link, the file it leads to
fail() { printf '\n[FATAL] no bag was written to %s: %s\n' "$bag" "$1" >&2; exit 1; }
topics=()
for argument in "$@"; do
  [[ $argument != --sp* ]] || fail "--split would make several bags"
  [[ $argument != [A-Za-z]* ]] || argument=$(tr -s / <<< "/${ROS_NAMESPACE-}/$argument")  # rosbag writes names as they are
  topics+=("$argument")  # also the name that roslaunch gives
done

mkdir -p "$(dirname "$bag")" 2> /dev/null || fail "the folder cannot be created"
[ -w "$(dirname "$bag")" ] || fail "no permission to write in the folder"
[ ! -e "$bag" ] || { [ -f "$bag" ] && [ -w "$bag" ]; } || fail "the existing bag cannot be replaced"

# An earlier bag stays until the new one is complete and has messages.
# If this script is killed, the recording is left beside the bag.
part=$(mktemp -u "${bag%.bag}.XXXXXX.bag")
trap 'rm -f "$part" "$part.active"' EXIT
has_messages() { [ "$(stat -c %s "$1" 2> /dev/null || echo 0)" -gt 4117 ]; }  # the size of an empty bag

# In a separate process group, so that the recorder gets only the SIGINT of this script.
setsid env --default-signal=INT rosrun rosbag record -O "$part" "${topics[@]}" & recorder=$!
status=0
[ -n "$asked" ] || wait "$recorder" || status=$?
if [ -n "$asked" ]; then
  while kill -INT "$recorder" 2> /dev/null; do sleep 0.2 || :; done  # at first, the recorder ignores it
  status=0
  wait "$recorder" || status=$?
fi
trap '' HUP INT TERM  # a second signal must not end what follows, which takes no time
if has_messages "$part.active"; then
  mv -fT "$part.active" "$bag.active"
  fail "the recorder ended with status $status; rosbag reindex may repair $bag.active"
fi
has_messages "$part" || fail "nothing was recorded (the recorder ended with status $status)"
# The recorder ends with 1 where it stops on its own, for example with less than 1 GB of space.
if [ "$status" -eq 1 ] || ! mv -fT "$part" "$bag"; then
  trap - EXIT
  fail "what was recorded is in $part"
fi
printf '[INFO] recorded %s\n' "$bag"
