#!/usr/bin/python3
"""usage: plot_throughput.py throughput.csv FOLDER

Draws FOLDER/throughput.png, nanoseconds per spring force against the chain's length, and
prints a table of how many times faster this package is.
"""
import sys

import gnuplot
import result_csv


def label(row):
    if row["library"] != "own":
        return row["method"]
    threads = "all threads" if row["threads"] == "all" else "1 thread"
    balance = ", energy balance" if "energy" in row["method"] else ""
    return f"this package, {threads}{balance}"


def divider_bound(head):
    """ns, or None"""
    lines = [line for line in head if line.startswith("divider bound:")]
    return float(lines[0].split()[2]) if lines else None


def draw(rows, bound, folder):
    times = [float(r["median_ns"]) for r in rows if r["status"] == "ok"]
    plot = gnuplot.Plot("Runge-Kutta-4: time for one spring force, median", "particles",
                        "time per spring force / ns", (2, 2e7), (min(times) / 2, max(times) * 2))
    drawn = []
    for row in rows:
        if label(row) in drawn:
            continue
        drawn.append(label(row))
        here = [r for r in rows if label(r) == label(row)]
        number = sum(r["library"] == row["library"] for r in rows
                     if label(r) in drawn and r["particles"] == row["particles"]) - 1
        style = gnuplot.style_of(row["library"], number)
        plot.line([(r["particles"], r["median_ns"]) for r in here if r["status"] == "ok"],
                  label(row), style)
        lost = [r for r in here if r["status"] != "ok"]
        if lost:
            plot.crosses([r["particles"] for r in lost], style,
                         f"{label(row)}: {lost[0]['status']}")
    if bound:
        plot.line([(2, bound), (2e7, bound)], "square root and division alone",
                  "dt 3 lw 1.5 pt -1 lc rgb '#000000'")
    plot.write(f"{folder}/throughput")


def step_cost(row):
    """Time of a whole step, in ns per spring: some take more than four evaluations."""
    return float(row["median_ns"]) * float(row["force_evaluations_a_step"])


def table(rows):
    sizes = result_csv.names(rows, "particles")
    print("| ns per spring force (a step of this package is so many times faster) | " +
          " | ".join(f"{int(n):,}" for n in sizes) + " |")
    print("|---" * (len(sizes) + 1) + "|")
    own = {r["particles"]: r for r in rows if label(r) == "this package, 1 thread"}
    for name in dict.fromkeys(label(r) for r in rows):
        cells = []
        for size in sizes:
            row = next((r for r in rows if label(r) == name and r["particles"] == size), None)
            if row is None or row["status"] != "ok":
                cells.append("-" if row is None else row["status"])
                continue
            ratio = step_cost(row) / step_cost(own[size])
            cells.append(f"{float(row['median_ns']):.3g} ({ratio:.3g}x)")
        print(f"| {name} | " + " | ".join(cells) + " |")


def main(path, folder):
    head, rows = result_csv.read(path)
    draw(rows, divider_bound(head), folder)
    print("# Throughput of Runge-Kutta-4\n")
    table(rows)
    print("\n" + "\n".join(f"- {line}" for line in head
                           if line[0].islower() and ": " in line))


if __name__ == "__main__":
    main(*sys.argv[1:])
