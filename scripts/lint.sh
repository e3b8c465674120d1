#!/usr/bin/env bash
# Format, structure of the sources, clang-tidy, catkin_lint. Any finding fails.
# Usage: scripts/lint.sh [--all | BASE]
# clang-tidy checks the sources that changed since BASE (a commit; default: where this branch left
# origin/main, on main itself the last commit); with --all it checks every source.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

"$project/scripts/setup.sh" core mpi python ros test-ros benchmark lint
cd "$project"
git() { command git -c safe.directory="$project" "$@"; }

# base_commit: the commit to compare with; nothing if the history is too short.
base_commit() {
  local base
  base=$(git merge-base HEAD origin/main 2> /dev/null || true)
  [ "$base" != "$(git rev-parse HEAD)" ] || base=
  [ -n "$base" ] || base=$(git rev-parse -q --verify HEAD~1 || true)
  echo "$base"
}

mapfile -t sources < <(git ls-files '*.hpp' '*.cpp')
say "clang-format on ${#sources[@]} files"
clang-format --dry-run -Werror "${sources[@]}"

say "includes, public headers, length of files"
scripts/lint_sources.py check

say "the recipes of CONTRIBUTING.md"
scripts/recipes.py apply

case ${1:-} in
  --all) base= ;;
  '') base=$(base_commit) ;;
  *) base=$(git rev-parse --verify "$1^{commit}") ;;
esac
mapfile -t sources < <(scripts/lint_sources.py tidy $base)
say "clang-tidy on ${#sources[@]} sources${base:+ changed since $base}"
folder=$build-lint
configure "$folder" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DSPRING_PENDULUM_BENCHMARKS=ON \
  -DSPRING_PENDULUM_FUZZ=ON
if have_ros; then compile "$folder" spring_pendulum_generate_messages_cpp; fi

# One process per source, as many in parallel as there are processors. The configuration files in
# test/, benchmark/, fuzz/ and examples/ disable the slow path-sensitive analysis.
compiled=()
for source in "${sources[@]}"; do
  # Other sources need a package that is not installed.
  grep -qF "\"file\": \"$project/$source\"" "$folder/compile_commands.json" && compiled+=("$source")
done
[ ${#compiled[@]} -eq 0 ] || printf '%s\0' "${compiled[@]}" | xargs -0 -n 1 -P "$(nproc)" \
  clang-tidy --quiet -p "$folder" > "$folder/tidy.log" 2>&1 ||
  { grep -E 'warning:|error:' "$folder/tidy.log" | sort -u >&2; die "clang-tidy found something"; }

# Ignored checks: the build without ROS makes catkin optional and installs to other folders; scripts,
# benchmarks and fuzz targets are not installed; the linter does not know the variables of Eigen and
# GSL, generated files, and ROS headers as system headers.
say "catkin_lint"
catkin_lint -W1 --strict --quiet --resolve-env --offline \
  --ignore missing_required,wrong_install_destination,uninstalled_script \
  --ignore unconfigured_system_depend,missing_file,uninstalled_target,missing_cmake_modules \
  --ignore external_directory,external_interface_path,ambiguous_condition "$project"
