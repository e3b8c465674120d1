#!/usr/bin/python3
"""usage: plot_run_time_error.py work_precision.csv SCENE PATH

Draws PATH.png: error against run time for the exercise's three methods, the plain loop, the best
package, DOP853 and the best method of this package, each labelled at its end. Only the points of
a method that no other point of it beats are drawn.
"""
import subprocess
import sys

import gnuplot
import result_csv

TARGET = 1e-6  # m; "best" means cheapest to this error
COLORS = {"plain": "#8a8a8a", "package": "#56b4e9", "dop853": "#8f5fc4", "best": "#111111"}


def front(rows):
    """The points that are both faster and more accurate than all others, by time."""
    points = sorted((float(r["time_ms"]), float(r["error_m"])) for r in rows
                    if r["status"] == "ok" and float(r["error_m"]) > 0.0)
    kept = []
    for time, error in points:
        if not kept or error < kept[-1][1]:
            kept.append((time, error))
    return kept


def cheapest(rows):
    """The name of the method that reaches TARGET first."""
    good = [r for r in rows if r["status"] == "ok" and float(r["error_m"]) <= TARGET]
    return min(good, key=lambda r: float(r["time_ms"]))["method"]


def chosen(rows):
    """Label, colour and points of each curve."""
    def of(method):
        return front([r for r in rows if r["method"] == method])

    own = [r for r in rows if r["library"] == "own"]
    best = cheapest(own)
    plain = cheapest([r for r in rows if r["library"] == "plain"])
    package = cheapest([r for r in rows if r["library"] not in ("own", "plain", "SciPy")])
    scipy = [r["method"] for r in rows if r["library"] == "SciPy"]
    for name in ("Euler", "Runge-Kutta-2", "Runge-Kutta-4"):
        yield name, gnuplot.METHODS[name][0], of(name)
    yield "Runge-Kutta-4, plain loop", COLORS["plain"], of(plain)
    yield f"{package}", COLORS["package"], of(package)
    if scipy:
        yield "DOP853 (Fortran)", COLORS["dop853"], of(scipy[0])
    yield f"{best} (best of ours)", COLORS["best"], of(best)


def draw(scene, curves, path):
    blocks, lines, labels = [], [], []
    for i, (label, color, points) in enumerate(curves):
        points = [p for p in points if 1e-11 <= p[1] <= 10.0]
        blocks.append(f"$c{i} << EOD\n" + "\n".join(f"{t} {e}" for t, e in points) + "\nEOD")
        width = 3.5 if "best of ours" in label else 2
        lines.append(f"$c{i} using 1:2 with linespoints pt 7 ps 0.6 lw {width} lc rgb '{color}' "
                     f"title \"{label}\"")
    script = "\n".join(blocks) + f"""
set terminal pngcairo size 1000,540 font 'DejaVu Sans,13'
set output '{path}.png'
set title "{scene}: largest position error at the end against run time" noenhanced
set xlabel "run time in ms (one thread)"
set ylabel "position error in m"
set logscale xy
set format x "%g"
set format y "10^{{%L}}"
set yrange [1e-11:10]
set grid lc rgb '#e4e4e4' lt 1
set border 3 lc rgb '#444444'
set tics nomirror
set xrange [0.003:1000]
set lmargin 10
set rmargin 30
set key at screen 0.99, screen 0.75 right Left reverse spacing 1.4 samplen 2 noenhanced
plot {", ".join(lines)}
"""
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


def main(csv, scene, path):
    _, rows = result_csv.read(csv)
    draw(scene, list(chosen([r for r in rows if r["scene"] == scene])), path)


if __name__ == "__main__":
    main(*sys.argv[1:])
