"""simulate and check do what Exercise3 does: the same bits, files, texts."""
import inspect
import pathlib
import re
import tempfile
import unittest
import warnings

import numpy as np
from support import DATA, SCENE, exercise3

import spring_pendulum as sp
from spring_pendulum import _core

SCENES = sorted(DATA.glob('*.txt'))


def read_frames(folder):
    paths = sorted(pathlib.Path(folder).glob('frame_*.txt'))
    return np.array([[[float(number) for number in line.split()] for line in path.read_text().splitlines()]
                     for path in paths])


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        warnings.simplefilter('ignore', RuntimeWarning)


class Frames(Folder):
    def test_have_the_bits_of_exercise3(self):
        self.assertGreaterEqual(len(SCENES), 7)
        for number, method in enumerate(sp.methods()):
            for scene in SCENES:
                with self.subTest(method=method.name, scene=scene.name):
                    folder = self.folder / (scene.stem + str(number))
                    exercise3(method.name, scene, '--output', folder, '--frames', 30)
                    run = sp.simulate(scene, method=method.name, frames=30)
                    self.assertEqual(run.positions.tobytes(), read_frames(folder).tobytes())

    def test_of_an_array_are_those_of_its_file(self):
        rows = np.loadtxt(SCENE)
        expected = sp.simulate(SCENE).positions.tobytes()
        fortran = np.asfortranarray(rows)
        strided = np.repeat(np.repeat(rows, 2, axis=0), 3, axis=1)[::2, ::3]
        for array in (rows, rows.tolist(), fortran, strided, rows[::-1].copy()[::-1], rows.astype(np.longdouble)):
            self.assertEqual(sp.simulate(array).positions.tobytes(), expected)
        moving = np.column_stack([rows, np.zeros((len(rows), 2))])
        self.assertEqual(sp.simulate(moving).positions.tobytes(), expected)
        single = sp.simulate(rows.astype(np.float32))
        self.assertLess(abs(single.positions[0] - rows[:, :2]).max(), 1e-6)

    def test_and_files_written_are_those_of_exercise3(self):
        names = [self.folder / 'own', self.folder / 'own.csv', self.folder / 'own.txt']
        run = sp.simulate(SCENE, output=names[0], energy=str(names[1]), save_state=names[2], frames=12)
        self.assertIn('writing to %s' % names[0], repr(run))
        exercise3('Runge-Kutta-4', SCENE, '--frames', 12, '--output', self.folder / 'program', '--energy',
                  self.folder / 'program.csv', '--save-state', self.folder / 'program.txt')
        self.assertEqual(run.positions.tobytes(), read_frames(self.folder / 'program').tobytes())
        for suffix in ('.csv', '.txt'):
            self.assertEqual((self.folder / ('own' + suffix)).read_text(),
                             (self.folder / ('program' + suffix)).read_text())
        rows = np.loadtxt(names[1], delimiter=',', skiprows=1)
        own = np.column_stack([range(12), run.time, *run.energy, run.position_error])
        self.assertEqual(own.tobytes(), rows.tobytes())
        again = sp.simulate(names[2], resume=True, frames=15)
        whole = sp.simulate(SCENE, frames=15)
        self.assertEqual(again.positions.tobytes(), whole.positions[11:].tobytes())
        self.assertEqual(again.time.tobytes(), whole.time[11:].tobytes())

    def test_nothing_is_written_unless_asked(self):
        before = sorted(pathlib.Path('.').iterdir())
        sp.simulate(SCENE, frames=3)
        self.assertEqual(sorted(pathlib.Path('.').iterdir()), before)


class Measurements(Folder):
    def test_closing_line_and_verdict_are_those_of_exercise3(self):
        line = exercise3('Runge-Kutta-2', SCENE, '--no-frames').stdout
        without_times = re.compile(r'[\d.]+ (ms|s) (integrating|reference run)')
        run = sp.simulate(SCENE, method='runge kutta 2')
        self.assertEqual(without_times.sub('', repr(run)), without_times.sub('', line.strip()))
        self.assertTrue(line.strip().endswith('verdict: ' + run.verdict.kind))

    def test_check_says_what_exercise3_says(self):
        rng = np.random.default_rng(1)
        for k, method in enumerate(('Euler', 'Euler', 'Runge-Kutta-2', 'Runge-Kutta-4', 'Velocity-Verlet', 'Auto')):
            options = {'start': ['at_rest', 'file'][k % 2], 'damping': float(rng.uniform(0, 2)),
                       'air_drag': float(rng.choice([0, 0.1])), 'frames': int(rng.integers(2, 200))}
            words = [word for key, value in options.items() for word in ('--' + key.replace('_', '-'), value)]
            report = sp.check(SCENE, method=method, **options)
            self.assertEqual(report.text, exercise3(method, SCENE, '--check', *words).stdout, options)
        euler = sp.check(SCENE, method='Euler')
        self.assertAlmostEqual(euler.largest_stable_step, 0.00638)
        self.assertAlmostEqual(euler.largest_accurate_step, 1.84e-5)
        self.assertEqual(euler.verdict.kind, 'gained energy')
        self.assertIsNone(sp.check(SCENE, method='Auto').largest_stable_step)

    def test_warnings_are_those_of_exercise3(self):
        for scene, method, options in (('particle.txt', 'Auto', {'damping': 0.0}), ('folded_20.txt', 'Auto', {'damping': 0.0}),
                                       ('particle.txt', 'Euler', {'time_step': 0.1})):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter('always')
                sp.simulate(DATA / scene, method=method, **options)
            words = ['--%s=%s' % (key.replace('_', '-'), value) for key, value in options.items()]
            lines = exercise3(method, DATA / scene, '--no-frames', *words).stderr.splitlines()
            lines = [line.replace('warning: ', '') for line in lines]
            self.assertEqual([str(warning.message) for warning in caught], lines)
            self.assertGreater(len(lines), 1 if method == 'Auto' else 0)


class Keywords(unittest.TestCase):
    def test_are_the_options_of_exercise3_with_their_defaults(self):
        keys = [row[0] for row in _core.options()]
        help_text = exercise3('--help').stdout
        for key in keys:
            self.assertTrue(key == 'method' or '--' + key.replace('_', '-') in help_text, key)
        for function in (sp.simulate, sp.check):
            parameters = inspect.signature(function).parameters
            self.assertEqual(sorted(parameters), sorted(keys))
            self.assertEqual(next(iter(parameters)), 'particles')
            self.assertEqual(parameters['time_step'].default, 0.01)
            for key in keys:
                self.assertIn('\n    %s: ' % key, function.__doc__)
