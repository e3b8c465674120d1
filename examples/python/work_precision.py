#!/usr/bin/env python3
"""Draws work_precision.png: run time against error on your own scene, beside SciPy's DOP853 with a
right-hand side in NumPy. Usage: work_precision.py [PARTICLE_FILE]"""
import pathlib
import sys
import time

import numpy as np
from matplotlib import pyplot as plt
from scipy.integrate import solve_ivp

import spring_pendulum as sp

SCENE = pathlib.Path(__file__).resolve().parents[2] / 'data/particle.txt'

particles = sys.argv[1] if len(sys.argv) > 1 else SCENE
duration = 5.0  # s
start = sp.simulate(particles, frames=1)
masses, count = start.chain.masses[:, None], len(start.chain)
spring = start.chain


def slope(_, z):
    """The equations of motion."""
    positions, velocities = z.reshape(2, count, 2)
    separation = np.diff(positions, axis=0)
    length = np.linalg.norm(separation, axis=1, keepdims=True)
    direction = separation / length
    rate = np.sum(np.diff(velocities, axis=0) * direction, axis=1, keepdims=True)
    force = (spring.stiffness * (length - spring.rest_length) + spring.damping * rate) * direction
    acceleration = (np.pad(force, ((0, 1), (0, 0))) - np.pad(force, ((1, 0), (0, 0)))) / masses
    acceleration[:, 1] -= spring.gravity
    acceleration[0] = 0
    return np.concatenate([velocities, acceleration]).ravel()


def scipy_point(tolerance, true):
    begin = time.perf_counter()
    z = np.concatenate([start.positions[0], start.velocities[0]]).ravel()
    solution = solve_ivp(slope, (0, duration), z, method='DOP853', rtol=tolerance, atol=tolerance)
    seconds = time.perf_counter() - begin
    end = solution.y[:, -1].reshape(2, count, 2)[0]
    return seconds, np.hypot(*(end - true).T).max()


figure, axes = plt.subplots(figsize=(8, 5), constrained_layout=True)
styles = {'Runge-Kutta-2': ('#b8860b', '-'), 'Runge-Kutta-4': ('#1f5fa8', '-'), 'Dormand-Prince-5': ('#1f5fa8', '--'),
          'Taylor-12': ('#0f8f8f', '--'), 'Auto': ('#111111', '-')}
table = sp.work_precision(particles, list(styles), duration=duration)
for method, (color, style) in styles.items():
    points = [(point.seconds, point.error) for point in table if point.method == method]
    axes.loglog(*np.transpose(points), 'o' + style, color=color, label=method)
true = sp.simulate(particles, method='Auto', tolerance=1e-12, frame_interval=duration, frames=2).positions[-1]
points = [scipy_point(tolerance, true) for tolerance in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)]
axes.loglog(*np.transpose(points), 's--', color='#cc79a7', label="SciPy's DOP853, NumPy")
axes.set(xlabel='run time in s', ylabel='position error in m', title='%g s of motion' % duration)
axes.grid(color='#dddddd')
axes.legend()
figure.savefig('work_precision.png', dpi=150)
