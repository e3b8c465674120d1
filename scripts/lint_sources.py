#!/usr/bin/python3
"""Checks the structure of the sources, and lists the sources for clang-tidy.

    lint_sources.py check             include order, circles, public headers, sizes of files and folders
    lint_sources.py tidy [BASE]       one path per line: sources to check after a change since commit
                                      BASE (default: all); for a changed header a source that reads it
"""
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
FOLDERS = ('include', 'src', 'python', 'test', 'benchmark', 'fuzz', 'examples')
MOST_LINES = 400
MOST_FILES = 15  # in a folder of the library


def read_folders():
    """The ranks of the layers, and in each layer those of its rooms: the table of CONTRIBUTING.md. A layer includes
    itself and layers of a lower rank; inside a layer the rooms, its folders, rank too."""
    layers, rooms, layer = {}, {}, None
    table = (PROJECT / 'CONTRIBUTING.md').read_text().split('| folder | subfolder |')[1].split('\n\n')[0]
    for row in table.split('\n')[2:]:
        names, subfolders = (cell.strip() for cell in row.split('|')[1:3])
        if names:
            rank, layer = len(set(layers.values())), re.findall(r'\w+', names)[-1]
            layers.update(dict.fromkeys(re.findall(r'\w+', names), rank))
            rooms[layer], place = {}, -1 if subfolders.startswith('(') or not subfolders else 0
        place += 1
        rooms[layer].update(dict.fromkeys(re.findall(r'`(\w+)`', subfolders), place))
    return layers, rooms


LAYERS, ROOMS = read_folders()
# Files directly in the folder of a layer come before its rooms, in these layers after them ...
AFTER_THE_ROOMS = {'integration': 5, 'ros': 6}
# ... except for these, and for these, which come between two rooms.
BETWEEN_ROOMS = {'run': 2, 'outcome': 2}
BEFORE_THE_ROOMS = ('integrator', 'butcher_tableau', 'work')


