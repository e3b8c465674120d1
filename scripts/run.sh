#!/usr/bin/env bash
# Installs what is missing, builds, and lets the pendulum swing: frames, a moving picture and, with
# ROS, a bag; with a display, rviz on the running node.
# Usage: scripts/run.sh [METHOD] [options of Exercise3]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

output=$project/output
particles=$project/data/particle.txt
method=Runge-Kutta-4
if [ $# -gt 0 ] && [[ $1 != -* ]]; then method=$1; shift; fi

"$project/scripts/setup.sh" core ros
say "building into $build"
configure "$build"
compile "$build" Exercise3 $(have_ros && echo pendulum_node record_bag)

simulate=("$(program Exercise3)" "$method" --particles "$particles" --output "$output" "$@")
for option in "$@"; do
  case $option in --check | --help | --version | --list-methods | --no-frames) exec "${simulate[@]}" ;; esac
done
"${simulate[@]}"
say "frames: $output/frame_0000.txt and so on"

(cd "$output" && gnuplot -e "load '$project/data/animate_pendulum.plt'" 2> /dev/null)
say "moving picture: $output/pendulum.gif"
have_ros || { say "this machine has no ROS 1: no bag, no rviz"; exit 0; }

"$(program record_bag)" "$method" --particles "$particles" --bag "$output/pendulum.bag" "$@"
say "bag: $output/pendulum.bag"

launch="roslaunch spring_pendulum pendulum.launch method:=$method"
if [ -n "${DISPLAY:-}" ]; then
  "$project/scripts/setup.sh" rviz
  set +u
  source "$build/devel/setup.bash"
  exec $launch output:="$output/node"
fi
say "to see it move in rviz, on a machine with a display:"
say "  source $build/devel/setup.bash && $launch"
