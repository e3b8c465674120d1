#!/usr/bin/env bash
# Builds the core and its tests with other compilers and configurations, and runs the tests except the
# long accuracy measurements.
# Usage: scripts/compilers.sh [--bits] [COMPILER:CONFIGURATION ...]   (default: clang++:Release)
# --bits: only compares the bits of every method with those of the usual build.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

bits=
if [ "${1:-}" = --bits ]; then shift; bits=method_bits; fi
[ $# -gt 0 ] || set -- clang++:Release
"$project/scripts/setup.sh" core test compilers
if [ "$bits" ]; then
  configure "$build"
  compile "$build" $bits
fi
for run in "$@"; do
  compiler=${run%:*} configuration=${run#*:}
  command -v "$compiler" > /dev/null || die "there is no $compiler: install its package"
  folder=$build-$compiler-$configuration
  say "building with $compiler $configuration into $folder"
  configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE="$configuration"
  compile "$folder" $bits
  if [ "$bits" ]; then
    "$build/test/$bits" > "$folder/usual.txt"
    "$folder/test/$bits" | diff "$folder/usual.txt" - || die "$compiler $configuration gives other bits"
    say "the same bits for $(wc -l < "$folder/usual.txt") methods"
  else
    (cd "$folder" && ctest --output-on-failure -j "$(nproc)" -L 'unit|process' -E "$long_tests")
  fi
done
