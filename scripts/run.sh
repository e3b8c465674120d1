#!/usr/bin/env bash
# Installs what is missing, builds, and lets the pendulum swing: frames and a moving picture.
# Usage: scripts/run.sh [METHOD] [options of Exercise3]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

output=$project/output
"$project/scripts/setup.sh" core ros
say "building into $build"
configure "$build"
compile "$build" Exercise3

method=Runge-Kutta-4
if [ $# -gt 0 ] && [[ $1 != -* ]]; then method=$1; shift; fi

"$(program Exercise3)" "$method" --particles "$project/data/particle.txt" --output "$output" "$@"
(cd "$output" && gnuplot -e "load \"$project/data/animate_pendulum.plt\"")
say "frames: $output/frame_0000.txt to $(ls "$output" | grep '^frame_' | tail -n 1)"
say "moving picture: $output/pendulum.gif"
