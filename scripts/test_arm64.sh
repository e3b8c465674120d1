#!/usr/bin/env bash
# Compiles the model and all methods for 64-bit ARM, runs them under qemu, and compares the bits of
# every method with the native build. Needs scripts/setup.sh arm64.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

"$project/scripts/setup.sh" core arm64
folder=$project/build-arm64
mkdir -p "$folder/include" "$folder/objects"
# Only headers, without those of the native C library.
for header in fmt eigen3/Eigen; do
  ln -sfn "/usr/include/$header" "$folder/include/${header##*/}"
done

compile_one() {
  local object=$folder/objects/${1//\//_}.o
  aarch64-linux-gnu-g++ -O1 -DNDEBUG -std=c++17 -ffp-contract=off -fno-math-errno \
    -fno-trapping-math -DFMT_HEADER_ONLY -I"$folder/include" -I"$project/include" \
    -I"$project/src" -c "$project/$1" -o "$object"
}
export -f compile_one
export folder project

say "compiling for 64-bit ARM"
rm -f "$folder"/objects/*.o
(cd "$project" && ls src/base/*.cpp src/model/*.cpp src/integration/*.cpp src/integration/*/*.cpp \
  src/integration/kernels/instruction_sets/baseline.cpp \
  src/simulation/{judge,reference_run}.cpp test/support/method_bits.cpp) |
  xargs -P "$(nproc)" -I{} bash -c 'compile_one {}'
aarch64-linux-gnu-g++ -static "$folder"/objects/*.o -pthread -o "$folder/method_bits"

say "comparing the bits of every method"
configure "$build"
compile "$build" method_bits
"$build/test/method_bits" > "$folder/here.txt"
qemu-aarch64 "$folder/method_bits" > "$folder/arm64.txt"
diff "$folder/here.txt" "$folder/arm64.txt" || die "64-bit ARM gives other bits"
[ -s "$folder/here.txt" ] || die "no method was run"
SPRING_PENDULUM_INSTRUCTION_SET=baseline "$build/test/method_bits" |
  diff "$folder/here.txt" - || die "the baseline kernels give other bits"
say "the same bits for $(wc -l < "$folder/here.txt") methods"
