"""Lifetime, copies, threads and interruptions of the objects."""
import copy
import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
from support import SCENE

import spring_pendulum as sp


def long_chain(particles=1000):
    return (sp.Chain(np.ones(particles)), sp.State(np.arange(particles), np.zeros(particles)))


class Views(unittest.TestCase):
    def test_show_the_state_without_a_copy(self):
        state = sp.State([0, 1, 2], [3, 4, 5], vx=[0, .5, 0], vy=[0, 0, .25])
        self.assertTrue(np.shares_memory(state.x, state.positions))
        self.assertTrue(np.shares_memory(state.vy, state.velocities))
        self.assertEqual(state.positions.tolist(), [[0, 3], [1, 4], [2, 5]])
        self.assertEqual(state.velocities.tolist(), [[0, 0], [.5, 0], [0, .25]])
        x = state.x
        x[2] = 7
        self.assertEqual(state.positions[2, 0], 7)
        sp.make_integrator('Auto', sp.Chain([1, 1, 1]), tolerance=1e-9).advance(state, 0.1, 1)
        self.assertNotEqual(x[2], 7)

    def test_keep_their_owner_alive(self):
        run = sp.simulate(SCENE, frames=5).positions
        views = sp.State(np.full(1000, 3.0), np.zeros(1000)).positions, sp.Chain(np.full(1000, 3.0)).masses, run
        gc.collect()
        others = [sp.State(np.full(1000, 9.0), np.zeros(1000)) for _ in range(100)]
        self.assertEqual(views[0][:, 0].tolist(), [3.0] * 1000)
        self.assertEqual(views[1].tolist(), [3.0] * 1000)
        self.assertEqual(views[2].tobytes(), sp.simulate(SCENE, frames=5).positions.tobytes())
        self.assertEqual(len(others), 100)


class Copies(unittest.TestCase):
    def test_are_equal_and_independent(self):
        chain = sp.Chain([1, 2, 3], stiffness=7, damping=.5, rest_length=2, gravity=-1)
        state = sp.State([0, 1, 2], [3, 4, 5], [0, 6, 7], [0, 8, 9])
        state.y[0], state.vx[1], state.vy[0] = float('nan'), float('inf'), -0.0  # a state that diverged
        run, numbers = sp.simulate(SCENE, frames=3), [state.positions.tobytes(), state.velocities.tobytes()]
        pickles = [lambda value, p=p: pickle.loads(pickle.dumps(value, p)) for p in range(pickle.HIGHEST_PROTOCOL + 1)]
        for duplicate in (copy.copy, copy.deepcopy, *pickles):
            self.assertEqual(duplicate(run).positions.tobytes(), run.positions.tobytes())
            self.assertRaises(TypeError, duplicate, sp.make_integrator('Euler', chain))
            self.assertRaises(TypeError, duplicate, sp.find_method('Euler'))
            other = duplicate(chain)
            for key in ('stiffness', 'damping', 'rest_length', 'gravity', 'air_drag'):
                self.assertEqual(getattr(other, key), getattr(chain, key))
            self.assertEqual(other.masses.tolist(), [1, 2, 3])
            moved = duplicate(state)
            self.assertEqual([moved.positions.tobytes(), moved.velocities.tobytes()], numbers)
            moved.x[1] = 50
            self.assertEqual(state.x[1], 1)


class Threads(unittest.TestCase):
    def test_integrate_at_once_with_the_same_bits(self):
        rows = np.loadtxt(SCENE)

        def work(names):
            return [sp.simulate(rows, method=name, frames=200).positions.tobytes() for name in names]

        names = ['Auto', 'Taylor-8']
        with ThreadPoolExecutor(6) as pool:
            self.assertEqual(list(pool.map(work, [names * 3] * 6)), [work(names) * 3] * 6)

    def test_leave_the_interpreter_free_but_not_the_integrator(self):
        chain, state = long_chain()
        integrator = sp.make_integrator('Runge-Kutta-4', chain)
        pool, ticks, refusals = ThreadPoolExecutor(1), 0, 0
        work = pool.submit(integrator.advance, state, 1e-6, 30000)
        while not work.done():
            time.sleep(0.001)
            ticks += 1
            for call in (lambda: integrator.advance(sp.State(state.x, state.y), 1e-6, 1), integrator.restart,
                         lambda: integrator.dissipated_energy, lambda: sp.register_method('late', a=[[]], b=[1])):
                try:
                    call()
                except sp.InputError as error:
                    refusals += 'thread' in str(error)
            if ticks == 10 and (child := os.fork()) == 0:  # without the other thread
                sp.register_method('forked', a=[[]], b=[1])
                os._exit(0)
        work.result()
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertGreater(ticks, 10)
        self.assertGreater(refusals, 10)
        integrator.advance(state, 1e-6, 1)

    def test_start_anew_in_a_forked_process(self):
        chain, state = long_chain(20000)
        integrator = sp.make_integrator('Runge-Kutta-4', chain, threads=3)

        def positions():
            moved = copy.copy(state)
            integrator.advance(moved, 1e-3, 20)
            return moved.positions.tobytes()

        expected = positions()
        child = os.fork()
        if child == 0:
            os._exit(0 if positions() == expected else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_of_a_spawned_process_import_the_module(self):
        for kind in 'spawn', 'forkserver':
            with ProcessPoolExecutor(1, multiprocessing.get_context(kind)) as pool:
                self.assertEqual(pool.submit(len, sp.Chain([1, 2])).result(), 2)

    def test_start_at_once_and_end_with_python(self):
        code = """import sys, threading, time, spring_pendulum as sp
def work(steps):
    while True: sp.simulate(sys.argv[1], frames=9, steps_per_frame=steps, reference='never')
for steps in 1, 1, 1, 10**9: threading.Thread(target=work, args=[steps], daemon=True).start()
time.sleep(0.3)"""
        done = subprocess.run([sys.executable, '-c', code, SCENE], stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ''))


class CtrlC(unittest.TestCase):
    def interrupted(self, call):
        """Seconds from Ctrl-C to the exception."""
        sent = []

        def send():
            sent.append(time.perf_counter())
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

        timer = threading.Timer(0.2, send)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            call()
        timer.join()
        return time.perf_counter() - sent[0]

    def test_ends_every_call_and_leaves_the_objects_usable(self):
        chain, state = long_chain()
        integrators = [sp.make_integrator('Runge-Kutta-4', chain), sp.make_integrator('Auto', chain, tolerance=1e-9)]
        calls = [lambda: integrators[0].advance(state, 1e-4, 10**9), lambda: integrators[1].advance(state, 1e5, 1),
                 lambda: sp.simulate(SCENE, frames=10**8 // 50, steps_per_frame=500, time_step=1e-4),
                 lambda: sp.simulate(SCENE, frames=2, method='Auto', frame_interval=1e6, damping=0)]
        for call in calls:
            seconds = self.interrupted(call)
            print('ends after %.3f s' % seconds)  # measured: at most 0.023
        for integrator in integrators:
            self.assertTrue(np.isfinite(state.positions).all())
            integrator.restart()
            before = integrator.force_evaluations
            integrator.advance(state, 1e-3, 1)
            self.assertGreater(integrator.force_evaluations, before)
        self.assertEqual(sp.simulate(SCENE).verdict.kind, 'ok')
