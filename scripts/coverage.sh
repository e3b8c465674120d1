#!/usr/bin/env bash
# Measures the coverage of the core (model, integration, simulation, io). The lines that report errors
# are listed separately.
# Usage: scripts/coverage.sh [LEAST]   (required percentage of lines, default 95)
# The kernels do not count: they are compiled for every instruction set, and a processor has only some.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

least=${1:-95}
folder=$build-coverage
"$project/scripts/setup.sh" core test sanitize
say "building for coverage into $folder"
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g0 --coverage -fprofile-update=atomic"
compile "$folder"
find "$folder" -name '*.gcda' -delete
(cd "$folder" && ctest --output-on-failure -j "$(nproc)" -L 'unit|process' > ctest.log) ||
  { tail -n 50 "$folder/ctest.log" >&2; die "a test failed"; }
cd "$project"  # gcovr takes its filters from here
gcovr --root "$project" --object-directory "$folder" "$folder" \
  --filter 'src/(base|model|integration|simulation|io)/' \
  --filter 'include/spring_pendulum/' --exclude 'src/integration/kernels/' \
  --exclude-throw-branches --exclude-unreachable-branches --json "$folder/coverage.json"
"$project/scripts/error_branches.py" "$project" "$folder/coverage.json"
exec gcovr --root "$project" --add-tracefile "$folder/coverage.json" \
  --fail-under-line "$least" --print-summary
