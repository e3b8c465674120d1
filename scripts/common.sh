# Sourced by every script: where the project is, a sane PATH, and the build.

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${SPRING_PENDULUM_BUILD:-$project/build}

# ROS's Python modules belong to the system's python3: another one before it on the PATH (pyenv,
# conda) knows neither catkin_pkg nor rospy.
export PATH=/usr/bin:$PATH

say() { printf '%s\n' "-- $*"; }
die() { printf '%s\n' "$*" >&2; exit 1; }

# configure FOLDER [CMake options]; says nothing unless it fails
configure() {
  local folder=$1; shift
  mkdir -p "$folder"
  cmake -S "$project" -B "$folder" -G Ninja -DCATKIN_DEVEL_PREFIX="$folder/devel" "$@" \
    > "$folder/configure.log" 2>&1 || { cat "$folder/configure.log" >&2; return 1; }
}

# compile FOLDER [targets]
compile() {
  local folder=$1; shift
  ninja -C "$folder" "$@" > "$folder/compile.log" 2>&1 ||
    { grep -v '^\[' "$folder/compile.log" >&2; return 1; }
}

have_ros() { [ -x /usr/bin/catkin_make ] && [ -x /usr/bin/roslaunch ]; }

# program NAME: where the build put it (catkin has its own folder for executables).
program() {
  local folder
  for folder in "$build/devel/lib/spring_pendulum" "$build"; do
    [ -x "$folder/$1" ] && { echo "$folder/$1"; return; }
  done
  die "the build made no $1"
}
