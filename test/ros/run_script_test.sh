#!/usr/bin/env bash
# scripts/run.sh, and then the commands that it prints, each in a new shell.
set -euo pipefail

project=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d "${TMPDIR:-/tmp}/run script.XXXX")
trap 'rm -rf "$folder"' EXIT
check() { "$@" || { echo "failed: $*"; exit 1; }; }

# The scripts find their project also where cd searches other folders and prints the one it found.
cd "$project"
check test "$(CDPATH=.:/ bash -c 'source scripts/common.sh; echo "$project"')" = "$project"

cd "$folder"
run() { env -i LC_ALL=de_DE.UTF-8 PATH="$PATH" HOME="$folder" SPRING_PENDULUM_BUILD="$build" "$project/scripts/run.sh" "$@" > run.log 2>&1; }
build=$1
! run Euler --output= || exit 1
check test "$(grep -v '^-- ' run.log)" = "--output: must be a folder, got ''"
run Runge-Kutta-2 --frames 5 --steps-per-frame 5 --damping=0 --output frames --gravity -9 || { cat run.log; exit 1; }
check env LC_ALL=C grep -qaP '\x21\xf9\x04.\x05\x00' frames/pendulum.gif  # 0.05 s per picture
check test -s frames/pendulum.bag
cp run.log first.log; echo '{no_frames: true, method: Euler}' > none.yaml; ! run --config none.yaml || exit 1
check grep -q 'none.yaml sets method' run.log; run Euler --frames 5 --output frames --config none.yaml || exit 1
check grep -q 'this run wrote no frames' run.log; check grep -q 'launch.*config:=.*none.yaml' run.log; mv first.log run.log
sed -n 's/^  source /source /p' run.log | head -n 1 > setup.sh
sed -n 's/^  rosrun /rosrun /p' run.log > node.sh
sed -n 's/^  roslaunch /roslaunch /p' run.log > launch.sh
check grep -q 'damping:=0.*gravity:=-9' node.sh
check grep -q 'damping.*0.*gravity.*-9' launch.sh

cat > user.sh << 'USER'
source setup.sh
rosmaster --core -p "$1" > master.log 2>&1 & master=$!
trap 'kill $master; wait $master 2> /dev/null' EXIT
until rosparam list > /dev/null 2>&1; do sleep 0.2; done
eval "$(cat node.sh) _at_end:=exit _real_time_factor:=0" > node.log 2>&1 || { cat node.log; exit 1; }
rosmsg show spring_pendulum/PendulumState > /dev/null && rostopic echo -b frames/pendulum.bag -p /state/time > time.csv || exit 1
rosrun spring_pendulum record_bag Euler --particles "$2/data/particle.txt" --frames 5 || exit 1
USER
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
env -i PATH=/usr/bin:/bin HOME="$folder" ROS_MASTER_URI=http://127.0.0.1:"$port" ROS_IP=127.0.0.1 \
  bash user.sh "$port" "$project"
check test "$(wc -l < time.csv)" -gt 5
check test -s pendulum.bag
for frame in frames/frame_*.txt; do check cmp "$frame" "frames/node/${frame#frames/}"; done
echo "run.sh and its commands work"
