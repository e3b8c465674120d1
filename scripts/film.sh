#!/usr/bin/env bash
# Plays a bag in rviz on a virtual display and films it at the true speed. Shows all pendulums in the
# bag, in any namespace.
# Usage: film.sh BAG OUT.gif|OUT.mp4|OUT.png [options]
#   --config FILE     rviz configuration [rviz/pendulum.rviz]
#   --start S         s of the bag to skip at the start [0]
#   --duration S      s to film [to the end of the bag]; a PNG shows the instant --start
#   --fps N           pictures per second [20]
#   --size WxH        of the picture [800x600]
#   --slow N          play and film N times slower, for a slow computer [2]
#   --window          the whole window of rviz instead of the scene alone
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
export LC_ALL=C.UTF-8  # a decimal point, no comma, in the numbers of awk and stat
export PATH=/usr/bin:$PATH  # the Python modules of ROS belong to the python3 of the system
say() { printf '%s\n' "-- $*"; }
die() { printf '%s\n' "film.sh: $*" >&2; exit 1; }

[ $# -ge 2 ] || { sed -n '2,12s/^# \{0,1\}//p' "$0" >&2; exit 2; }
bag=$(realpath -m -- "$1") out=$(realpath -m -- "$2")
shift 2
config='' start=0 duration='' fps=20 size=800x600 slow=2 rviz_args=--fullscreen
while [ $# -gt 0 ]; do
  case $1 in
    --window) rviz_args=--; shift; continue ;;
    --config | --start | --duration | --fps | --size | --slow) ;;
    *) die "unknown option '$1'" ;;
  esac
  [ $# -ge 2 ] || die "$1 needs a value"
  [ "$1" = --config ] && config=$(realpath -m -- "$2") || printf -v "${1#--}" %s "$2"
  shift 2
done
[ -z "$config" ] || [ -f "$config" ] || die "the configuration '$config' does not exist"
[ -f "$bag" ] || die "the bag '$bag' does not exist"
case $out in *.gif | *.mp4 | *.png) ;; *) die "OUT must end in .gif, .mp4 or .png" ;; esac
[ -d "$(dirname "$out")" ] || die "the folder of '$out' does not exist"
[ -w "$(dirname "$out")" ] && [ ! -d "$out" ] || die "'$out' cannot be written"
[[ $size =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || die "--size is '$size': must be WIDTHxHEIGHT, for example 800x600"
[[ $out != *.mp4 || $size =~ [02468]x[0-9]*[02468]$ ]] || die "--size is '$size': an .mp4 needs an even width and height"
for option in start duration fps slow; do
  [ "$option ${!option}" != 'duration ' ] || continue
  [[ ${!option} =~ ^[0-9]+(\.[0-9]+)?$ ]] || die "--$option is '${!option}': must be a number"
  [[ $option = start || ${!option} = *[1-9]* ]] || die "--$option is '${!option}': must be above 0"
done
[[ $slow =~ ^0*[1-9] ]] || die "--slow is '$slow': must be at least 1"
[[ $fps =~ ^0*([1-4]?[0-9]|50)(\.|$) ]] || die "--fps is '$fps': must be at most 50"

# In the repository, missing packages are installed; an installed script only lists them.
[ ! -x "$here/setup.sh" ] || "$here/setup.sh" ros rviz film
for program in Xvfb import ffmpeg roslaunch rosbag rosmaster rviz; do
  command -v $program > /dev/null ||
    die "$program is missing: apt-get install xvfb imagemagick ffmpeg rviz python3-roslaunch python3-rosbag"
done
project=$(cd "$here/.." && pwd)
[ -f "$project/package.xml" ] || project=$(rospack find spring_pendulum 2> /dev/null) ||
  die "ROS does not find the package spring_pendulum: source the setup.bash of your workspace first"
calculate() { awk "BEGIN { printf \"%.4f\", ($1) }"; }
short() { printf '%.3g' "$1"; }

# The length of the bag in s, then its topics of markers. The last chunk of a bag may be of a shorter run
# that was appended, so the messages tell the length.
contents=$(/usr/bin/python3 -c 'import rosbag, sys
bag = rosbag.Bag(sys.argv[1])
topics = bag.get_type_and_topic_info()[1].items()
times = [time.to_sec() for _, _, time in bag.read_messages(raw=True)] or [0]
print(times[-1] - times[0],
      *[name for name, info in topics if info.msg_type == "visualization_msgs/MarkerArray"])' "$bag" 2> /dev/null) ||
  die "$bag is not a complete bag; rosbag reindex may repair it"
read -r length topics <<< "$contents"
[ -n "$topics" ] || die "$bag contains no markers (visualization_msgs/MarkerArray)"
rest=$(calculate "$length - $start")
[[ $rest != -* || $rest = -0.0000 ]] || die "--start is '$start': the bag is $(short "$length") s long"
duration=$(calculate "${duration:-1e9} < $rest ? ${duration:-0} : $rest")
[[ $out = *.png || $(calculate "$duration < 0.1") = 0* ]] || die "the part to film is $(short "$duration") s long: must be at least 0.1 s"
# The player and the camera need 3 s.
[[ $out = *.png ]] || slow=$(calculate "$duration * $slow < 3 ? 3 / $duration : $slow")

work=$(mktemp -d)
made=$work/film.${out##*.}
started=()
# Ends the started processes in reverse order; the launcher of rviz ends its nodes.
clean_up() {
  trap '' HUP INT TERM PIPE
  exec > /dev/null 2>&1  # which may have lost their reader
  local i
  for ((i = ${#started[@]} - 1; i >= 0; i--)); do
    kill -INT "${started[i]}" || true
    timeout 20 tail --pid="${started[i]}" -f /dev/null || kill -KILL "${started[i]}" || true
  done
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
# Puts the film in its place, whole, and leaves an earlier one there if that fails.
finish() {
  [ -s "$made" ] || die "nothing was filmed"
  local beside
  beside=$(mktemp -d -- "$(dirname -- "$out")/.film.XXXXXX") || die "'$out' could not be written"
  cp -- "$made" "$beside/film" && mv -f -- "$beside/film" "$out" || { rm -rf -- "$beside"; die "'$out' could not be written"; }
  rmdir -- "$beside"
  say "$out: $(stat -c %s "$out") bytes"
}
# A background job of a script ignores SIGINT; setsid and env start it with the default.
start() { env --default-signal=INT "$@" > "$work/$(basename "$1").log" 2>&1 & started+=($!); }
# give_up LOG REASON: prints the output of the program and the reason, and exits
give_up() { tail -n 20 "$work/$1.log" >&2 2> /dev/null || true; die "$2"; }
# until_true SECONDS LOG REASON COMMAND: repeats the command until it succeeds
until_true() {
  local end=$((SECONDS + $1)) log=$2 reason=$3; shift 3
  until "$@" > /dev/null 2>&1; do
    [ $SECONDS -lt $end ] || give_up "$log" "$reason"
    sleep 0.1
  done
}

# Finds a free port, and sets the paths for rviz to find messages and files of the package.
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$work ROS_LOG_DIR=$work TMPDIR=$work
export LIBGL_ALWAYS_SOFTWARE=1 QT_QPA_PLATFORM=xcb ROS_PACKAGE_PATH=$project:${ROS_PACKAGE_PATH:-/usr/share}
unset ROS_HOSTNAME ROS_NAMESPACE QT_SCALE_FACTOR QT_SCREEN_SCALE_FACTORS QT_AUTO_SCREEN_SCALE_FACTOR

# The configuration determines the size of rviz.
sed -e "s/^  Width: .*/  Width: ${size%x*}/" -e "s/^  Height: .*/  Height: ${size#*x}/" "${config:-$project/rviz/pendulum.rviz}" \
  > "$work/film.rviz"
say "starting rviz on a virtual display"
start Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp -noreset 3> "$work/display"
until_true 20 Xvfb "the virtual display did not start" test -s "$work/display"
export DISPLAY=:$(cat "$work/display")
start rosmaster --core -p "$port"
until_true 20 rosmaster "the ROS master did not start" rosparam set /use_sim_time true
rviz_listens() { for topic in $topics; do rostopic info "$topic" | grep -q '\* /rviz '; done; }
# The display is black until rviz draws.
rviz_draws() { [ "$(import -silent -window root ppm:- | identify -format '%[max]' -)" != 0 ]; }
rviz_is_ready_or_ended() { { rviz_listens && rviz_draws; } || ! kill -0 "${started[-1]}"; }
# The software renderer of Mesa can crash at the start of rviz: try once more.
for try in first second; do
  start roslaunch "$project/launch/view.launch" config:="$work/film.rviz" bag:="$bag" \
    rviz_args:="$rviz_args"
  until_true 60 roslaunch "rviz did not show $(echo $topics) within 60 s" rviz_is_ready_or_ended
  sleep 2
  kill -0 "${started[-1]}" 2> /dev/null && break
  [ $try = first ] || give_up roslaunch "rviz ended right after its start, twice"
  say "rviz crashed at its start; trying again"
done
rviz=${started[-1]}

# is_drawn COLOURS PICTURE...: whether one of the pictures has more than so many colours
is_drawn() { [ "$(identify -format '%k\n' "${@:2}" | sort -n | tail -n 1)" -gt "$1" ]; }
nothing="rviz drew no markers; with --start, /tf_static must be latched in the bag"
if [[ $out = *.png ]]; then
  # rviz leaves some of the first markers waiting if they come before their transform, so these are
  # from the second before.
  from=$(calculate "$start > 1 ? $start - 1 : 0")
  start rosbag play --clock --quiet --delay 1 -s "$from" -u "$(calculate "$start - $from + 0.02")" "$bag"
  tail --pid="${started[-1]}" -f /dev/null
  sleep 1
  take_picture() { import -silent -window root "$made" && is_drawn 20 "$made"; }  # the background has few
  until_true 60 roslaunch "$nothing" take_picture
  finish
  exit
fi

# Records losslessly from before the start; the part before the first message is cut off later.
start ffmpeg -nostdin -y -f x11grab -framerate "$(calculate "$fps < 5 * $slow ? 5 : $fps / $slow")" -video_size "$size" \
  -draw_mouse 0 -i "$DISPLAY" -c:v libx264rgb -crf 0 -preset ultrafast "$work/raw.mkv"
camera=${started[-1]}
until_true 20 ffmpeg "ffmpeg did not start to film" grep -q 'start: [0-9]' "$work/ffmpeg.log"
camera_start=$(sed -n 's/.*start: \([0-9.]*\),.*/\1/p' "$work/ffmpeg.log" | head -n 1)
# The time of the last write to this log is the time of the first message.
PYTHONUNBUFFERED=1 start rostopic echo -n 1 /clock
clock=${started[-1]}
sleep 1.5
start rosbag play --clock --quiet --delay 1 --rate "$(calculate "1 / $slow")" -s "$start" \
  -u "$duration" "$bag"
player=${started[-1]}
while kill -0 "$clock" 2> /dev/null; do
  kill -0 "$player" 2> /dev/null || give_up rosbag "rosbag play ended before its first message"
  sleep 0.05
done
say "filming $(short "$duration") s of $(short "$length") s, $(short "$slow") times slower"
cut=$(calculate "$(stat -c %.6Y "$work/rostopic.log") + 0.4 - $camera_start")
begin=$SECONDS
until timeout 5 tail --pid="$player" -f /dev/null; do
  say "filmed $(short "$(calculate "($SECONDS - $begin) / $slow")") of $(short "$duration") s"
done
wait "$player" || give_up rosbag "rosbag play ended early"
kill -0 "$rviz" 2> /dev/null || give_up roslaunch "rviz ended while it was filmed"
kill -INT "$camera" 2> /dev/null || give_up ffmpeg "ffmpeg ended while it filmed"
tail --pid="$camera" -f /dev/null

look=setpts=PTS/$slow,fps=$fps
filmed=$(calculate "$duration * $slow - 0.3")
ffmpeg -v error -ss "$cut" -t "$filmed" -i "$work/raw.mkv" -vf "fps=10/$filmed" "$work/look%d.ppm"
is_drawn 1 "$work"/look*.ppm || give_up roslaunch "$nothing"
say "writing $out"
if [[ $out = *.gif ]]; then
  look+=",split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none:diff_mode=rectangle"
  ffmpeg -v error -y -ss "$cut" -t "$filmed" -i "$work/raw.mkv" -filter_complex "$look" "$made"
else
  ffmpeg -v error -y -ss "$cut" -t "$filmed" -i "$work/raw.mkv" -vf "$look" \
    -c:v libx264 -pix_fmt yuv420p -crf 20 -movflags +faststart "$made"
fi
finish
