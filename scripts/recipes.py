#!/usr/bin/python3
"""Applies the recipes of CONTRIBUTING.md in a copy of the repository, checks its format, and runs the
commands of the recipes there.

Usage: recipes.py [apply]
With `apply`, runs no command. A step of a recipe names a file and a place: "before `TEXT`", "instead of
`TEXT`" (a line), "without `TEXT`" or "at the end"; the text to insert is the block that follows. Steps
without a block are left to the reader.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
STEP = re.compile(r'^\d+\. `(?P<file>[^`\n]+)`(?P<words>.*?)(?=^\d+\. |^#|\Z)', re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r'((?:^ {7}.*\n|^\n)+)', re.MULTILINE)
COMMAND = re.compile(r'^ +((?:scripts/|ctest )\S.*)$', re.MULTILINE)


def recipes():
    text = (PROJECT / 'CONTRIBUTING.md').read_text()
    part = text.split('\n## How to add\n')[1].split('\n## ')[0]
    return {title.split('\n')[0]: title for title in part.split('\n### ')[1:]}


def block_of(step):
    """The lines of the indented block that is not a command."""
    blocks = [b for b in BLOCK.findall(step) if b.strip() and not COMMAND.search(b)]
    return [line[7:] for line in blocks[0].strip('\n').split('\n')] if blocks else []


def find(lines, text, file):
    places = [i for i, line in enumerate(lines) if text in line]
    if not places:
        sys.exit('%s: no line has %r' % (file, text))
    return places[-1 if text.startswith('}') else 0]


def end_of_statement(lines, start):
    while not lines[start].rstrip().endswith((';', '}', ',')):
        start += 1
    return start + 1


def apply(step, words, path, file):
    """Returns whether the step could be applied."""
    block = block_of(step)
    words = re.sub(r'\s*\n\s*', ' ', words.split('\n\n')[0])
    place = re.search('(before|instead of) `([^`]+)`', words)
    if not block or not (place or 'at the end' in words):
        return False
    lines = path.read_text().split('\n')
    gone = re.search('without `([^`]+)`', words)
    if gone:
        del lines[find(lines, gone[1], file)]
    if place:
        start = find(lines, place[2], file)
        neighbour = lines[start - 1] if lines[start].startswith('}') else lines[start]
        indent = re.match(' *', neighbour)[0]
        end = end_of_statement(lines, start) if place[1] == 'instead of' else start
        block = [indent + line if line else '' for line in block]
        if '}  // namespace' in lines[start]:
            block.append('')
        lines[start:end] = block
    else:
        lines[len(lines) - 1:len(lines) - 1] = block
    path.write_text('\n'.join(lines))
    return True


def main():
    if sys.argv[1:] not in ([], ['apply']):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix='recipes_') as folder:
        copy = pathlib.Path(folder) / 'spring_pendulum'
        files = subprocess.run(['git', '-c', 'safe.directory=%s' % PROJECT, '-C', PROJECT, 'ls-files', '-z'],
                               check=True, text=True, stdout=subprocess.PIPE).stdout.split('\0')
        for name in filter(None, files):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(PROJECT / name, copy / name)
        commands, changed = [], set()
        for title, text in recipes().items():
            steps = [(m['file'], m['words'], m[0]) for m in STEP.finditer(text)]
            applied = [file for file, words, step in steps if '/' in file and (copy / file).is_file() and
                       apply(step, words, copy / file, file)]
            print('%s: %d of %d steps applied' % (title, len(applied), len(steps)))
            changed.update(applied)
            if applied:
                commands += COMMAND.findall(text)
        if len(changed) < 12:
            sys.exit('only %d files were changed: the steps are not understood' % len(changed))
        sources = sorted(str(copy / name) for name in changed if name.endswith(('.cpp', '.hpp')))
        subprocess.run(['clang-format', '--dry-run', '--Werror', *sources], check=True)
        if sys.argv[1:] == ['apply']:
            return
        subprocess.run(['scripts/generate.sh'], cwd=copy, check=True)
        subprocess.run(['cmake', '--build', 'build'], cwd=copy, check=True)
        failed = []
        for command in commands:
            print(command, flush=True)
            shown = command + ' --no-tests=error --output-on-failure' * command.startswith('ctest')
            if subprocess.run(shown, cwd=copy, shell=True).returncode != 0:
                failed.append(command)
        if failed:
            sys.exit('failed:\n' + '\n'.join(failed))


main()
