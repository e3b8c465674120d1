"""Run time against error, for one's own scene."""
import copy
import time
import warnings
from typing import NamedTuple

from ._core import InputError, State, find_method, make_integrator, methods as all_methods
from ._functions import simulate

TIME_STEPS = tuple(0.05 / 2**k for k in range(8))
TOLERANCES = tuple(10.0**-k for k in range(2, 11))


class Point(NamedTuple):
    """One row of the table of work_precision."""
    method: str
    control: str  # 'time_step' or 'tolerance'
    value: float  # s or m
    seconds: float  # least wall-clock time of several runs
    error: float  # m: largest distance of a particle from its true position at the end; NaN: not known
    force_evaluations: int


def _least_time(integrator, start, time_step, steps):
    least, spent, count = float('inf'), 0.0, 0
    while count < 3 or (spent < 0.02 and count < 100):
        state = copy.copy(start)
        integrator.restart()
        begin = time.perf_counter()
        integrator.advance(state, time_step, steps)
        seconds = time.perf_counter() - begin
        least, spent, count = min(least, seconds), spent + seconds, count + 1
    return least


def _measure(particles, method, value, duration, options):
    control = 'time_step' if method.fixed_step else 'tolerance'
    steps = max(1, round(duration / value)) if method.fixed_step else 1
    time_step = duration / steps
    tolerance = {} if method.fixed_step else {'tolerance': value}
    settings = ({'time_step': time_step, 'steps_per_frame': steps} if method.fixed_step else
                {'frame_interval': duration, **tolerance})
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)  # the error tells
        run = simulate(particles, method=method.name, frames=2, reference='always', **settings, **options)
    error = float(run.position_error[-1]) if len(run.time) == 2 else float('inf')
    start = State(*run.positions[0].T, *run.velocities[0].T)
    integrator = make_integrator(method.name, run.chain, threads=1, **tolerance)
    seconds = _least_time(integrator, start, time_step, steps)
    return Point(method.name, control, time_step if method.fixed_step else value, seconds, error,
                 run.force_evaluations)


def work_precision(particles, methods=None, *, duration=10.0, time_steps=TIME_STEPS, tolerances=TOLERANCES, **options):
    """Measures run time and error of methods on a scene, for a range of step sizes and tolerances.

    Args:
        particles: a path or an array, as for simulate
        methods: names; None: all methods
        duration: of the motion, s
        time_steps: for methods with fixed steps, s; rounded so that whole steps fill the duration
        tolerances: for error-controlled methods, m
        options: of the scene, as for simulate: stiffness, damping, rest_length, gravity

    Returns:
        a list of Point; an error of inf means that the motion diverged

    Raises:
        InputError, FileError: as simulate
    """
    names = [methods] if isinstance(methods, str) else methods
    chosen = all_methods() if names is None else [find_method(name) for name in names]
    time_steps, tolerances = list(time_steps), list(tolerances)
    for key, value in [('duration', duration), *(('time_steps', step) for step in time_steps)]:
        if not (0 < value < float('inf') and duration / value < float('inf')):
            raise InputError(f'{key}: must be above 0 s and finite, for a finite number of steps, got {value}')
    return [_measure(particles, method, value, duration, options) for method in chosen
            for value in (time_steps if method.fixed_step else tolerances)]
