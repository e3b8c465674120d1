#!/usr/bin/env bash
# Runs the fuzz targets with sanitizers: particle files, parameter files, the command line, the
# validation of parameters, and the frames of students.
# Usage: scripts/fuzz.sh [RUNS]   (per target, default 16000)
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

runs=${1:-16000}
folder=$build-fuzz
"$project/scripts/setup.sh" core sanitize
say "building the fuzz targets into $folder"
CXX=clang++ configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRING_PENDULUM_TESTS=OFF -DSPRING_PENDULUM_FUZZ=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DSPRING_PENDULUM_SANITIZE=fuzzer-no-link,address,undefined
targets=(particle_file scenario_file command_line parameters frames)
compile "$folder" "${targets[@]/%/_fuzz}"

# The seeds of a target are in one file, each under a line '==> NAME' and followed by a line end.
split_seeds() {
  python3 - "$1" "$2" << 'EOF'
import pathlib, sys
text = b'\n' + pathlib.Path(sys.argv[1]).read_bytes()[:-1]
for seed in text.split(b'\n==> ')[1:]:
    name, content = seed.split(b'\n', 1)
    (pathlib.Path(sys.argv[2]) / name.decode()).write_bytes(content)
EOF
}

# libFuzzer adds new inputs to the first folder.
found=$(mktemp -d)
trap 'rm -rf "$found"' EXIT
for target in "${targets[@]}"; do
  say "$runs runs of $target"
  mkdir -p "$found/$target" "$found/seeds/$target"
  split_seeds "$project/fuzz/corpus/$target.txt" "$found/seeds/$target"
  if [ "$target" = scenario_file ]; then cp "$project/config/pendulum.yaml" "$found/seeds/$target"; fi
  "$folder/fuzz/${target}_fuzz" -runs="$runs" -seed=1 -timeout=10 -max_len=2000 -print_funcs=0 \
    -artifact_prefix="$folder/" "$found/$target" "$found/seeds/$target" \
    > "$folder/$target.log" 2>&1 || { tail -n 50 "$folder/$target.log" >&2; die "$target failed"; }
  grep '^Done' "$folder/$target.log"
done
