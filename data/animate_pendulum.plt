# Makes pendulum.gif from the frames in the current folder, whatever their number and the scene:
#
#     gnuplot -e 'load "animate_pendulum.plt"'
#     gnuplot -e 'frame_interval = 0.02; load "animate_pendulum.plt"'
#
# Variables that may be set before:
#   frame_interval  time between frames, s (default 0.1)
#   rest_length     length of an unstretched spring, m (default: mean length in the first frame);
#                   longer springs are drawn red, shorter ones blue
#   trail           how long the path of the last particle stays visible, s (default 1.5)
#   picture_size    length of the longer side, pixels (default 480)
reset
if (!exists("frame_interval")) frame_interval = 0.1
if (!exists("trail")) trail = 1.5
if (!exists("picture_size")) picture_size = 480

# The names sort by number. A run that was resumed in another folder begins there with a later frame.
list_frames = "ls | grep -E '^frame_[0-9]{4,}\\.txt$' | sort -t_ -k2n"
numbers = system(list_frames . " | awk -F'[_.]' 'NR == 1 { first = $2 } END { print NR, first + 0, $2 + 0 }'")
frames = int(word(numbers, 1)); begin = int(word(numbers, 2))
if (frames < 1) exit error "no frame_0000.txt here: run gnuplot in the folder of the frames"
if (begin + frames - 1 != int(word(numbers, 3))) exit error "frames between the first and the last one are missing"
frame_name(n) = sprintf("frame_%04d.txt", begin + n)

# A GIF shows each picture for a whole number of hundredths of a second, and viewers need at least
# two. So only every `stride`-th frame is shown: the first stride that gives the true speed within
# 1 %, otherwise the best one.
hundredths(stride) = 100.0 * stride * frame_interval
delay(stride) = floor(hundredths(stride) + 0.5)
stride = ceil(2 / hundredths(1))
best_stride = stride
best_error = 1.0
while (best_error > 0.01 && stride < best_stride + 10) {
  speed_error = abs(delay(stride) / hundredths(stride) - 1)
  if (speed_error < best_error) { best_error = speed_error; best_stride = stride }
  stride = stride + 1
}
stride = best_stride

# One pass over all frames: the anchor, the mean spring length of the first frame, and the box that
# holds the motion. A motion that diverges would shrink everything else to a point, so the box ends
# where the chain gets five times as long as usual in the first quarter of the run.
particles = int(system("awk 'NF > 1 && !/^#/' " . frame_name(0) . " | wc -l"))
measure = "xargs awk 1 | LC_ALL=C awk -v n=" . particles . " -v frames=" . frames . " ' \
  NF < 2 || /^#/ { next } \
  { i = rows % n; f = int(rows / n); x = $1 + 0; y = $2 + 0 } \
  rows++ == 0 { anchor_x = x; anchor_y = y } \
  i == 0 { len[f] = 0; left[f] = right[f] = x; low[f] = high[f] = y } \
  i > 0 { len[f] += sqrt((x - last_x)^2 + (y - last_y)^2) } \
  { if (x < left[f]) left[f] = x; if (x > right[f]) right[f] = x; \
    if (y < low[f]) low[f] = y; if (y > high[f]) high[f] = y; last_x = x; last_y = y } \
  END { quarter = int((frames + 3) / 4); stride = int((quarter + 99) / 100); usual = 0; \
    for (f = 0; f < quarter; f += stride) { shorter = all = 0; \
      for (g = 0; g < quarter; g += stride) { ++all; if (len[g] < len[f]) ++shorter } \
      if (2 * shorter <= all && len[f] > usual) usual = len[f] } \
    l = left[0]; r = right[0]; b = low[0]; t = high[0]; \
    for (f = 1; f < frames && len[f] <= 5 * usual; ++f) { \
      if (left[f] < l) l = left[f]; if (right[f] > r) r = right[f]; \
      if (low[f] < b) b = low[f]; if (high[f] > t) t = high[f] } \
    printf \"%.9e %.9e %.9e %.9e %.9e %.9e %.9e\", \
      anchor_x, anchor_y, (n > 1 ? len[0] / (n - 1) : 0), l, r, b, t }'"
measured = system(list_frames . " | " . measure)
anchor_x = real(word(measured, 1)); anchor_y = real(word(measured, 2))
unstretched = exists("rest_length") ? rest_length : real(word(measured, 3))
min_x = real(word(measured, 4)); max_x = real(word(measured, 5))
min_y = real(word(measured, 6)); max_y = real(word(measured, 7))

