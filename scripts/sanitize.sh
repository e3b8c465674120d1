#!/usr/bin/env bash
# Builds tests with sanitizers and runs them. The address sanitizer: the unit tests except measurements
# of accuracy, and tests of the Python module. The thread sanitizer: what has threads, which are some
# unit tests, sweep, and with ROS the node.
# Usage: scripts/sanitize.sh address,undefined | thread   [arguments of ctest]
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

sanitizers=${1:?which sanitizers? address,undefined or thread}
shift
folder=$build-${sanitizers%%,*}
without_ros=ON without_python=ON
if [ "$sanitizers" = thread ] && have_ros; then without_ros=OFF; fi
case $sanitizers in address*) without_python=OFF ;; esac
"$project/scripts/setup.sh" core test $([ $without_python = ON ] || echo python)
say "building with -fsanitize=$sanitizers into $folder"
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=$without_ros \
  -DCMAKE_DISABLE_FIND_PACKAGE_pybind11=$without_python \
  -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRING_PENDULUM_SANITIZE="$sanitizers"
cd "$folder"
if [ "$sanitizers" = thread ]; then
  compile . unit_tests_with_threads process_sweep_test \
    $([ $without_ros = ON ] || echo pendulum_node fault_injection spring_pendulum_generate_messages)
  # The thread sanitizer slows the kernels down, so it leaves out the long tests.
  # The sanitizer supports no threads in a forked process.
  ctest --output-on-failure -j "$(nproc)" -L unit_with_threads -E "$long_tests|InAForkedProcess" "$@"
  ctest --output-on-failure -j "$(nproc)" -R 'Sweep\.' -E RowsAreRunsOfExercise3 "$@"
else
  compile . unit_tests $([ $without_python = ON ] || echo spring_pendulum_python Exercise3)
  ctest --output-on-failure -j "$(nproc)" -L unit -E "$long_measurements" "$@"
fi
if [ $without_python = OFF ]; then
  ctest --output-on-failure -j "$(nproc)" -R '^python\.(misuse|objects)$'
fi
if [ $without_ros = OFF ]; then
  # They call every service; ros.services takes three minutes more here.
  TSAN_OPTIONS="suppressions=$project/test/ros/thread_sanitizer_suppressions.txt" \
    ctest --output-on-failure -j "$(nproc)" -R '^ros\.(ends|sim_time)$'
fi
