#!/usr/bin/python3
"""usage: cheapest_methods.py work_precision.csv > cheapest_methods.md

For each scene, the least time to a true error of 1e-3, 1e-6 and 1e-9 m: this package against the
best peer. Only points that were measured count; nothing is interpolated.
"""
import sys

import result_csv

TARGETS = (1e-3, 1e-6, 1e-9)


def cheapest(rows, target):
    """The fastest of the points that are accurate enough, or None."""
    good = [r for r in rows if r["status"] == "ok" and float(r["error_m"]) <= target]
    return min(good, key=lambda r: float(r["time_ms"]), default=None)


def shown(row):
    if row is None:
        return "none"
    return f"{row['method']} ({row['control']} {float(row['value_s_or_m']):.2g}): " \
           f"{float(row['time_ms']):.3g} ms"


def ratio(own, peer):
    if own is None or peer is None:
        return "-"
    return f"{float(peer['time_ms']) / float(own['time_ms']):.1f}x"


def main(path):
    head, rows = result_csv.read(path)
    print("# Cheapest method for an error of 1e-3, 1e-6 and 1e-9 m\n")
    print("Least time among the measured points whose true error is at most the target; nothing is")
    print("interpolated. The ratio is the best peer's time over ours: above 1, this package is faster.\n")
    print("| scene | error | this package | best peer | ratio |")
    print("|---|---|---|---|---|")
    for scene in result_csv.names(rows, "scene"):
        here = [r for r in rows if r["scene"] == scene]
        for target in TARGETS:
            own = cheapest([r for r in here if r["library"] == "own"], target)
            peer = cheapest([r for r in here if r["library"] != "own"], target)
            print(f"| `{scene}` | {target:.0e} m | {shown(own)} | {shown(peer)} | "
                  f"{ratio(own, peer)} |")
    print("\n" + "\n".join(f"- {line}" for line in head if line[0].islower()))


if __name__ == "__main__":
    main(sys.argv[1])
