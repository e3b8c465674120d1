#!/usr/bin/env bash
# Format, clang-tidy on every source, catkin_lint. Any finding fails.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

"$project/scripts/setup.sh" core ros test-ros lint
cd "$project"
mapfile -t sources < <(find include src test benchmark fuzz -name '*.hpp' -o -name '*.cpp')
say "clang-format on ${#sources[@]} files"
clang-format --dry-run -Werror "${sources[@]}"

# clang-tidy wants every generated header, so the tree must have been built (scripts/test.sh).
[ -f "$build/compile_commands.json" ] || { configure "$build"; compile "$build"; }
say "clang-tidy"
run-clang-tidy -quiet -p "$build" "$project/(src|test)/.*\.cpp" > "$build/tidy.log" 2>&1 ||
  { grep -E 'warning:|error:' "$build/tidy.log" | sort -u >&2; die "clang-tidy found something"; }

say "catkin_lint"
catkin_lint -W2 --strict --resolve-env --offline "$project"
