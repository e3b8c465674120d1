#!/usr/bin/env bash
# Format, clang-tidy on every source, catkin_lint. Any finding fails.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

"$project/scripts/setup.sh" core ros test-ros benchmark lint
cd "$project"
mapfile -t sources < <(git -c safe.directory="$project" ls-files '*.hpp' '*.cpp')
say "clang-format on ${#sources[@]} files"
clang-format --dry-run -Werror "${sources[@]}"

folder=$build-lint
configure "$folder" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DSPRING_PENDULUM_BENCHMARKS=ON \
  -DSPRING_PENDULUM_FUZZ=ON
if have_ros; then compile "$folder" spring_pendulum_generate_messages_cpp; fi
"$project/scripts/lint_units.py" "$folder" "$folder/units"
say "clang-tidy"
# tidy REGEX [checks to add or take away]
tidy() {
  run-clang-tidy -quiet -j "$(nproc)" -p "$folder/units" -config "$(cat .clang-tidy)" \
    ${2:+"-checks=$2"} "$folder/units/$1" > "$folder/tidy.log" 2>&1 ||
    { grep -E 'warning:|error:' "$folder/tidy.log" | sort -u >&2; die "clang-tidy found something"; }
}
tidy src
# The static analyzer takes minutes for all else, and tests run under the sanitizers anyway.
tidy '(test|benchmark|fuzz)' '-clang-analyzer-*'

# What is ignored: the build without ROS makes catkin optional and installs to other folders; the
# scripts, the benchmarks and the fuzz targets belong to the checkout; Eigen's and GSL's variables,
# generated files, and ROS's headers as system headers are unknown to the linter.
say "catkin_lint"
catkin_lint -W1 --strict --quiet --resolve-env --offline \
  --ignore missing_required,wrong_install_destination,uninstalled_script \
  --ignore unconfigured_system_depend,missing_file,uninstalled_target,missing_cmake_modules \
  --ignore external_directory,external_interface_path,ambiguous_condition "$project"
