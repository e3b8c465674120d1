#!/usr/bin/env bash
# Runs the tests of the kernels in the release build under valgrind's memcheck. The address sanitizer
# leaves the kernels out (cmake/instruction_sets.cmake).
# Usage: scripts/memcheck.sh [arguments of the test programs, for example --gtest_filter=*Short*]
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

"$project/scripts/setup.sh" core test sanitize
tests=(integration_{kernels_chain_kernels,kernels_instruction_sets,fixed_step_explicit_runge_kutta}_test
       integration_{embedded_embedded_runge_kutta_stepper,taylor_taylor_stepper,taylor_stabilized_taylor_stepper}_test)
say "building into $build"
configure "$build"
compile "$build" "${tests[@]}"

# Valgrind knows AVX2 but not AVX-512. With this setting, tests that cannot use AVX2 fail.
if grep -qw avx2 /proc/cpuinfo; then export SPRING_PENDULUM_INSTRUCTION_SET=avx2; fi
memcheck() {
  local test=$1 log=$build/$1.memcheck; shift
  valgrind --quiet --error-exitcode=1 "$build/test/$test" "$@" > "$log" 2>&1 ||
    { cat "$log" >&2; die "$test failed under memcheck"; }
  say "$test passed"
}
for test in "${tests[@]}"; do memcheck "$test" "$@" & done
failures=0
for job in $(jobs -p); do wait "$job" || failures=$((failures + 1)); done
exit $((failures > 0))
