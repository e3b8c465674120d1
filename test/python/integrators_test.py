"""Integrators, own methods and tables are those of simulate."""
import unittest

import numpy as np
from support import SCENE

import spring_pendulum as sp


class Integrators(unittest.TestCase):
    def test_advance_is_the_same_motion(self):
        rows = np.loadtxt(SCENE)
        state = sp.State(rows[:, 0], rows[:, 1])
        integrator = sp.make_integrator('Runge-Kutta-4', sp.Chain(rows[:, 2]), track_dissipation=True)
        integrator.advance(state, 0.01, 990)
        run = sp.simulate(SCENE, frames=100)
        self.assertEqual(state.positions.tobytes(), run.positions[-1].tobytes(order='C'))
        self.assertEqual(integrator.dissipated_energy, run.energy.dissipated[-1])
        self.assertEqual(integrator.force_evaluations, run.force_evaluations)

    def test_an_own_method_has_the_bits_of_the_built_in_one(self):
        copied = sp.register_method('Kutta-again', a=[[], [.5], [0, .5], [0, 0, 1]], b=[1 / 6, 1 / 3, 1 / 3, 1 / 6])
        known = sp.find_method('runge kutta 4')
        self.assertEqual((copied.order, copied.stages, copied.fixed_step), (known.order, known.stages, True))
        self.assertAlmostEqual(copied.real_stability_limit, known.real_stability_limit)
        self.assertAlmostEqual(copied.imaginary_stability_limit, known.imaginary_stability_limit)
        self.assertIn('Kutta-again', [method.name for method in sp.methods()])
        self.assertEqual(sp.simulate(SCENE, method='kutta again').positions.tobytes(),
                         sp.simulate(SCENE).positions.tobytes())


class WorkPrecision(unittest.TestCase):
    def test_shows_the_order_of_a_method(self):
        table = sp.work_precision(SCENE, ['Runge-Kutta-4', 'Taylor-8'], duration=2.0, time_steps=[0.02, 0.01, 0.005],
                                  tolerances=[1e-6])
        self.assertEqual([point.method for point in table], ['Runge-Kutta-4'] * 3 + ['Taylor-8'])
        self.assertEqual([point.force_evaluations for point in table[:3]], [400, 800, 1600])
        errors = [point.error for point in table]
        for coarse, fine in zip(errors[:2], errors[1:3]):
            self.assertTrue(12 < coarse / fine < 20, errors)  # measured: 15.5 and 15.8
        self.assertLess(errors[3], 1e-5)
        self.assertTrue(all(point.seconds > 0 for point in table))

    def test_divergence_is_an_infinite_error(self):
        point, = sp.work_precision(SCENE, ['Euler'], time_steps=[0.2], stiffness=500.0)
        self.assertEqual((point.error, point.control, point.value), (float('inf'), 'time_step', 0.2))
