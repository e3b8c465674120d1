"""Integrates chains of particles and damped springs in a vertical plane, and nothing else.

    import spring_pendulum as sp

    run = sp.simulate("particle.txt", method="Runge-Kutta-4")
    print(run)
    run.plot()

The C++ library spring_pendulum does all computing; docs/python.md describes this module. Arrays are
NumPy arrays of double: F frames of N particles. Lengths are in m, times in s, masses in kg, energies
in J.
"""
from pkgutil import extend_path

# catkin's devel space puts the folder of the sources into sys.path, before that of _core.
__path__ = extend_path(__path__, __name__)

from ._core import (Chain, FileError, InputError, Integrator, Method, State, find_method, make_integrator,
                    methods, register_method)
from ._functions import check, simulate
from ._run import Energy, Report, Run, Verdict
from ._work_precision import Point, work_precision

__all__ = ['Chain', 'Energy', 'FileError', 'InputError', 'Integrator', 'Method', 'Point', 'Report', 'Run',
           'State', 'Verdict', 'check', 'find_method', 'make_integrator', 'methods', 'register_method',
           'simulate', 'work_precision']
