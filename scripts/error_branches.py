#!/usr/bin/python3
"""Prints which lines that report an error (throw, refuse(), refuseForErrno()) are covered by tests.
Usage: error_branches.py PROJECT COVERAGE_JSON   (of gcovr --json)"""
import json
import os
import re
import sys

REFUSES = re.compile(r'^\s*(if \(.*\) |else )?(throw\b(?!;)|refuse\w*\()')


def main():
    project, coverage = sys.argv[1:]
    with open(coverage) as file:
        files = json.load(file)['files']
    taken, missed = 0, []
    for entry in files:
        with open(os.path.join(project, entry['file'])) as source:
            text = source.read().splitlines()
        for line in entry['lines']:
            number = line['line_number']
            if not REFUSES.match(text[number - 1]):
                continue
            if line['count'] > 0:
                taken += 1
            else:
                missed.append('%s:%d: %s' % (entry['file'], number, text[number - 1].strip()))
    print('error branches taken: %d of %d' % (taken, taken + len(missed)))
    for place in missed:
        print('  not taken: ' + place)


main()
