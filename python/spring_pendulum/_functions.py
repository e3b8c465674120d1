"""simulate and check. Their keywords, defaults and documentation come from the option table."""
import inspect
import json
import math
import textwrap
import warnings

from . import _core
from ._run import Report, Run, Verdict


def _with_options(function):
    """Completes signature and documentation of a function of particles and options."""
    parameters, lines = [], []
    rows = sorted(_core.options(), key=lambda row: row[0] != 'particles')  # they come first
    for key, default, is_text, unit, accepted, meaning, users in rows:
        default = default if is_text else json.loads(default)
        kind = inspect.Parameter.KEYWORD_ONLY if parameters else inspect.Parameter.POSITIONAL_OR_KEYWORD
        parameters.append(inspect.Parameter(key, kind, default=default))
        if key == 'particles':
            meaning = ('path of a particle file, or an array of shape (N, 3) with x, y in m and the mass in kg, or '
                       '(N, 5) with vx, vy in m/s as well; the first particle is fixed')
        text = '%s; %s [%r%s]' % (meaning + ('; ' + users if users else ''), accepted, default, unit and ' ' + unit)
        lines.append(textwrap.fill(key + ': ' + text, 96, initial_indent='    ', subsequent_indent='        '))
    function.__signature__ = inspect.Signature(parameters)
    function.__kwdefaults__ = None
    function.__defaults__ = (parameters[0].default,)
    function.__doc__ = function.__doc__.replace('    OPTIONS', '\n'.join(lines))
    return function


@_with_options
def simulate(particles, **options):
    """Integrates a chain of particles and springs and returns its frames.

Frames have the bits of those that Exercise3 writes. Writes files only if `output`, `energy` or
`save_state` is given. The interpreter is free for other threads meanwhile; Ctrl-C ends the call.

Args:
    OPTIONS

Returns:
    a Run

Raises:
    InputError: a wrong value, an unknown keyword or a malformed file
    FileError: a file that cannot be read or written
    MemoryError, RuntimeError: its frames, or the run itself, need more memory than there is

Warns:
    RuntimeWarning: the motion diverged, or its energy or positions are wrong
"""
    parts = _core.simulate(particles, options)
    for line in parts.pop('warnings'):
        warnings.warn(line, RuntimeWarning, stacklevel=2)
    return Run(**parts)


@_with_options
def check(particles, **options):
    """Tries a run and finds the largest step sizes, like Exercise3 --check.

Args:
    OPTIONS

Returns:
    a Report

Raises:
    InputError, FileError: as simulate
"""
    text, verdict, *limits = _core.check(particles, options)
    return Report(text, Verdict(*verdict) if verdict else None, *(None if math.isnan(x) else x for x in limits))
