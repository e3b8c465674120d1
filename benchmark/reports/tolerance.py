#!/usr/bin/python3
"""usage: tolerance.py tolerance.csv > tolerance.md

The largest error of every method at every tolerance over all scenes, and of every method on every
scene over all tolerances, as Markdown tables.
"""
import sys

import result_csv

ERROR = "worst_error_in_tolerances"


def cell(rows, label):
    """The worst of the rows, with its value in column `label`; what was not run is said to be so."""
    done = [row for row in rows if row[ERROR]]
    if not done:
        return "not run" if rows else ""
    worst = max(done, key=lambda row: float(row[ERROR]))
    error = f"{float(worst[ERROR]):.2g} ({worst[label]})"
    missing = len(rows) - len(done)
    return error if missing == 0 else f"{error}, {missing} not run"


def table(rows, down, across, label):
    values = result_csv.names(rows, across)
    print(f"| {down} | {' | '.join(values)} |\n|---|" + "---|" * len(values))
    for name in result_csv.names(rows, down):
        of_name = [row for row in rows if row[down] == name]
        cells = (cell([row for row in of_name if row[across] == value], label)
                 for value in values)
        print(f"| {name} | {' | '.join(cells)} |")


def main(path):
    head, rows = result_csv.read(path)
    sensitive = [row for row in rows if row["promise"] == "sensitive"]
    rows = [row for row in rows if row["promise"] != "sensitive"]
    broken = [row for row in rows if row["promise"] == "broken"]
    print(f"{len(rows)} cases, {len(broken)} broken; {len(sensitive)} more on sensitive motions, "
          "not listed.\n")
    print("Largest position error over the tolerance asked for; the promise is 10.\n")
    print("By tolerance in m, with the scene:\n")
    table(rows, "method", "tolerance_m", "scene")
    print("\nBy scene, with the tolerance in m:\n")
    table(rows, "scene", "method", "tolerance_m")
    for row in broken:
        print(f"- broken: {row['scene']}, {row['method']}, {row['tolerance_m']}: "
              f"{row[ERROR]} ({row['note']})")
    print("\n" + "\n".join(f"- {line}" for line in head))


if __name__ == "__main__":
    main(sys.argv[1])
