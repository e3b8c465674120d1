# Draws compare.gif: three methods on the same scene side by side, each before the true motion in grey,
# and their total energies below. A chain that diverged stays as it was last, dashed.
# Called by scripts/pictures.sh in a folder that holds a folder Truth of frames and, for each method, a
# folder METHOD of frames and a file METHOD.csv with the energy balance.
methods = "Euler Runge-Kutta-2 Runge-Kutta-4"
colors = "#c1440e #b8860b #1f5fa8"
time_step = 0.05
pictures = 161
frame_name(method, n) = sprintf("%s/frame_%04d.txt", method, n)
frames(method) = int(system("ls " . method . " | wc -l"))


set terminal gif animate delay 5 loop 0 optimize size 630,420 font "sans,10"
set output "compare.gif"
set border linecolor "#a0a0a0"
set tics scale 0.4 nomirror
unset key
do for [n = 0 : pictures - 1] {
  set multiplot
  set size ratio -1
  set xrange [-6.5 : 6.5]
  set yrange [-13 : 4]
  set grid linecolor "#ececec" linewidth 1
  set xtics 4
  set ytics 4
  set xlabel "x in m" offset 0, 0.3
  do for [k = 1 : 3] {
    method = word(methods, k)
    set lmargin at screen 0.07 + 0.315 * (k - 1)
    set rmargin at screen 0.36 + 0.315 * (k - 1)
    set tmargin at screen 0.94
    set bmargin at screen 0.36
    set title method offset 0, -0.6 textcolor rgb word(colors, k)
    set ylabel (k == 1 ? "y in m" : "") offset 1.5, 0
    unset label
    last = frames(method) - 1
    diverged = n > last
    if (diverged) {
      set label sprintf("diverged at t = %.2f s", (last + 1) * time_step) at graph 0.5, 0.06 center
    }
    shown = frame_name(method, diverged ? last : n)
    dash = diverged ? 2 : 1
    plot frame_name("Truth", n) with linespoints linewidth 5 pointtype 7 pointsize 1.2 \
           linecolor "#d3d7dd", \
         shown with lines linewidth (diverged ? 2 : 3) dashtype dash \
           linecolor rgb word(colors, k), \
         shown with points pointtype (diverged ? 6 : 7) pointsize 1 linecolor "#2f3640", \
         shown every ::0::0 with points pointtype 5 pointsize 1.3 linecolor "#2f3640"
  }
  unset label
  unset title
  set size noratio
  set lmargin at screen 0.1
  set rmargin at screen 0.97
  set tmargin at screen 0.26
  set bmargin at screen 0.08
  set xrange [0 : (pictures - 1) * time_step]
  set yrange [-20 : 180]
  set xtics 1
  set ytics 60
  set xlabel sprintf("t = %.2f s", n * time_step) offset 0, 0.3
  set ylabel "total energy in J" offset 0.5, 0
  set datafile separator ","
  plot for [k = 1 : 3] word(methods, k) . ".csv" every ::0::n using "time [s]":"total [J]" \
    with lines linewidth 3 linecolor rgb word(colors, k)
  set datafile separator
  unset multiplot
}
unset output
