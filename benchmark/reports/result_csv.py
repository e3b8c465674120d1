"""Reads the CSV files of the benchmarks: a head of '#' lines, then rows."""
import csv


def read(path):
    """Head lines without '#', and rows as dictionaries."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = file.readlines()
    head = [line[1:].strip() for line in lines if line.startswith("# ")]
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return head, rows


def names(rows, key):
    """The different values of a column, in the order in which they come."""
    return list(dict.fromkeys(row[key] for row in rows))
