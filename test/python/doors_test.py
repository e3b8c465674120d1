"""Every option of a run acts in every program, or is refused by its name."""
import hashlib
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import EXERCISE3, SCENE

import spring_pendulum as sp
from spring_pendulum import _core

# Values with a visible effect, and what it needs; other options get another number than their default.
VALUES = {'method': 'Euler', 'particles': SCENE.with_name('two_masses.txt'), 'resume': True, 'output': 'elsewhere',
          'no_frames': True, 'energy': 'energy.csv', 'save_state': 'state.txt', 'start': 'at_rest',
          'on_divergence': 'continue', 'reference': 'never', 'sleep': 1e3}
FRACTIONS = ('stiffness', 'damping', 'rest_length', 'air_drag')
BASES = {'on_divergence': {'time_step': 0.5}, 'tolerance': {'method': 'Auto'}, 'frame_interval': {'method': 'Auto'}}


def run(program, *arguments, **options):
    words = ['--%s%s' % (key.replace('_', '-'), '' if value is True else '=%s' % value)
             for key, value in options.items()]
    command = [pathlib.Path(EXERCISE3).with_name(program), *arguments, *words]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return result.returncode, result.stdout, result.stderr


def write_yaml(path, options, head='', tail=''):
    lines = ['%s: %s' % (key, str(value).lower() if value is True else value) for key, value in options.items()]
    pathlib.Path(path).write_text(head + '\n'.join('  ' * bool(head) + line for line in lines) + tail + '\n')


def config(**options):
    write_yaml('run.yaml', options)
    result = run('Exercise3', options['method'], config='run.yaml')
    os.remove('run.yaml')
    return result


def python(**options):
    try:
        result = sp.simulate(**options)
    except (sp.InputError, sp.FileError) as error:
        return 2, '', str(error)
    return 0, result.closing_line, str(result.positions.tobytes())


def sweep(**options):
    write_yaml('study.yaml', options, 'base:\n', '\ncolumns: [verdict, position_error, measured_until, tip_x, diverged_at, force_evaluations]')
    result = run('sweep', 'study.yaml')
    os.remove('study.yaml')
    return result


def check_frames(**options):
    run('Exercise3', 'Runge-Kutta-4', particles=SCENE, frames=30, output='frames')
    return run('check_frames', 'frames', **options)


DOORS = {'python': python, 'sweep': sweep, 'config': config, 'check_frames': check_frames}
for program in 'Exercise3', 'record_bag':  # the latter only with ROS
    if pathlib.Path(EXERCISE3).with_name(program).exists():
        DOORS[program] = lambda method, program=program, **options: run(program, method, **options)


def outcome(door, options):
    """Status and error of a run, and a hash of all that it leaves behind but the time it took."""
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        status, *texts = door(**options)
        os.chdir(before)
        folder = pathlib.Path(name)
        files = {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob('*') if path.is_file()}
    times = re.compile(r'[0-9.]+ [mun]?s (?=integrating|reference|writing)|' + name)
    seen = repr((status, [times.sub('', text) for text in texts], sorted(files.items())))
    return status, texts[1], hashlib.sha256(seen.encode()).hexdigest()


class Doors(unittest.TestCase):
    def test_every_option_acts_or_is_refused_by_name(self):
        for key, default, *_ in _core.options():
            if key == 'threads':
                continue  # results do not depend on it
            changed = VALUES.get(key)
            if changed is None:
                changed = int(default) + 2 if default.isdigit() and key not in FRACTIONS else 1.5 * float(default) + 0.01
            base = {'method': 'Runge-Kutta-4', 'particles': SCENE, 'frames': 30, **BASES.get(key, {})}
            for name, door in DOORS.items():
                with self.subTest(option=key, door=name):
                    base.pop('output', None)
                    if name not in ('sweep', 'check_frames'):
                        base['output'] = 'frames'
                    status, errors, seen = outcome(door, {**base, key: changed})
                    if status != 2 or not re.search(r'\b%s\b' % key, errors.replace('-', '_')):
                        self.assertNotEqual(seen, outcome(door, base)[2])
