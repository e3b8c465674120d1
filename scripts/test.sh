#!/usr/bin/env bash
# Installs missing packages, builds, and runs every test. Arguments go to ctest (-R NAME, -V, ...).
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

"$project/scripts/setup.sh" core mpi python test film lab ros rviz test-ros
say "building into $build"
configure "$build"
compile "$build"
cd "$build"
# More tests than processors: those of the node wait most of the time.
exec ctest --output-on-failure -j "$((2 * $(nproc)))" "$@"