# Equal axes with a border, cropped to the motion: the shorter side is at least half the longer one.
larger(a, b) = a > b ? a : b
side = larger(max_x - min_x, max_y - min_y)
if (side == 0) side = 1
half_x = 0.55 * larger(max_x - min_x, 0.5 * side)
half_y = 0.55 * larger(max_y - min_y, 0.5 * side)
middle_x = 0.5 * (min_x + max_x)
middle_y = 0.5 * (min_y + max_y)
width = floor(picture_size * half_x / larger(half_x, half_y) + 0.5) + 70
height = floor(picture_size * half_y / larger(half_x, half_y) + 0.5) + 75

# Long chains are drawn thinner, so that neighbours stay apart, and without particles from 101 on.
thin(size, least) = larger(least, size * (particles > 12 ? sqrt(12.0 / particles) : 1))
line_width = thin(3, 0.6)
dot_size = thin(1.1, 0.15)

# Colours as 0xRRGGBB: springs from blue (a quarter shorter) over grey to red (a quarter longer).
# All pictures of a GIF share the colours of the first one, hence eight steps for each range, and all
# of them as points behind the anchor.
clip(value) = value < -1 ? -1 : value > 1 ? 1 : value
mix(a, b, share) = int(a + (b - a) * floor(share * 8 + 0.5) / 8)
blend(r1, g1, b1, r2, g2, b2, share) = \
    65536 * mix(r1, r2, share) + 256 * mix(g1, g2, share) + mix(b1, b2, share)
strain_color(strain) = strain < 0 ? blend(150, 150, 158, 25, 90, 210, -clip(4 * strain)) \
                                  : blend(150, 150, 158, 214, 40, 30, clip(4 * strain))
trail_color(age) = blend(230, 120, 20, 253, 238, 220, age)

# The path of the last particle.
set print $path
do for [n = 0 : frames - 1 : stride] {
  print system("tail -n 1 " . frame_name(n))
}
unset print
kept = ceil(trail / (stride * frame_interval))

set terminal gif animate delay delay(stride) loop 0 optimize size width, height font "sans,11"
system("rm -f .pendulum.gif")  # left by a film that was stopped
set output ".pendulum.gif"
set size ratio -1
set xrange [middle_x - half_x : middle_x + half_x]
set yrange [middle_y - half_y : middle_y + half_y]
set grid linecolor "#ececec" linewidth 1
set border linecolor "#a0a0a0"
set tics scale 0.4 nomirror
set xlabel "x in m" offset 0, 0.3
set ylabel "y in m" offset 1.5, 0
unset key
shown = 0
do for [n = 0 : frames - 1 : stride] {
  set title sprintf("t = %.2f s", (begin + n) * frame_interval) offset 0, -0.6
  first = larger(0, shown - kept)
  age(row) = 1.0 - (row + 1.0) / (shown - first + 1.0)
  from_x = from_y = NaN
  plot sample [i = -8 : 16 : 1] "+" using (anchor_x):(anchor_y): \
         (i <= 8 ? strain_color(i / 32.0) : trail_color((i - 8) / 8.0)) \
         with points pointtype 7 pointsize 0.5 linecolor rgb variable, \
       $path every ::first::shown using 1:2:(trail_color(age($0))) \
         with lines linewidth 2 linecolor rgb variable, \
       frame_name(n) using (from_x):(from_y):(dx = $1 - from_x):(dy = $2 - from_y): \
         (from_x = $1, from_y = $2, \
          strain_color(unstretched > 0 ? sqrt(dx**2 + dy**2) / unstretched - 1 : 0)) \
         with vectors nohead linewidth line_width linecolor rgb variable, \
       frame_name(n) using 1:(particles > 100 ? NaN : $2) \
         with points pointtype 7 pointsize dot_size linecolor "#2f3640", \
       frame_name(n) every ::0::0 with points pointtype 5 pointsize 1.3 linecolor "#2f3640"
  shown = shown + 1
}
unset output
# A whole GIF ends with a semicolon; one that is torn, on a full disk, does not replace an earlier one.
put = "tail -c 1 .pendulum.gif | grep -q ';' && mv -fT .pendulum.gif pendulum.gif && echo done || rm -f .pendulum.gif"
if (system(put) ne "done") exit error "pendulum.gif could not be written"
