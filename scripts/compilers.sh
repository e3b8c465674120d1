#!/usr/bin/env bash
# Builds the core and its tests with other compilers and configurations, and runs the tests except the
# long accuracy measurements.
# Usage: scripts/compilers.sh [--integration] [COMPILER:CONFIGURATION ...]   (default: clang++:Release)
# --integration: only the methods and their tests, whose bits depend on the compiler most.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

targets=() tests=()
if [ "${1:-}" = --integration ]; then
  shift
  cd "$project/test"
  mapfile -t targets < <(find integration -name '*_test.cpp' | tr / _ | sed 's/\.cpp$//')
  tests=(-R "^($(find integration -type d -printf '%f|')none)\\.")
fi
[ $# -gt 0 ] || set -- clang++:Release
"$project/scripts/setup.sh" core test compilers
for run in "$@"; do
  compiler=${run%:*} configuration=${run#*:}
  command -v "$compiler" > /dev/null || die "there is no $compiler: install its package"
  folder=$build-$compiler-$configuration
  say "building with $compiler $configuration into $folder"
  configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE="$configuration"
  compile "$folder" "${targets[@]}"
  (cd "$folder" && ctest --output-on-failure -j "$(nproc)" -L 'unit|process' -E "$long_tests" "${tests[@]}")
done
