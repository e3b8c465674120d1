#!/usr/bin/python3
"""Writes what follows from the tables of options into config/ and docs/.

Usage: generate_option_texts.py PROGRAM [check]
PROGRAM prints the tables: test/support/option_table.cpp. With `check`, writes nothing and fails if a
file differs. A text between the marks BEGIN and END of a file is generated, `except` some options.
"""
import json
import pathlib
import re
import subprocess
import sys
import textwrap

PROJECT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r'(?P<begin>[^\n]*BEGIN of generated (?P<kind>\w+)(?: except (?P<others>[\w ,]*\w))?[^\n]*\n)'
                   r'(?P<text>.*?)(?P<end>[^\n]*END of generated)', re.DOTALL)
WIDTH = 100


def meaning_with_unit(option):
    first, *rest = re.split('([:;])', option['meaning'], maxsplit=1)
    return first + (', ' + option['unit'] if option['unit'] else '') + ''.join(rest)


def words(option):
    """The values of a flag or a choice in words, else nothing."""
    return option['range'] if option['is_flag'] or '|' in option['placeholder'] else ''


def short_range(option):
    """'at least 0' for 'a number of at least 0 m', nothing for 'a file'."""
    unit = '(?: %s)?$' % re.escape(option['unit'])
    limits = re.match('a (?:whole )?number (?:of )?(.*?)' + unit, option['range'])
    return limits[1] if limits else words(option)


def yaml_entry(option):
    text = meaning_with_unit(option)
    values = short_range(option)
    text = text[0].upper() + text[1:] + '.'
    if values:
        text += ' Must be %s.' % values
    if option['users']:
        text += ' Only for %s.' % option['users']
    value = option['default']
    if re.fullmatch(r'\d+e-\d+', value):
        value = value.replace('e', '.0e')  # ROS reads 1e-3 as a string
    lines = textwrap.wrap(text, WIDTH, initial_indent='# ', subsequent_indent='# ')
    return '\n' + '\n'.join(lines) + '\n%s: %s\n' % (option['key'], value or '""')


def option_row(option):
    flag = option['is_flag']
    name = '--' + option['key'].replace('_', '-') + ('' if flag else ' ' + option['placeholder'])
    return '| `%s` | %s | %s | %s |\n' % (name.replace('|', '\\|'), option['meaning'], option['unit'],
                                          '' if flag else option['default'])


def parameter_row(option):
    default = ' '.join(filter(None, (option['default'] or '(none)', option['unit'])))
    return '| `%s` | %s | %s | %s |\n' % (option['key'], default, short_range(option) or option['range'],
                                       option['meaning'])


# How an option is written, the tables of its options, and the head of the list.
KINDS = {'yaml': (yaml_entry, 'run', ''),
         'options': (option_row, 'run', '| option | meaning | unit | default |\n|---|---|---|---|\n'),
         'parameters': (parameter_row, 'display play',
                        '| parameter | default | range | meaning |\n|---|---|---|---|\n')}


def generated(match, options):
    render, groups, head = KINDS[match['kind']]
    others = set((match['others'] or '').replace(',', ' ').split())
    chosen = [o for o in options if o['group'] in groups.split() and o['key'] not in others]
    return match['begin'] + head + ''.join(map(render, chosen)) + match['end']


def main(program, *check):
    lines = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    options = [json.loads(line) for line in lines]
    has_ros = any(option['group'] == 'play' for option in options)
    paths = ['config/pendulum.yaml', 'docs/exercise3.md']
    if has_ros:
        paths += ['docs/ros.md']
    different = []
    for path in paths:
        text = (PROJECT / path).read_text()
        new_text, blocks = BLOCK.subn(lambda match: generated(match, options), text)
        if blocks == 0:
            sys.exit(path + ': has no mark BEGIN of generated')
        if new_text == text:
            continue
        different.append(path)
        if not check:
            (PROJECT / path).write_text(new_text)
    if different:
        print(*(['out of date, run scripts/generate.sh:'] if check else ['written:']), *different)
    sys.exit(1 if check and different else 0)


if __name__ == '__main__':
    main(*sys.argv[1:])
