#!/usr/bin/python3
"""usage: table.py RESULT.csv > RESULT.md

A CSV file of the benchmarks as a Markdown table.
"""
import sys

import result_csv


def main(path):
    head, rows = result_csv.read(path)
    columns = list(rows[0])
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
    for row in rows:
        print("| " + " | ".join(row[column] for column in columns) + " |")
    print("\n" + "\n".join(f"- {line}" for line in head))


if __name__ == "__main__":
    main(sys.argv[1])
