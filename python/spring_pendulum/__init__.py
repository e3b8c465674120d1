"""Simulates chains of particles and damped springs. This module integrates nothing else.

    import spring_pendulum as sp
    run = sp.simulate("particle.txt", method="Runge-Kutta-4")
"""
from ._core import Chain, FileError, InputError, Integrator, Method, State, make_integrator, methods
from ._simulation import Run, simulate
