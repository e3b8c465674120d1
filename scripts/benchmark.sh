#!/usr/bin/env bash
# Builds the benchmarks, runs them and draws their plots; see docs/benchmarks.md.
# Usage: scripts/benchmark.sh [PART] [options], PART one of throughput, end-to-end, skips, accuracy,
#        tolerance, stability, all, smoke
#   all (default)  everything, into benchmark/results
#   smoke          a few points of everything, in seconds, into the build folder, to check that it runs
#   options        of a benchmark, for example: accuracy --scene light_100 --passes 3
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

what=${1:-all}
[ $# -gt 0 ] && shift
folder=$build-benchmark
results=$project/benchmark/results
reports=$project/benchmark/reports
[ "$what" = smoke ] && results=$folder/smoke

# run PROGRAM [options]: exits if a peer does not agree with the others
run() {
  local name=$1; shift
  say "$name"
  if [ "$what" = smoke ]; then set -- --smoke 1 "$@"; fi
  "$folder/benchmark/benchmark_$name" --output "$results" "$@" > "$folder/$name.log"
}

throughput() {
  run throughput "$@"
  "$reports/plot_throughput.py" "$results/throughput.csv" "$results" > "$results/throughput.md"
}
end_to_end() {
  run end_to_end "$@"
  "$reports/table.py" "$results/end_to_end.csv" > "$results/end_to_end.md"
}
skips() {
  run skips "$@"
  "$reports/table.py" "$results/skips.csv" > "$results/skips.md"
}
accuracy() {
  run work_precision "$@"
  "$reports/plot_work_precision.py" "$results/work_precision.csv" "$results"
  "$reports/cheapest_methods.py" "$results/work_precision.csv" > "$results/cheapest_methods.md"
}

tolerance() {
  local status=0
  run tolerance --limit 900 "$@" || status=$?
  local name
  for name in tolerance tolerance_random; do
    [ ! -f "$results/$name.csv" ] || "$reports/tolerance.py" "$results/$name.csv" > "$results/$name.md"
  done
  return $status
}
stability() {
  local study=$project/config/studies/stability_map.yaml
  say stability
  if [ "$what" = smoke ]; then
    mkdir -p "$folder/config/studies" && ln -sfn "$project/data" "$folder/data"
    sed 's/, 48\]/, 4]/' "$study" > "$folder/config/studies/stability_map.yaml"
    study=$folder/config/studies/stability_map.yaml
  fi
  "$folder/sweep" "$study" --output "$results/stability_map.csv" --plot "$@" > "$folder/stability.log"
  [ "$what" = smoke ] || mv "$results/stability_map.png" "$project/docs/"
}

case $what in
  throughput | skips | accuracy | tolerance | stability) wanted=$what ;;
  end-to-end) wanted=end_to_end ;;
  # The last one, as it exits with an error if a tolerance is not met.
  all | smoke) wanted="throughput end_to_end skips accuracy stability tolerance" ;;
  *) die "benchmark.sh: unknown benchmark '$what'; known benchmarks: throughput, end-to-end, skips," \
         "accuracy, tolerance, stability, all, smoke" ;;
esac

"$project/scripts/setup.sh" core benchmark
say "building into $folder"
configure "$folder" -DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_BUILD_TYPE=Release \
  -DSPRING_PENDULUM_TESTS=OFF -DSPRING_PENDULUM_BENCHMARKS=ON
compile "$folder"
mkdir -p "$results"
git() { command git -c safe.directory="$project" -C "$project" "$@" 2> /dev/null; }
SPRING_PENDULUM_COMMIT=$(git describe --always || echo unknown)
# Results do not change what is measured.
git diff --quiet HEAD -- . ':!benchmark/results' ':!docs' || SPRING_PENDULUM_COMMIT+=-dirty
export SPRING_PENDULUM_COMMIT
for benchmark in $wanted; do "$benchmark" "$@"; done
say "results: $results"
