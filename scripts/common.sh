# Sourced by every script: project folder, PATH, and build functions.

unset CDPATH  # with it, cd may go elsewhere and print where
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${SPRING_PENDULUM_BUILD:-$project/build}

# devel_of FOLDER: the devel space of a build folder. rosrun does not look below PACKAGE/build.
devel_of() { [ "$1" = "$project/build" ] && echo "$project/devel" || echo "$1/devel"; }

# The Python modules of ROS belong to the python3 of the system. Another python3 on the PATH (pyenv,
# conda) has neither catkin_pkg nor rospy.
export PATH=/usr/bin:$PATH

say() { printf '%s\n' "-- $*"; }
die() { printf '%s\n' "$*" >&2; exit 1; }

# configure FOLDER [CMake options]; prints nothing unless it fails
configure() {
  { mkdir -p "$1" && [ -w "$1" ]; } ||
    die "cannot write to $1: set SPRING_PENDULUM_BUILD to a build folder of your own"
  local folder devel
  folder=$(cd "$1" && pwd); shift
  devel=$(devel_of "$folder")
  [ "$devel" = "$folder/devel" ] || rm -rf "$folder/devel"  # from an older layout
  cmake -S "$project" -B "$folder" -G Ninja -DCATKIN_DEVEL_PREFIX="$devel" \
    -DSPRING_PENDULUM_TESTS=ON "$@" \
    > "$folder/configure.log" 2>&1 || { cat "$folder/configure.log" >&2; return 1; }
}

# compile FOLDER [targets]; shows progress, and the output of the compiler if it fails
compile() {
  local folder=$1; shift
  NINJA_STATUS='[%p] ' ninja -C "$folder" "$@" 2>&1 | tee "$folder/compile.log" | show_progress ||
    { grep -v '^\[' "$folder/compile.log" >&2; return 1; }
}

# Shows the progress of ninja in percent: on a terminal in one line, otherwise every tenth.
show_progress() {
  local line percent shown=0
  while IFS= read -r line; do
    [[ $line =~ ^\[\ *([0-9]+)%\] ]] || continue
    percent=${BASH_REMATCH[1]}
    if [ -t 1 ]; then
      printf '\r-- built %s %%' "$percent"
    elif [ "$percent" -ge $((shown + 10)) ]; then
      shown=$((percent / 10 * 10))
      say "built $shown %"
    fi
  done
  if [ -t 1 ]; then printf '\r\033[K'; fi
}

# For ctest -E: measurements that repeat shorter tests on larger or on many random scenes, and with the
# products of extreme options all long tests. They take half of the time of the unit tests.
long_measurements='NeverComesBeforeAStableRun'
long_measurements+='|RandomScenes\.KeepTheTolerance|OnLongAndLightChains|TenMillionSteps'
long_measurements+='|LinearLimitIsDefinedInEveryCorner|LargestStableStepIsThat'
long_measurements+='|HangingChain\.MovesAsItsModes/[23]'
long_measurements+='|StaysWithinItsUncertainty/(feather|alternating)'
long_tests=$long_measurements'|RandomOptions|ExtremeValues'

have_ros() { [ -x /usr/bin/catkin_make ] && [ -x /usr/bin/roslaunch ]; }

# program NAME: path of the built program (catkin has its own folder for executables).
program() {
  local folder
  for folder in "$(devel_of "$build")/lib/spring_pendulum" "$build"; do
    [ -x "$folder/$1" ] && { echo "$folder/$1"; return; }
  done
  die "the build made no $1"
}
