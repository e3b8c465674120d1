#!/usr/bin/env bash
# Builds the core and its unit tests with sanitizers and runs them; with the thread sanitizer and ROS
# also the node and tests of its threads, with the address sanitizer also tests of the Python module.
# Usage: scripts/sanitize.sh address,undefined | thread   [arguments of ctest]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

sanitizers=${1:?which sanitizers? address,undefined or thread}
shift
folder=$build-${sanitizers%%,*}
without_ros=ON without_python=ON
if [ "$sanitizers" = thread ] && have_ros; then without_ros=OFF; fi
case $sanitizers in address*) without_python=OFF ;; esac
"$project/scripts/setup.sh" core test $([ $without_python = ON ] || echo python)
say "building with -fsanitize=$sanitizers into $folder"
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=$without_ros \
  -DCMAKE_DISABLE_FIND_PACKAGE_pybind11=$without_python -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRING_PENDULUM_SANITIZE="$sanitizers"
compile "$folder"
cd "$folder"
# The thread sanitizer slows the kernels down, so it leaves out the long tests.
if [ "$sanitizers" = thread ]; then set -- -E "$long_tests" "$@"; fi
ctest --output-on-failure -j "$(nproc)" -L 'unit' "$@"
if [ $without_python = OFF ]; then
  ctest --output-on-failure -j "$(nproc)" -R '^python\.(misuse|objects)$'
fi
if [ $without_ros = OFF ]; then
  TSAN_OPTIONS="suppressions=$project/test/ros/thread_sanitizer_suppressions.txt" \
    ctest --output-on-failure -R '^ros\.(ends|services|sim_time)$'
fi
