#!/usr/bin/env python3
"""Compares three methods with the same step size and draws compare_methods.png.
Usage: compare_methods.py [PARTICLE_FILE]"""
import pathlib
import sys
import warnings

from matplotlib import pyplot as plt

import spring_pendulum as sp

SCENE = pathlib.Path(__file__).resolve().parents[2] / 'data/particle.txt'

particles = sys.argv[1] if len(sys.argv) > 1 else SCENE
options = dict(damping=0, time_step=0.05, steps_per_frame=1, frames=161)
warnings.simplefilter('ignore', RuntimeWarning)  # Euler diverges; that is the point

figure, (chain, energy) = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
true = sp.simulate(particles, method='Auto', tolerance=1e-9, damping=0, frame_interval=0.05, frames=161)
chain.plot(*true.positions[:, -1].T, color='#d3d7dd', linewidth=5, label='true motion')
for method, color in {'Euler': '#c1440e', 'Runge-Kutta-2': '#b8860b', 'Runge-Kutta-4': '#1f5fa8'}.items():
    run = sp.simulate(particles, method=method, **options)
    print('%s: %s' % (method, run.verdict))
    chain.plot(*run.positions[:, -1].T, color=color, label=method)
    energy.plot(run.time, run.energy.total, color=color, label=method)
low, high = true.positions.min(axis=(0, 1)) - 1, true.positions.max(axis=(0, 1)) + 1
chain.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel='x in m', ylabel='y in m',
          title='path of the last particle', aspect='equal')
scale = true.energy.kinetic.max()
energy.set(xlabel='t in s', ylabel='total energy in J', title='energy, which a true motion keeps',
           ylim=(true.energy.total[0] - 0.2 * scale, true.energy.total[0] + scale))
for axes in (chain, energy):
    axes.grid(color='#ececec')
    axes.legend()
figure.savefig('compare_methods.png', dpi=150)
