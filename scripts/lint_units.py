#!/usr/bin/python3
"""Writes one source a folder, made of all of the folder's, and how to compile it.

clang-tidy spends nearly all its time on the headers a source includes; this way it reads them once
a folder. (Including the sources would not do: the static analyzer passes over what is included.)
Usage: lint_units.py BUILD UNITS   (BUILD holds compile_commands.json; UNITS is written)
"""
import json
import re
import shlex
import sys
from collections import defaultdict
from pathlib import Path

build, units = map(Path, sys.argv[1:])
project = Path(__file__).resolve().parent.parent


def flags_of(command):
    """The compiler and its options, without what names this source's own input and output."""
    command = command[:command.index(' -o ')].replace('-isystem ', '-isystem')
    return shlex.split(command)


# Sources that define the same names keep apart: programs, and those for another instruction set.
PROGRAM = re.compile(r'^int (main|run)\(|LLVMFuzzerTestOneInput', re.MULTILINE)
sources, flags = defaultdict(list), defaultdict(dict)
for entry in json.loads((build / 'compile_commands.json').read_text()):
    path = Path(entry['file'])
    if not path.is_relative_to(project) or path.is_relative_to(build):
        continue  # generated
    words = flags_of(entry['command'])
    folder = path.relative_to(project).parent
    apart = [word for word in words if word.startswith('-m')]
    if PROGRAM.search(path.read_text()):
        apart.append(path.stem)
    key = '_'.join([*folder.parts, *apart])
    sources[key].append(path)
    flags[key].update(dict.fromkeys(words))

units.mkdir(parents=True, exist_ok=True)
commands = []
for key, paths in sources.items():
    unit = units / f'{key}.cpp'
    unit.write_text('\n'.join(f'// {path}\n{path.read_text()}' for path in sorted(set(paths))))
    commands.append({'directory': str(build), 'file': str(unit),
                     'arguments': [*flags[key], f'-I{paths[0].parent}', '-c', str(unit)]})
(units / 'compile_commands.json').write_text(json.dumps(commands, indent=1))
