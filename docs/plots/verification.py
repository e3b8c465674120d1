#!/usr/bin/python3
"""Draws docs/verification.png: position error against step size, from the closed form of a hanging chain.

Ten masses of 1 kg are let go below a fixed end with unstretched springs; docs/verification.md has the formula.
"""
import pathlib
import sys

import matplotlib
import numpy as np

import spring_pendulum as sp

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from method_styles import METHODS  # noqa: E402

MASSES, STIFFNESS, DAMPING, GRAVITY, DURATION = 10, 1000.0, 1.0, 9.81, 20.0


def exact_heights():
    """Heights at the end, m."""
    number = np.arange(1, MASSES + 1)
    angle = (2 * number - 1) * np.pi / (2 * MASSES + 1)
    shapes = np.sin(np.outer(number, angle))
    eigenvalue = 4 * np.sin(angle / 2) ** 2
    rate = eigenvalue * DAMPING / 2
    omega = np.sqrt(eigenvalue * STIFFNESS - rate**2)
    stretch = np.cumsum(MASSES + 1 - number) * GRAVITY / STIFFNESS
    amplitude = shapes.T @ stretch * 4 / (2 * MASSES + 1)
    wave = np.exp(-rate * DURATION) * (np.cos(omega * DURATION) + rate / omega * np.sin(omega * DURATION))
    return -number - stretch + shapes @ (amplitude * wave)


def error(method, step):
    """Largest position error at the end, m."""
    particles = np.column_stack([np.zeros(MASSES + 1), -np.arange(MASSES + 1), np.ones(MASSES + 1)])
    chain = sp.Chain(particles[:, 2], stiffness=STIFFNESS, damping=DAMPING, rest_length=1, gravity=GRAVITY)
    state = sp.State(x=particles[:, 0], y=particles[:, 1])
    sp.make_integrator(method, chain).advance(state, step, round(DURATION / step))
    return np.abs(state.y[1:] - exact_heights()).max()


figure, axes = pyplot.subplots(figsize=(6.4, 4.0))
steps = DURATION / np.round(DURATION / np.geomspace(2e-5, 0.04, 18))
for method, order, marker in [("Euler", 1, "o"), ("Semi-Implicit-Euler", 1, "v"), ("Runge-Kutta-2", 2, "s"),
                              ("Velocity-Verlet", 2, "D"), ("Runge-Kutta-4", 4, "^")]:
    errors = np.array([error(method, step) for step in steps])
    stable = errors < 1
    color, style = METHODS[method]
    axes.loglog(steps[stable], errors[stable], marker + style, color=color, markersize=4,
                label=f"{method}, order {order}")
    middle = np.flatnonzero(stable & (errors > 1e-11))[1]
    axes.loglog(steps, errors[middle] * (steps / steps[middle]) ** order, ":", color=color, linewidth=0.8)
axes.set(xlabel="step size in s", ylabel="largest position error after 20 s in m", ylim=(1e-14, 1))
axes.legend(fontsize=8)
figure.tight_layout()
figure.savefig(pathlib.Path(__file__).parents[1] / "verification.png", dpi=110)
