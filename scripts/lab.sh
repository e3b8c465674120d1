#!/usr/bin/env bash
# Makes output/pendulum_lab.html: the library and a page around it in one file, which opens in a browser
# without network. Installs missing packages first.
# Usage: scripts/lab.sh [--test]     --test also runs the tests in a browser
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

[ $# -eq 0 ] || [ "$*" = --test ] || die "unexpected '$*': scripts/lab.sh [--test]"
"$project/scripts/setup.sh" lab
for needed in em++ esbuild; do
  command -v $needed > /dev/null || die "this release has no package for $needed"
done
# The tools of emscripten are a node program; another node on the PATH does not look into this folder.
export NODE_PATH=/usr/share/nodejs
toolchain=$(dirname "$(readlink -f "$(command -v em++)")")/cmake/Modules/Platform/Emscripten.cmake
folder=${SPRING_PENDULUM_LAB_BUILD:-$project/build-lab}
say "building the library for the browser into $folder (a few minutes the first time)"
mkdir -p "$folder" "$project/output"
cmake -S "$project/web" -B "$folder" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$toolchain" \
  > "$folder/configure.log" 2>&1 || { cat "$folder/configure.log" >&2; exit 1; }
compile "$folder"
page=$project/output/pendulum_lab.html
"$project/web/assemble.py" "$folder" "$page"
say "page: $page"
[ $# -eq 0 ] || exec "$project/test/web/browser_test.py" "$page" "$(program Exercise3)"
