"""What several tests use."""
import os
import pathlib
import subprocess

EXERCISE3 = os.environ['EXERCISE3']
DATA = pathlib.Path(os.environ['DATA'])
SCENE = DATA / 'particle.txt'


def exercise3(*arguments, **options):
    """The result of a run of Exercise3; a divergence is no failure."""
    command = [EXERCISE3, *map(str, arguments)]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
    if result.returncode not in (0, 2, 3):
        raise AssertionError('%s ended with status %d: %s' % (' '.join(command), result.returncode, result.stderr))
    return result
