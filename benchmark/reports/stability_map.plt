# Draws stability_map.csv and stability_limit.csv of the folder it is called in as
# stability_map.png: gnuplot .../stability_map.plt
map = "stability_map.csv"
limit = "stability_limit.csv"
methods = "Euler Runge-Kutta-2 Runge-Kutta-4"
of(file, method) = "< awk -F, '$1 == \"" . method . "\"' " . file

# Blue against yellow to brown, getting darker: also told apart without seeing red and green.
colors = "#c6dbef #fee391 #f98e1b #662506"
names = "stable run energy drifts gains energy run diverges"
set datafile separator ","
set palette maxcolors 4 defined (0 word(colors, 1), 1 word(colors, 2), \
    2 word(colors, 3), 3 word(colors, 4))
set cbrange [-0.5:3.5]
unset colorbox
unset key
set tics out nomirror scale 0.5
set format x "10^{%.0f}"
set xtics 2
set ytics 1
set xlabel "mass of a particle in kg" offset 0, 0.2
set xrange [-4:2]
set yrange [-4:0]

# The legend, in the coordinates of the whole picture.
do for [n = 1:4] {
  x = real(word("0.075 0.22 0.385 0.55", n))
  set object n rectangle from screen x, 0.04 to screen x + 0.028, 0.095 fillcolor rgb word(colors, n) \
      fillstyle solid border linecolor "gray50"
  set label n word(names, 2 * n - 1) . " " . word(names, 2 * n) at screen x + 0.035, 0.0675
}
set arrow 1 from screen 0.72, 0.0675 rto screen 0.03, 0 nohead linewidth 3 linecolor "black" front
set label 5 "linear limit with margin" at screen 0.76, 0.0675

set terminal pngcairo size 1200, 460 font "sans,15"
set output "stability_map.png"
set multiplot layout 1, words(methods) margins 0.075, 0.985, 0.28, 0.92 spacing 0.055, 0
do for [column = 1:words(methods)] {
  method = word(methods, column)
  set title method offset 0, -0.4
  set ylabel (column == 1 ? "step size in s" : "") offset 0.5, 0
  set format y (column == 1 ? "10^{%.0f}" : "")
  plot of(map, method) using (log10($2)):(log10($3)):5 with image, \
       of(limit, method) using (log10($2)):(log10($3)) with lines linewidth 3 linecolor "black"
  if (column == 1) { unset object; unset label; unset arrow }  # drawn once is enough
}
unset multiplot
