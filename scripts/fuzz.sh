#!/usr/bin/env bash
# Runs the fuzz targets with sanitizers: particle files, parameter files, the command line, the
# validation of parameters, and the frames of students.
# Usage: scripts/fuzz.sh [RUNS]   (per target, default 16000)
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

runs=${1:-16000}
folder=$build-fuzz
"$project/scripts/setup.sh" core sanitize
say "building the fuzz targets into $folder"
CXX=clang++ configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRING_PENDULUM_TESTS=OFF -DSPRING_PENDULUM_FUZZ=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DSPRING_PENDULUM_SANITIZE=fuzzer-no-link,address,undefined
targets=(particle_file scenario_file command_line parameters frames)
compile "$folder" "${targets[@]/%/_fuzz}"

# libFuzzer adds new inputs to the first folder, so this is a temporary one.
found=$(mktemp -d)
trap 'rm -rf "$found"' EXIT
for target in "${targets[@]}"; do
  say "$runs runs of $target"
  mkdir "$found/$target"
  "$folder/fuzz/${target}_fuzz" -runs="$runs" -seed=1 -timeout=10 -max_len=2000 -print_funcs=0 \
    -artifact_prefix="$folder/" "$found/$target" "$project/fuzz/corpus/$target" \
    > "$folder/$target.log" 2>&1 || { tail -n 50 "$folder/$target.log" >&2; die "$target failed"; }
  grep '^Done' "$folder/$target.log"
done
