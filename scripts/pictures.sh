#!/usr/bin/env bash
# Makes the pictures of the documents: docs/pendulum.gif, docs/compare.gif, docs/run_time_error.png and
# docs/verification.png.
# docs/pull.gif and docs/rviz_window.png need a virtual display: scripts/pictures.sh rviz
# docs/run_time_error.png is drawn from the results of scripts/benchmark.sh accuracy, if there are any.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

"$project/scripts/setup.sh" core python ros
configure "$build"
compile "$build" Exercise3 spring_pendulum_python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
docs=$project/docs

pendulum() {
  "$(program Exercise3)" Auto --particles "$project/data/horizontal_11.txt" --stiffness 400 \
    --frame-interval 0.04 --frames 250 --output "$work/pendulum"
  (cd "$work/pendulum" &&
    gnuplot -e "frame_interval = 0.04; load '$project/data/animate_pendulum.plt'" 2> /dev/null)
  mv "$work/pendulum/pendulum.gif" "$docs/pendulum.gif"
}

# The energy of two of the three methods is out of bounds, so Exercise3 exits with an error.
compare() {
  for method in Euler Runge-Kutta-2 Runge-Kutta-4; do
    "$(program Exercise3)" "$method" --particles "$project/data/particle.txt" --damping 0 \
      --time-step 0.05 --steps-per-frame 1 --frames 161 --output "$work/$method" \
      --energy "$work/$method.csv" || [ $? = 3 ]
  done
  "$(program Exercise3)" Auto --tolerance 1e-9 --particles "$project/data/particle.txt" --damping 0 \
    --frame-interval 0.05 --frames 161 --output "$work/Truth"
  (cd "$work" && gnuplot "$docs/plots/compare.plt" 2> /dev/null)
  mv "$work/compare.gif" "$docs/compare.gif"
}

plots() {
  local results=$project/benchmark/results/work_precision.csv
  [ ! -f "$results" ] ||
    "$project/benchmark/reports/plot_run_time_error.py" "$results" horizontal_11 "$docs/run_time_error"
  PYTHONPATH=$(devel_of "$build")/lib/python3/dist-packages "$docs/plots/verification.py"
}

# A chain with visible waves: stiffer springs, heavier and lighter particles.
rviz() {
  "$project/scripts/setup.sh" ros rviz film test-ros
  compile "$build" record_bag pendulum_node
  "$(program record_bag)" Auto --particles "$project/data/random_masses.txt" --stiffness 400 \
    --frame-interval 0.04 --frames 200 --display-rate 0 --bag "$work/rviz.bag"
  "$(devel_of "$build")/env.sh" "$project/scripts/film_pull.py" "$docs/pull.gif"
  "$project/scripts/film.sh" "$work/rviz.bag" "$docs/rviz_window.png" --start 5.5 --window --size 1280x800
}

if [ $# -gt 0 ]; then
  [ "$*" = rviz ] || die "pictures.sh: unknown picture '$*'; the only one is rviz"
  rviz
  exit
fi
pendulum
compare
plots
say "pictures: $docs"
