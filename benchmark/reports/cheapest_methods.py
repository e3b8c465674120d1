#!/usr/bin/python3
"""usage: cheapest_methods.py work_precision.csv > cheapest_methods.md

For each scene, the least time to a true error of 1e-3, 1e-6 and 1e-9 m: this package against the
best solver of the other packages, and against the best of our own plain loops. Only points that
were measured count; nothing is interpolated.
"""
import sys

import result_csv

TARGETS = (1e-3, 1e-6, 1e-9)
NONE = "–"
INTRODUCTION = """\
# Cheapest method for an error of 1e-3, 1e-6 and 1e-9 m

Least time among the measured points whose true error is at most the target; nothing is
interpolated. A ratio is the time of another over ours: above 1, this package is faster. There are
two: to the best solver of the other packages (Boost.odeint, GSL, SUNDIALS, MuJoCo, Simbody,
SciPy), and to
the best plain loop (Runge-Kutta-4 written out for this benchmark: structure of arrays, object per
particle). – stands where nothing that was measured is accurate enough.
"""


def cheapest(rows, target, libraries):
    """The fastest of the points of some libraries that are accurate enough, or None."""
    good = [r for r in rows if libraries(r["library"]) and r["status"] == "ok" and
            float(r["error_m"]) <= target]
    return min(good, key=lambda r: float(r["time_ms"]), default=None)


def three_digits(number):
    return f"{number:.3g}" if number < 1000 else f"{number:.0f}"


def ratio(row, own):
    times = float(row["time_ms"]) / float(own["time_ms"])
    return f"{times:.1f}x" if times < 100 else f"{times:.0f}x"


class Best:
    """The cheapest of each side for one target on one scene."""

    def __init__(self, rows, target):
        self.target = target
        self.own = cheapest(rows, target, lambda library: library == "own")
        self.package = cheapest(rows, target, lambda library: library not in ("own", "plain"))
        self.plain = cheapest(rows, target, lambda library: library == "plain")

    def ratio(self, other):
        if self.own is None or other is None:
            return NONE
        return ratio(other, self.own)

    def in_short(self):
        if self.own is None:
            return NONE
        return f"{three_digits(float(self.own['time_ms']))} ms ({self.own['method']}), " \
               f"packages {self.ratio(self.package)}, plain loop {self.ratio(self.plain)}"

    def in_full(self):
        return " | ".join([f"{self.target:.0e} m", point(self.own), point(self.package),
                           self.ratio(self.package), point(self.plain), self.ratio(self.plain)])


def point(row):
    if row is None:
        return NONE
    return f"{row['method']} ({row['control']} {float(row['value_s_or_m']):.2g}): " \
           f"{three_digits(float(row['time_ms']))} ms"


def main(path):
    head, rows = result_csv.read(path)
    bests = {scene: [Best([r for r in rows if r["scene"] == scene], target) for target in TARGETS]
             for scene in result_csv.names(rows, "scene")}
    print(INTRODUCTION)
    print("## In short\n")
    print("docs/benchmarks.md shows this table, and a test asks for its rows there.\n")
    print("| scene | to 1e-3 m | to 1e-6 m | to 1e-9 m |")
    print("|---|---|---|---|")
    for scene, best in bests.items():
        print(f"| `{scene}` | " + " | ".join(b.in_short() for b in best) + " |")
    print("\n## In full\n")
    print("| scene | error | this package | best package | ratio to it | best plain loop | ratio to it |")
    print("|---|---|---|---|---|---|---|")
    for scene, best in bests.items():
        for b in best:
            print(f"| `{scene}` | {b.in_full()} |")
    print("\n" + "\n".join(f"- {line}" for line in head if line[0].islower() and ": " in line))


if __name__ == "__main__":
    main(sys.argv[1])
