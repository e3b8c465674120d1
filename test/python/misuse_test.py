"""A wrong call of any kind raises an exception with one line, and never crashes."""
import itertools
import os
import pathlib
import tempfile
import unittest

import numpy as np
from support import SCENE, exercise3

import spring_pendulum as sp

TWO = [[0, 0, 1], [1, 0, 1]]
NAN = float('nan')


class Misuse(unittest.TestCase):
    def refused(self, text, call, *arguments, error=sp.InputError, **options):
        with self.assertRaises(error) as caught:
            call(*arguments, **options)
        self.assertNotIn('\n', str(caught.exception))
        self.assertRegex(str(caught.exception), text)

    def test_wrong_values_have_the_line_of_exercise3(self):
        values = [('time_step', -1), ('time_step', 0), ('time_step', NAN), ('time_step', float('inf')),
                  ('frames', 0), ('frames', 2.5), ('frames', 10**30), ('gravity', NAN), ('stiffness', -1),
                  ('reference', 'often'), ('threads', -3), ('sleep', -0.5), ('steps_per_frame', 0),
                  ('method', 'rk44'), ('method', '')]
        for key, value in values:
            option = [value] if key == 'method' else ['Runge-Kutta-4', '--' + key.replace('_', '-') + '=' + str(value)]
            line = exercise3(*option, SCENE).stderr
            line = line.replace('--' + key.replace('_', '-'), key).replace('METHOD: ', 'method: ').rstrip('\n')
            with self.subTest(key=key, value=value):
                with self.assertRaises(sp.InputError) as caught:
                    sp.simulate(SCENE, **{key: value})
                self.assertEqual(str(caught.exception).replace('-1.0', '-1'), line)

    def test_wrong_types_and_keywords(self):
        self.refused("unknown option 'time_stp'; did you mean 'time_step'", sp.simulate, SCENE, time_stp=1)
        self.refused('tolerance: Euler takes fixed steps; use time_step', sp.simulate, SCENE, method='Euler',
                     tolerance=1)
        wrong = {'method': (3, None, b'Euler', [], 'a\0b', '\ud800'), 'time_step': ('0.1', None, True, 1j, [0.1, 0.2], TWO, object),
                 'frames': ('5', None, NAN, True, [5], 10**5000), 'no_frames': (1, 'true', None), 'output': (5, None, TWO, 'a\0'),
                 'on_divergence': (True, None)}
        for key, values in wrong.items():
            for value in values:
                with self.subTest(key=key, value=value):
                    self.refused('^%s: must be ' % key, sp.simulate, SCENE, **{key: value})
                    self.refused('^%s: must be ' % key, sp.check, SCENE, **{key: value})
        self.assertEqual(len(sp.simulate(SCENE, frames=np.int8(3), time_step=np.float32(0.01), no_frames=np.True_).time), 3)
        self.assertEqual(sp.simulate(SCENE, method='Auto', frames=2, frame_interval=np.array(1.5)).time[1], 1.5)

    def test_wrong_particles(self):
        for wrong in (None, 3, [1, 2, 3], np.zeros((2, 3, 4)), [['a', 'b', 'c']], [[0, 0, 1], [1, 0]], [[1j, 0, 0]],
                      np.zeros(3, dtype='M8[s]'), {}, object(), [], [None, None], iter(TWO), b'particle.txt'):
            with self.subTest(particles=wrong):
                self.refused('particles: must be numbers in an array with ndim 2', sp.simulate, wrong)
        for text, wrong in (('no particles', np.zeros((0, 3))), ('2 numbers', [[0, 0]]), ('mass', [[0, 0, 1], [1, 0, -1]]),
                            ("particles:2: 'nan'", [[0, 0, 1], [NAN, 0, 1]]), ("'inf'", [[0, 0, 1], [1, float('inf'), 1]]),
                            ('same position', [[0, 0, 1], [0, 0, 1]]), ('particles:2: mass', [[0, 0, 1], [1, 0, 0]])):
            self.refused(text, sp.simulate, wrong)
        self.assertEqual(sp.simulate([[0, 0, 1]], frames=2).positions.shape, (2, 1, 2))

    def test_files(self):
        self.refused('nowhere.txt', sp.simulate, pathlib.Path('nowhere.txt'), error=OSError)
        self.refused('particles: must be a path', sp.simulate, 'a\0b')
        self.refused('.', sp.simulate, '', error=sp.FileError)
        self.refused('.', sp.simulate, SCENE, output='/proc/none', error=sp.FileError)
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(os.fsencode(folder), b'\xff\n.txt')
            self.refused('could not be read', sp.simulate, os.fsdecode(name), error=sp.FileError)
            path = pathlib.Path(folder, 'bad.txt')
            path.write_text('0 0 1\n1 0\n')
            self.refused('bad.txt:2: 2 numbers', sp.simulate, path)

    def test_too_large(self):
        self.refused('.', sp.simulate, TWO, frames=10**16, error=MemoryError)
        self.refused('.', sp.simulate, TWO, frames=2 * 10**17, steps_per_frame=1, error=MemoryError)
        self.refused('must be at most', sp.simulate, TWO, frames=2**62, steps_per_frame=100)

    def test_objects(self):
        chain, state = sp.Chain([1, 1, 1]), sp.State([0, 1, 2], [0, 0, 0])
        for masses in (None, 'abc', np.ma.masked_less([1., 2], 2), [[1, 2]], [1, NAN], [1, -1], [1, 0], []):
            self.refused('mass|particle', sp.Chain, masses)
        for key, value in itertools.product(('stiffness', 'damping', 'rest_length'), (-1, NAN, float('inf'))):
            self.refused(key.split('_')[-1], sp.Chain, [1, 1], **{key: value})
        self.refused('y: must have as many numbers as x, 2, got 1', sp.State, [0, 1], [0])
        self.refused(r'vx\[1\]: must be finite', sp.State, [0, 1], [0, 0], vx=[0, NAN])
        self.refused('x: must be numbers', sp.State, 'ab', [0])
        self.refused("unknown method 'rk4x'", sp.make_integrator, 'rk4x', chain)
        self.refused('tolerance', sp.make_integrator, 'Auto', chain, tolerance=NAN)
        self.refused('^tolerance: Runge-Kutta-4 takes fixed steps', sp.make_integrator, 'Runge-Kutta-4', chain, tolerance=1e-3)
        integrator = sp.make_integrator('Euler', chain)
        for step, count in ((0, 1), (-1, 1), (NAN, 1), (0.1, -1)):
            self.refused('must be', integrator.advance, state, step, count)
        self.refused('3', integrator.advance, sp.State([0, 1], [0, 0]), 0.1, 1)
        self.refused('tolerance: must', sp.make_integrator('Auto', chain, tolerance=1e-30).advance, state, 0.1, 1)
        for call in (lambda: sp.Chain(), lambda: sp.State([0]), lambda: integrator.advance(None, 0.1, 1),
                     lambda: integrator.advance(state, 'a', 1), lambda: integrator.advance(state, 0.1, 1.5),
                     lambda: sp.make_integrator('Euler', None), lambda: sp.Chain([1], stiffness='a'), lambda: sp.Integrator(),
                     lambda: sp.register_method('wrong', a=3, b=[1]), lambda: sp.simulate(SCENE, 'Euler')):
            self.assertRaises(TypeError, call)
        self.assertRaises(ValueError, chain.masses.__setitem__, 1, 5)
        self.assertEqual(state.x.tolist(), [0, 1, 2])

    def test_work_precision(self):
        for key, value in [('duration', NAN), ('duration', -1), ('duration', float('inf')), ('time_steps', [0.1, 0]),
                           ('time_steps', [NAN]), ('time_steps', [1e-320])]:
            with self.subTest(key=key, value=value):
                self.refused('^%s: must be above 0 s' % key, sp.work_precision, SCENE, ['Euler'], **{key: value})
        self.refused("unknown method 'Oiler'", sp.work_precision, SCENE, 'Oiler')

    def test_methods(self):
        good = {'a': [[], [1]], 'b': [.5, .5]}
        for text, wrong in (('a and b', {'a': [], 'b': []}), ('a and b', {'a': [[]], 'b': [.5, .5]}),
                            ('add up to 1', {'a': [[]], 'b': [.5]}), ('on and above the diagonal', {'a': [[1]], 'b': [1]}),
                            ('finite', {'a': [[]], 'b': [NAN]}), ('at most', {'a': [[1, 2, 3]], 'b': [1]}),
                            (r'a\[1\]: must be numbers', {'a': [[], 'x'], 'b': [.5, .5]}), ('b: ', {'a': [[]], 'b': None})):
            self.refused(text, sp.register_method, 'wrong', **wrong)
        for text, name in (('exists', 'euler'), ('needs a name', ''), ('needs a name', ' ')):
            self.refused(text, sp.register_method, name, **good)
