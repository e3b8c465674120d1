#!/usr/bin/env bash
# Compiles consumer.cpp with other compilers and vector options than the library, and runs it.
# Usage: consumer_test.sh LIBRARY COMPILER FLAG...   (flags of every build: where the headers are)
set -euo pipefail
library=$1 compiler=$2
shift 2
source=$(dirname "${BASH_SOURCE[0]}")/consumer.cpp
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

check() {
  printf '%s\n' "$*"
  "$@" -std=c++17 "${common[@]}" "$source" "$library" -Wl,-rpath,"$(dirname "$library")" \
    -o "$folder/consumer"
  "$folder/consumer"
}

common=("$@")
check "$compiler" -O0
check "$compiler" -O2 -march=native
check "$compiler" -O2 -DEIGEN_MAX_ALIGN_BYTES=0
check "$compiler" -O2 -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=64
check "$compiler" -O2 -DEIGEN_DONT_VECTORIZE
if command -v clang++ > /dev/null; then
  check clang++ -O1
  check clang++ -O2 -march=native
fi
