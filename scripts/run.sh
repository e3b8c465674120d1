#!/usr/bin/env bash
# Installs missing packages, builds, and runs a pendulum: frame files, an animation and, with ROS, a
# bag. With a display, opens rviz on the running node.
# Usage: scripts/run.sh [METHOD [FILE]] [options of Exercise3]
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

export LC_ALL=C.UTF-8  # awk reads and prints decimal points
method=Runge-Kutta-4 given=' '
if [ $# -gt 0 ] && [[ $1 != -* ]]; then method=$1 given+='method '; shift; fi

# Options given here override these, also for the bag and the node.
particles=$project/data/particle.txt
output=$project/output
options=()
parameters=()  # the same for the node: `--time-step 0.01` is `time_step: 0.01` there
full_path() { [ -z "$1" ] || realpath -m -- "$1"; }  # an empty path is for Exercise3 to refuse
state='' has_state=false config=''  # the time of the saved state gives the animation its speed
answers=false
has_file=false
while [ $# -gt 0 ]; do
  option=$1; shift
  case $option in -p) option=--particles ;; -o) option=--output ;; esac
  case $option in
    --check | --help | -h | --version | --list-methods | --no-frames) answers=true ;;
    --resume) parameters+=(resume=true) ;;
    --*=*) set -- "${option%%=*}" "${option#*=}" "$@"; continue ;;
    --*)
      [ $# -gt 0 ] || die "$option needs a value, see --help"
      value=$1; shift
      case $option in
        --output) output=$(full_path "$value"); given+='output '; continue ;;
        --particles) particles=$(full_path "$value"); given+='particles '; continue ;;
        --config) config=$(full_path "$value"); options+=("$option" "$config"); continue ;;
        --energy) value=$(full_path "$value") ;;
        --save-state) value=$(full_path "$value"); state=$value; has_state=true ;;
      esac
      options+=("$option" "$value")
      key=${option#--}
      parameters+=("${key//-/_}=$value")
      continue ;;
    *)
      ! $has_file && [[ $option != -* ]] ||
        die "unexpected '$option': scripts/run.sh [METHOD [FILE]] [options of Exercise3]"
      has_file=true; given+='particles '
      particles=$(full_path "$option")
      continue ;;
  esac
  options+=("$option")
done
keys=''
for key in method particles output; do
  if [[ $given != *" $key "* ]] && sed -E 's/(^|[[:space:]])#.*//' "${config:-/dev/null}" 2> /dev/null |
    grep -E "(^|[^[:alnum:]_#-])[\"']?${key}[\"']?[[:space:]]*:" > /dev/null; then keys+=" $key"; fi
done
[ -z "$keys" ] ||
  die "$config sets$keys: give them to scripts/run.sh [METHOD [FILE]] [--output FOLDER] as well"

"$project/scripts/setup.sh" core mpi python ros
say "building into $build (a few minutes the first time)"
configure "$build"
programs=(Exercise3 check_frames sweep)
for target in spring_pendulum_python pendulum_node record_bag \
  spring_pendulum_generate_messages; do
  if grep -qs "^build $target:" "$build/build.ninja"; then programs+=("$target"); fi
done
compile "$build" "${programs[@]}"

simulate=("$(program Exercise3)" "$method" --particles "$particles" --output "$output" "${options[@]}")
if $answers; then exec "${simulate[@]}"; fi
own=$(mktemp -d)
trap 'rm -rf "$own"' EXIT
trap 'exit 130' INT  # also if a program that it interrupts says nothing of it
if ! $has_state; then
  state=$own/state
  # If the configuration saves the state in a file of its own, a second run saves it here.
  if [ -n "$config" ] && grep -qs save_state "$config"; then "${simulate[@]}" | tee -i "$own/closing"; simulate+=(--no-frames); fi
  simulate+=(--save-state "$state")
fi
"${simulate[@]}" | tee -ia "$own/closing"
# Frames of an earlier run may lie there if this one writes none.
has_frames=false
if grep -q ' writing to ' "$own/closing"; then has_frames=true; say "frames: in $output"; fi

interval=$(sed -En 's/^# state of .* at frame ([0-9]+), t = (.+) s$/\1 \2/p' "${state:-/dev/null}" | awk '$1 > 0 { printf "%.9g", $2 / $1 }')
if ! $has_frames; then
  say "no animation: this run wrote no frames"
else
  film="frame_interval = ${interval:-0.1}; load '${project//\'/\'\'}/data/animate_pendulum.plt'"
  if (cd "$output" && gnuplot -e "$film" 2> "$own/errors"); then
    say "animation: $output/pendulum.gif"
  else
    say "no animation: gnuplot failed"; cat "$own/errors" >&2
  fi
fi
rm -rf "$own"
have_ros || { say "this machine has no ROS 1: no bag, no rviz"; exit 0; }

"$(program record_bag)" "$method" --particles "$particles" --bag "$output/pendulum.bag" "${options[@]}"
say "bag: $output/pendulum.bag"

run=("method:=$method" "particles:=$particles" "output:=$output/node")
pairs=()
for parameter in "${parameters[@]}"; do
  value=${parameter#*=}
  pairs+=("${parameter%%=*}: '${value//\'/\'\'}'")
done
launch=("${run[@]}" ${config:+"config:=$config"} "params:={$(IFS=,; printf '%s' "${pairs[*]}")}")
setup=$(devel_of "$build")/setup.bash
if [ -n "${DISPLAY:-}" ]; then
  "$project/scripts/setup.sh" rviz
  set +u
  source "$setup"
  exec roslaunch spring_pendulum pendulum.launch "${launch[@]}"
fi
say "to see it move in rviz, on a machine with a display:"
printf '  source %q\n' "$setup"
printf '  roslaunch spring_pendulum pendulum.launch'; printf ' %q' "${launch[@]}"; printf '\n'
say "completion of methods, options and files in bash:"
printf '  source %q\n' "$project/scripts/completion.bash"
say "the node alone (needs a running roscore):"
printf '  source %q\n' "$setup"
if [ -n "$config" ]; then printf '  rosparam load %q /pendulum_node\n' "$config"; fi
printf '  rosrun spring_pendulum pendulum_node'; printf ' _%q' "${run[@]}" "${parameters[@]/=/:=}"; printf '\n'
