# Makes pendulum.gif of the frames in the current folder, whatever their number and the scene:
#
#     gnuplot -e 'load "animate_pendulum.plt"'
#     gnuplot -e 'frame_interval = 0.02; load "animate_pendulum.plt"'
#
# frame_interval is the time from one frame to the next in s; 0.1 unless it is set before.
reset
if (!exists("frame_interval")) frame_interval = 0.1

# One run numbers its frames without a gap, so their count is all there is to know.
frame_name(n) = sprintf("frame_%04d.txt", n)
list_frames = "ls | grep -E '^frame_[0-9]{4,}\\.txt$'"
frames = int(system(list_frames . " | wc -l"))
if (frames < 1) exit error "no frame_0000.txt here: run gnuplot in the folder of the frames"

# A GIF shows a picture for whole hundredths of a second, and no viewer is faster than two of them.
# Of every `stride` frames one is shown: the first stride with which that is the true speed within
# 1 %, or else the one that comes nearest.
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

# Axes that hold every frame, equal in both directions, with a border of a tenth.
stats "< " . list_frames . " | xargs cat" using 1:2 nooutput
larger(a, b) = a > b ? a : b
middle_x = 0.5 * (STATS_min_x + STATS_max_x)
middle_y = 0.5 * (STATS_min_y + STATS_max_y)
half = 0.55 * larger(STATS_max_x - STATS_min_x, STATS_max_y - STATS_min_y)
if (half == 0) half = 1

set terminal gif animate delay delay(stride) loop 0 optimize size 480,480 font "sans,11"
set output "pendulum.gif"
set size ratio -1
set xrange [middle_x - half : middle_x + half]
set yrange [middle_y - half : middle_y + half]
set grid linecolor "#e4e4e4" linewidth 1
set border linecolor "#808080"
set tics scale 0.5
set xlabel "x / m"
set ylabel "y / m"
unset key
do for [n = 0 : frames - 1 : stride] {
  set title sprintf("t = %.2f s", n * frame_interval)
  plot frame_name(n) with lines linecolor "#7f8fa6" linewidth 2, \
       frame_name(n) with points pointtype 7 pointsize 0.9 linecolor "#c23616", \
       frame_name(n) every ::0::0 with points pointtype 5 pointsize 1.2 linecolor "#2f3640"
}
unset output
