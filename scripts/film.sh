#!/usr/bin/env bash
# Plays a bag in a real rviz on a virtual display and films it, at the true speed.
# Usage: scripts/film.sh BAG OUT.gif|OUT.mp4|OUT.png [options]
#   --config FILE     rviz configuration [rviz/pendulum.rviz, or rviz/compare.rviz for its topics]
#   --start S         s of the bag to leave out at the start [0]
#   --duration S      s to film [10]; for a PNG the picture at --start
#   --fps N           pictures a second [20]
#   --size WxH        of the picture [720x640]
#   --slow N          play and film so many times slower, for a slow computer [2]
#   --window          the whole window of rviz instead of the scene alone
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[ $# -ge 2 ] || { sed -n '3,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
bag=$(realpath "$1") out=$(realpath -m "$2")
shift 2
config='' start=0 duration=10 fps=20 size=720x640 slow=2 rviz_args=--fullscreen
while [ $# -gt 0 ]; do
  case $1 in
    --window) rviz_args=''; shift; continue ;;
    --config | --start | --duration | --fps | --size | --slow) ;;
    *) die "film.sh: unknown option '$1'" ;;
  esac
  [ $# -ge 2 ] || die "film.sh: $1 needs a value"
  [ "$1" = --config ] && config=$(realpath "$2") || printf -v "${1#--}" %s "$2"
  shift 2
done
[ -f "$bag" ] || die "film.sh: no bag '$bag'"
case $out in *.gif | *.mp4 | *.png) ;; *) die "film.sh: OUT must end in .gif, .mp4 or .png" ;; esac

"$project/scripts/setup.sh" ros rviz film
work=$(mktemp -d)
started=()
# Ends what was started, last first, each by its own number; rviz's launcher ends its nodes itself.
clean_up() {
  local i
  for ((i = ${#started[@]} - 1; i >= 0; i--)); do
    kill -INT "${started[i]}" 2> /dev/null || true
    timeout 20 tail --pid="${started[i]}" -f /dev/null || kill -KILL "${started[i]}" || true
  done
  rm -rf "$work"
}
trap clean_up EXIT
# A background job of a script ignores SIGINT; setsid and env start it with the default.
start() { env --default-signal=INT "$@" > "$work/$(basename "$1").log" 2>&1 & started+=($!); }
# until_true SECONDS COMMAND: tries until it succeeds
until_true() {
  local end=$((SECONDS + $1)); shift
  until "$@" > /dev/null 2>&1; do
    [ $SECONDS -lt $end ] || { cat "$work"/*.log >&2; die "film.sh: gave up waiting for: $*"; }
    sleep 0.1
  done
}

# Python finds a port that is free, and rviz the messages and files of the package.
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$work ROS_LOG_DIR=$work
export LIBGL_ALWAYS_SOFTWARE=1 QT_QPA_PLATFORM=xcb ROS_PACKAGE_PATH=$project:${ROS_PACKAGE_PATH:-/usr/share}
unset ROS_HOSTNAME

topics=$(rosbag info -y -k topics "$bag" | sed -n 's/^- topic: //p' | grep 'markers$')
if [ -z "$config" ]; then
  config=$project/rviz/pendulum.rviz
  [ "$topics" = /markers ] || config=$project/rviz/compare.rviz
fi

# rviz takes its size from the configuration.
sed -e "s/^  Width: .*/  Width: ${size%x*}/" -e "s/^  Height: .*/  Height: ${size#*x}/" "$config" \
  > "$work/film.rviz"
start Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp -noreset 3> "$work/display"
until_true 20 test -s "$work/display"
export DISPLAY=:$(cat "$work/display")
start rosmaster --core -p "$port"
until_true 20 rosparam set /use_sim_time true
rviz_listens() { for topic in $topics; do rostopic info "$topic" | grep -q '\* /rviz '; done; }
rviz_listens_or_ended() { rviz_listens || ! kill -0 "${started[-1]}"; }
# Mesa's software renderer can crash as rviz starts: one more try then.
for try in first second; do
  start roslaunch "$project/launch/view.launch" config:="$work/film.rviz" rviz_args:="$rviz_args"
  until_true 60 rviz_listens_or_ended
  sleep 2
  kill -0 "${started[-1]}" 2> /dev/null && break
  [ $try = first ] || { cat "$work/roslaunch.log" >&2; die "film.sh: rviz does not stay"; }
  say "rviz crashed as it started: once more"
done

calculate() { awk "BEGIN { printf \"%.4f\", $1 }"; }

if [[ $out = *.png ]]; then
  start rosbag play --clock --quiet --delay 1 -s "$start" -u 0.2 "$bag"
  tail --pid="${started[-1]}" -f /dev/null
  sleep 1
  import -silent -window root "$out"
  say "$out"
  exit
fi

# Filmed losslessly from before the start; what came before the first message is cut off after.
start ffmpeg -nostdin -y -f x11grab -framerate "$(calculate "$fps / $slow")" -video_size "$size" \
  -draw_mouse 0 -i "$DISPLAY" -c:v libx264rgb -crf 0 -preset ultrafast "$work/raw.mkv"
camera=${started[-1]}
until_true 20 grep -q 'start: [0-9]' "$work/ffmpeg.log"
camera_start=$(sed -n 's/.*start: \([0-9.]*\),.*/\1/p' "$work/ffmpeg.log" | head -n 1)
# When this one's output was last written, the first message had come.
PYTHONUNBUFFERED=1 start rostopic echo -n 1 /clock
clock=${started[-1]}
sleep 1.5
start rosbag play --clock --quiet --delay 1 --rate "$(calculate "1 / $slow")" -s "$start" \
  -u "$duration" "$bag"
player=${started[-1]}
tail --pid="$clock" -f /dev/null
cut=$(calculate "$(stat -c %.6Y "$work/rostopic.log") + 0.4 - $camera_start")
tail --pid="$player" -f /dev/null
kill -INT "$camera"
tail --pid="$camera" -f /dev/null

look=setpts=PTS/$slow,fps=$fps
length=$(calculate "$duration * $slow - 0.3")
if [[ $out = *.gif ]]; then
  look+=",split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none:diff_mode=rectangle"
  ffmpeg -v error -y -ss "$cut" -t "$length" -i "$work/raw.mkv" -filter_complex "$look" "$out"
else
  ffmpeg -v error -y -ss "$cut" -t "$length" -i "$work/raw.mkv" -vf "$look" \
    -c:v libx264 -pix_fmt yuv420p -crf 20 -movflags +faststart "$out"
fi
say "$out: $(stat -c %s "$out") bytes"
