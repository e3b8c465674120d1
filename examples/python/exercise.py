#!/usr/bin/env python3
"""Simulates the exercise and draws exercise.png. Usage: exercise.py [PARTICLE_FILE [METHOD]]"""
import pathlib
import sys

import spring_pendulum as sp

SCENE = pathlib.Path(__file__).resolve().parents[2] / 'data/particle.txt'

particles = sys.argv[1] if len(sys.argv) > 1 else SCENE
method = sys.argv[2] if len(sys.argv) > 2 else 'Runge-Kutta-4'

run = sp.simulate(particles, method=method)
print(run)
print('end of the chain at t = %.1f s: x = %.6f m, y = %.6f m' % (run.time[-1], *run.positions[-1, -1]))
print('energy lost to the dampers: %.3f J' % run.energy.dissipated[-1])
run.plot().savefig('exercise.png', dpi=150)
