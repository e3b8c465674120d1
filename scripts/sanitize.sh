#!/usr/bin/env bash
# Builds the core and its unit tests with sanitizers and runs them.
# Usage: scripts/sanitize.sh address,undefined | thread   [arguments of ctest]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

sanitizers=${1:?which sanitizers? address,undefined or thread}
shift
folder=$build-${sanitizers%%,*}
"$project/scripts/setup.sh" core test
say "building with -fsanitize=$sanitizers into $folder"
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRING_PENDULUM_SANITIZE="$sanitizers"
compile "$folder"
cd "$folder"
# The thread sanitizer slows the kernels down.
if [ "$sanitizers" = thread ]; then set -- -E "$long_tests" "$@"; fi
exec ctest --output-on-failure -j "$(nproc)" -L 'unit' "$@"