def git(*arguments):
    command = ['git', '-c', f'safe.directory={PROJECT}', '-C', str(PROJECT), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def sources():
    names = git('ls-files', '--cached', '--others', '--exclude-standard', '*.hpp', '*.cpp')
    return [Path(name) for name in names if (PROJECT / name).exists()]


def place(path):
    """(layer, room) of a library file such as src/integration/taylor/x.hpp; None for any other."""
    parts = path.parts
    if parts[:2] == ('include', 'spring_pendulum'):
        parts = parts[2:]
    elif parts[0] == 'src':
        parts = parts[1:]
    else:
        return None
    if parts[0] not in LAYERS:
        return None  # programs and the umbrella header
    layer, room = parts[0], parts[1] if len(parts) > 2 else ''
    if room:
        return layer, ROOMS[layer][room], room
    if path.stem in BETWEEN_ROOMS:
        return layer, BETWEEN_ROOMS[path.stem], room
    return layer, 0 if path.stem in BEFORE_THE_ROOMS else AFTER_THE_ROOMS.get(layer, 0), room


def resolve(name, includer, known):
    """The file of the project that an include directive refers to; None for other headers."""
    for folder in (includer.parent, *map(Path, ('include', 'src', 'test', 'benchmark', 'examples'))):
        if folder / name in known:
            return folder / name
    return None


def include_graph(files):
    known = set(files)
    graph = {}
    for path in files:
        text = (PROJECT / path).read_text()
        names = re.findall(r'^#include [<"]([^>"]+)[>"]', text, re.MULTILINE)
        graph[path] = [target for name in names if (target := resolve(name, path, known))]
    return graph


def order_errors(graph):
    for path, targets in graph.items():
        here = place(path)
        for target in targets:
            there = place(target)
            if here and not there:
                yield f'{path}: includes {target}, which is no part of the library'
            elif here and there and LAYERS[there[0]] > LAYERS[here[0]]:
                yield f'{path}: includes {target}, but {there[0]} comes after {here[0]}'
            elif here and there and here[0] == there[0]:
                same_rank = there[1] == here[1] and there[2] != here[2]
                if there[1] > here[1] or same_rank:
                    yield f'{path}: includes {target} of a room that is not below its own'
            if path.parts[0] == 'include' and target.parts[0] != 'include':
                yield f'{path}: public, includes {target}, which is not'


def circle(graph):
    """A list of files that include each other in a circle; empty: none."""
    done, trail = set(), []

    def visit(path):
        if path in trail:
            return trail[trail.index(path):] + [path]
        if path in done:
            return []
        trail.append(path)
        found = next((f for target in graph[path] if (f := visit(target))), [])
        trail.pop()
        done.add(path)
        return found

    return next((found for path in graph if (found := visit(path))), [])


def file_errors(files):
    ros = re.compile(r'#include <(ros|rosbag|[a-z_]+_msgs)/')
    exported = re.compile(r'^#pragma GCC visibility push\(default\)\nnamespace spring_pendulum \{$.*'
                          r'^\}  // namespace spring_pendulum\n#pragma GCC visibility pop$',
                          re.DOTALL | re.MULTILINE)
    for path in files:
        text = (PROJECT / path).read_text()
        lines = text.count('\n')
        if lines > MOST_LINES:
            yield f'{path}: {lines} lines, allowed are {MOST_LINES}'
        if path.parts[0] == 'include' and 'namespace spring_pendulum {' in text and not exported.search(text):
            yield f'{path}: public, must export its namespace with #pragma GCC visibility'
        here = place(path)
        if here and here[0] != 'ros' and ros.search(text):
            yield f'{path}: includes ROS, which only src/ros may'
        # ROS time may stand still: wait and throttle by the wall clock.
        if str(path).startswith('src/ros/') and re.search(r'_THROTTLE|ros::(Rate|Timer)|ros::Duration\(.*sleep', text):
            yield f'{path}: waits or throttles in ROS time; use ros::WallDuration and Throttle'


def folder_errors(files):
    library = [path for path in files if path.parts[0] in ('include', 'src')]
    for folder, count in Counter(path.parent for path in library).items():
        if count > MOST_FILES:
            yield f'{folder}: {count} files, allowed are {MOST_FILES}'


# Lines of code that a newcomer has to hold in the head: rooms with their public headers, and a program with its room.
# A change that does not fit takes something else out; a budget only falls.
BUDGETS = {
    'base, model': (1300, 'src/base', 'src/model', 'include/spring_pendulum/base', 'include/spring_pendulum/model'),
    'integration': (6000, 'src/integration', 'include/spring_pendulum/integration'),
    'simulation': (2410, 'src/simulation', 'include/spring_pendulum/simulation'),
    'io': (2350, 'src/io', 'include/spring_pendulum/io', 'src/Exercise3.cpp'),
    'ros': (3680, 'src/ros', 'src/pendulum_node.cpp', 'src/record_bag.cpp'),
    'check': (1400, 'src/check', 'src/check_frames.cpp'),
    'sweep': (1700, 'src/sweep', 'src/sweep.cpp'),
    'src, include': (18890, 'src', 'include'),
    'web': (3000, 'web'),
    'python': (1000, 'python'),
    'test': (17000, 'test'),
}
MOST_TRACKED = 560  # files


def budget_errors():
    """Prints the lines of each room beside its budget."""
    tracked = git('ls-files')
    yield from [f'{len(tracked)} files are tracked, allowed are {MOST_TRACKED}'] if len(tracked) > MOST_TRACKED else []
    for room, (budget, *places) in BUDGETS.items():
        paths = [path for path in tracked if not path.startswith('test/data/')
                 and any(path == place or path.startswith(place + '/') for place in places)]
        lines = sum((PROJECT / path).read_bytes().count(b'\n') for path in paths if (PROJECT / path).is_file())
        print(f'{room}: {lines} lines of {budget}')
        if lines > budget:
            yield f'{room}: {lines} lines, allowed are {budget}'


def check():
    files = sources()
    graph = include_graph(files)
    errors = [*order_errors(graph), *file_errors(files), *folder_errors(files), *budget_errors()]
    if round_trip := circle(graph):
        errors.append('circle of includes: ' + ' -> '.join(map(str, round_trip)))
    print('\n'.join(errors), end='\n' if errors else '')
    return 1 if errors else 0


def reader_of(header, readers):
    """A source that includes the header, directly or indirectly; its own source if there is one."""
    seen, found, queue = set(), [], [header]
    while queue:
        for reader in readers.get(queue.pop(), []):
            if reader in seen:
                continue
            seen.add(reader)
            (found if reader.suffix == '.cpp' else queue).append(reader)
    own = [source for source in found if source.stem == header.stem]
    return min(own or found, default=None)


def tidy(base):
    files = sources()
    if base is None:
        changed = files
    else:
        names = {Path(name) for name in git('diff', '--name-only', base)}
        names |= {Path(name) for name in git('ls-files', '--others', '--exclude-standard')}
        changed = [path for path in files if path in names]
    readers = {}
    for path, targets in include_graph(files).items():
        for target in targets:
            readers.setdefault(target, []).append(path)
    chosen = {path if path.suffix == '.cpp' else reader_of(path, readers) for path in changed}
    print('\n'.join(sorted(str(path) for path in chosen - {None} if path.parts[0] in FOLDERS)))
    return 0


if __name__ == '__main__':
    if sys.argv[1:] == ['check']:
        sys.exit(check())
    if sys.argv[1:2] == ['tidy'] and len(sys.argv) <= 3:
        sys.exit(tidy(sys.argv[2] if len(sys.argv) == 3 else None))
    sys.exit(__doc__)
