#!/usr/bin/env bash
# Installs what was built, and runs the installed programs. A catkin workspace, which would compile all
# of it again, is only configured. For CMake 4, some releases of catkin are too old.
# Usage: install_test.sh CMAKE BUILD
set -euo pipefail

workspace=$(mktemp -d)
trap 'rm -rf "$workspace"' EXIT
project=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$workspace/src" "$workspace/run"
ln -sfn "$project" "$workspace/src/spring_pendulum"
{ CMAKE_POLICY_VERSION_MINIMUM=3.5 catkin_make -C "$workspace" -DSPRING_PENDULUM_TESTS=OFF cmake_check_build_system &&
  "$1" -DCMAKE_INSTALL_PREFIX="$workspace/install" -P "$2/cmake_install.cmake"; } \
  > "$workspace/build.log" 2>&1 || { tail -n 50 "$workspace/build.log"; exit 1; }

# Without the environment of the build.
cd "$workspace/run"
cat > user.sh << 'USER'
set -eo pipefail
source "$1/install/setup.bash"
check() { "$@" || { echo "failed: $*"; exit 1; }; }
check [ "$(rospack find spring_pendulum)" = "$1/install/share/spring_pendulum" ]
share=$(rospack find spring_pendulum)
for file in launch/pendulum.launch launch/compare.launch launch/record.launch launch/replay.launch \
            launch/view.launch rviz/pendulum.rviz rviz/compare.rviz config/pendulum.yaml \
            data/particle.txt data/animate_pendulum.plt msg/PendulumState.msg; do
  check [ -f "$share/$file" ]
done
check [ -f "$1/install/include/spring_pendulum/PendulumState.h" ]
check [ -f "$1/install/include/spring_pendulum/spring_pendulum.hpp" ]
check rosrun spring_pendulum Exercise3 Runge-Kutta-4 --particles "$share/data/particle.txt" \
  --frames 5 --output expected > /dev/null
check rosrun spring_pendulum record_bag Euler --particles "$share/data/particle.txt" \
  --frames 5 --bag one.bag > /dev/null
# The Python module and the messages are one package.
if ls "$1"/install/lib/python3*/dist-packages/spring_pendulum/_core.* > /dev/null 2>&1; then
  check python3 -c 'import sys, spring_pendulum as sp, spring_pendulum.msg
assert sp.__file__.startswith(sys.argv[1]), sp.__file__
assert spring_pendulum.msg.PendulumState()
assert sp.simulate(sys.argv[2]).verdict.kind == "ok"' "$1/install" "$share/data/particle.txt"
fi
rosmaster --core -p "$2" > master.log 2>&1 & master=$!
trap 'kill $master; wait $master 2> /dev/null || true' EXIT
until rosparam list > /dev/null 2>&1; do sleep 0.2; done
check rosrun spring_pendulum pendulum_node _particles:="$share/data/particle.txt" _frames:=5 \
  _output:="$PWD/node" _at_end:=exit > node.log 2>&1
check diff -r expected node
check roslaunch spring_pendulum pendulum.launch rviz:=false at_end:=exit frames:=5 \
  output:="$PWD/launched" > launch.log 2>&1
check diff -r expected launched
rosparam delete /pendulum_node
check rosmsg show spring_pendulum/PendulumState > /dev/null
echo "installed and running"
USER
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
env -i PATH=/usr/bin:/bin HOME="$workspace/run" ROS_MASTER_URI=http://127.0.0.1:"$port" \
  ROS_IP=127.0.0.1 bash user.sh "$workspace" "$port"
