# Draws stability_map.csv and stability_border.csv of the folder it is called in as
# stability_map.png and stability_map.svg: gnuplot .../stability_map.plt
columnsOf(file, column) = system("awk -F, 'NR > 1 && $" . column . \
    " != \"\" && !seen[$" . column . "]++ {print $" . column . "}' " . file)
map = "stability_map.csv"
border = "stability_border.csv"
axes = columnsOf(map, "1")
methods = columnsOf(map, "2")
select(file, axis, method) = "< awk -F, '$1 == \"" . axis . "\" && $2 == \"" . method . "\"' " . file
unit(axis) = axis eq "mass" ? "m in kg" : axis eq "stiffness" ? "k_s in N/m" : \
             axis eq "damping" ? "k_d in N·s/m" : "particles"

set datafile separator ","
set palette maxcolors 4 defined (0 "#7fbf7b", 1 "#ffffbf", 2 "#fdae61", 3 "#c0392b")
set cbrange [-0.5:3.5]
unset colorbox
set tics out nomirror scale 0.5
set format x "10^{%.0f}"
set format y "10^{%.0f}"
set xtics 1
set ytics 1

do for [kind in "png svg"] {
  width = 60 + 330 * words(methods)
  height = 90 + 290 * words(axes)
  if (kind eq "png") { set terminal pngcairo size width, height font "sans,11" }
  if (kind eq "svg") { set terminal svg standalone size width, height font "sans,11" background "white" }
  set output "stability_map." . kind
  set multiplot layout words(axes), words(methods) margins 0.07, 0.985, 0.06, 0.935 \
      spacing 0.045, 0.05 title "Verdict on ten seconds of a chain of eleven particles: \
green ok, yellow drift, orange gained energy, red diverged\n\
line: largest step advised without a trial"
  do for [row = 1:words(axes)] {
    axis = word(axes, row)
    do for [column = 1:words(methods)] {
      method = word(methods, column)
      set title (row == 1 ? method : "")
      set xlabel unit(axis) offset 0, 0.6
      set ylabel (column == 1 ? "step in s" : "") offset 1.5, 0
      set xrange [*:*]
      set yrange [*:*]
      stats select(map, axis, method) using (log10($3)) nooutput
      set xrange [STATS_min:STATS_max]
      set yrange [-4:0]
      plot select(map, axis, method) using (log10($3)):(log10($4)):6 with image notitle, \
           select(border, axis, method) using (log10($3)):(log10($4)) with lines \
               linewidth 2.5 linecolor "black" notitle
    }
  }
  unset multiplot
  set output
}
