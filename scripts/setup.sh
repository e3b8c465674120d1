#!/usr/bin/env bash
# Installs the Debian or Ubuntu packages that are missing. Usage: scripts/setup.sh COMPONENT ...
#   core       compiler, CMake and the libraries of the simulator, Exercise3 and the GIF
#   mpi        Open MPI, optional: sweeps on many machines
#   ros        ROS 1: packages for the node, the messages and the bags
#   rviz       the viewer
#   python     the Python module, its plots and notebooks
#   test       additional packages for the tests
#   test-ros   packages for the tests of the node: rostest, a virtual display
#   film       packages for scripts/film.sh
#   lab        emscripten, the JavaScript libraries of the page, and a browser for its tests
#   cache      ccache, for .ci/run
#   lint       clang-format, clang-tidy, catkin_lint
#   sanitize   clang's sanitizers and fuzzer, valgrind, coverage
#   compilers  clang, for scripts/compilers.sh
#   releases   packages for scripts/test_releases.sh and scripts/release.sh
#   arm64      a cross compiler for 64-bit ARM, and qemu
#   benchmark  solvers to compare with, all optional
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

packages_of() {
  case $1 in
    core)
      echo g++ cmake make ninja-build libeigen3-dev libfmt-dev libyaml-cpp-dev \
           libboost-program-options-dev libgtest-dev libgmock-dev gnuplot-nox help2man ;;
    mpi) echo libopenmpi-dev openmpi-bin ;;
    ros)
      echo catkin libroscpp-dev librosbag-dev libconsole-bridge-dev libroslib-dev libvisualization-msgs-dev \
           libgeometry-msgs-dev libstd-srvs-dev libros-rosgraph-msgs-dev libtf2-msgs-dev \
           libinteractive-markers-dev libnav-msgs-dev ros-visualization-msgs ros-nav-msgs \
           ros-geometry-msgs ros-std-msgs ros-std-srvs ros-message-generation ros-message-runtime \
           python3-roslaunch python3-rosbag python3-rostopic python3-rosnode python3-rosservice \
           python3-rosparam python3-rospy python3-visualization-msgs python3-std-srvs \
           python3-geometry-msgs python3-tf2-msgs python3-nav-msgs python3-roslib rosbash ;;
    rviz) echo rviz ;;
    python)
      echo pybind11-dev python3-dev python3-numpy python3-matplotlib python3-setuptools ;;
    test) echo procps locales-all python3-scipy jupyter-nbconvert python3-ipykernel ;;
    test-ros)
      echo python3-rostest librostest-dev python3-rosmsg xvfb xauth x11-utils xdotool libgl1-mesa-dri \
           imagemagick ;;
    film) echo xvfb xauth libgl1-mesa-dri imagemagick ffmpeg ;;
    lab)
      echo emscripten cmake ninja-build libeigen3-dev libfmt-dev esbuild libjs-chart.js libjs-katex \
           python3-selenium python3-numpy chromium chromium-driver ;;
    cache) echo ccache ;;
    lint) echo git clang-format clang-tidy catkin-lint ;;
    sanitize) echo clang libclang-rt-dev valgrind gcovr ;;
    compilers) echo clang ;;
    releases) echo debootstrap dpkg-dev git ;;
    arm64) echo g++-aarch64-linux-gnu qemu-user ;;
    benchmark)
      echo libboost-dev libgsl-dev libsundials-dev libmujoco-dev libsimbody-dev python3 \
           libpython3-dev python3-scipy python3-matplotlib ;;
    *) die "setup.sh: unknown component '$1'" ;;
  esac
}

installed() { dpkg-query -W -f '${Status}\n' "$1" 2>/dev/null | grep -q 'ok installed'; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; return; fi
  command -v sudo > /dev/null || die "to install packages, run as root or install sudo"
  sudo "$@"
}

missing_packages() {
  local component package
  for component in "$@"; do
    for package in $(packages_of "$component"); do
      installed "$package" || echo "$package"
    done
  done
}

# Whether the packages of a component can be installed. CMake finds no compiler in emscripten 2.
offered() {
  apt-cache show $(packages_of "$1") > /dev/null 2>&1 || return 1
  [ "$1" != lab ] ||
    dpkg --compare-versions "$(apt-cache show emscripten | sed -n 's/^Version: //p' | head -n 1)" ge 3
}

# Not every release has ROS 1 or a recent emscripten: these components are skipped there.
offered_components() {
  local component
  for component in "$@"; do
    case $component in
      ros | rviz | test-ros | lab)
        offered "$component" || { say "this release carries no $component: left out" >&2; continue; } ;;
    esac
    echo "$component"
  done
}

[ -n "$(missing_packages "$@")" ] || exit 0
command -v apt-get > /dev/null ||
  die "needs Debian or Ubuntu; install by hand:" $(missing_packages "$@")
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Downloads are retried.
retry=(-o Acquire::Retries=3)
as_root apt-get "${retry[@]}" update > "$log" 2>&1 || say "could not update the package lists"
missing=$(missing_packages $(offered_components "$@"))
[ -n "$missing" ] || exit 0
say "installing" $missing
as_root env DEBIAN_FRONTEND=noninteractive apt-get "${retry[@]}" install -y \
  --no-install-recommends $missing > "$log" 2>&1 ||
  { tail -n 20 "$log" >&2; die "could not install the packages"; }
