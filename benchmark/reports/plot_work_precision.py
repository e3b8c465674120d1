#!/usr/bin/python3
"""usage: plot_work_precision.py work_precision.csv FOLDER

Draws FOLDER/work_precision_SCENE.png: the true error against the time. What diverged,
took too long or lies above the plot is a cross at the top edge (at the right one too if it has no
time), and counted in the legend.
"""
import sys

import gnuplot
import result_csv

ERRORS = (1e-12, 30.0)


def legend(method, rows):
    bad = [f"{sum(r['status'] == s for r in rows)} {s}" for s in ("failed", "too slow")
           if any(r["status"] == s for r in rows)]
    return method + (f" ({', '.join(bad)})" if bad else "")


def is_shown(row):
    return row["status"] == "ok" and float(row["error_m"]) < ERRORS[1]


def draw(scene, rows, styles, folder):
    times = [float(r["time_ms"]) for r in rows if r["time_ms"]]
    low, high = min(times) / 1.5, max(times) * 2.0
    plot = gnuplot.Plot(f"{scene.replace('_', ' ')}: error against time",
                        "time / ms (one thread; making the solver is not counted)",
                        "true error of a position at the end / m", (low, high), ERRORS)
    for method, style in styles.items():
        here = [r for r in rows if r["method"] == method]
        plot.line([(r["time_ms"], r["error_m"]) for r in here if is_shown(r)],
                  legend(method, here), style)
        lost = [r["time_ms"] or high / 1.3 for r in here if not is_shown(r)]
        if lost:
            plot.crosses(lost, style)
    plot.write(f"{folder}/work_precision_{scene}")


def main(path, folder):
    _, rows = result_csv.read(path)
    styles = {}
    for library in result_csv.names(rows, "library"):
        methods = result_csv.names([r for r in rows if r["library"] == library], "method")
        styles.update((m, gnuplot.style_of(library, i, m)) for i, m in enumerate(methods))
    for scene in result_csv.names(rows, "scene"):
        draw(scene, [r for r in rows if r["scene"] == scene], styles, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
