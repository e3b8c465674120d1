"""mypy accepts the module, the stubs agree with it, and it finds wrong calls in user code."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import spring_pendulum as sp

PACKAGE = pathlib.Path(sp._run.__file__).parent
USER = '''
import spring_pendulum as sp
run = sp.simulate("particle.txt", method="Euler", time_step=0.01)
total: float = run.energy.total[0]
step = sp.check([[0, 0, 1]], reference="never").largest_stable_step
sp.simulate("particle.txt", time_stp=1)
sp.simulate("particle.txt", reference="often")
sp.State([0], [0]).z
'''


CACHE = tempfile.TemporaryDirectory()  # shared by the tests: mypy needs long for NumPy


def run(*command):
    environment = dict(os.environ, MYPYPATH=str(PACKAGE.parent), MYPY_CACHE_DIR=CACHE.name)
    return subprocess.run([sys.executable, '-m', *command], cwd=CACHE.name, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


@unittest.skipUnless(importlib.util.find_spec('numpy.typing'),
                     f'NumPy {np.__version__} has no type hints, which came with 1.20')
class Types(unittest.TestCase):
    def test_the_module_is_well_typed(self):
        result = run('mypy', '--follow-imports=silent', '-p', 'spring_pendulum')
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_stubs_agree_with_the_module(self):
        allowed = pathlib.Path(CACHE.name, 'allowed.txt')  # what pybind11 does to every class
        allowed.write_text(r'spring_pendulum\._core\.(Chain|Integrator|Method|State)(\.__init__)?')
        result = run('mypy.stubtest', 'spring_pendulum._core', 'spring_pendulum._functions', '--ignore-missing-stub',
                     '--allowlist', str(allowed), '--ignore-unused-allowlist')
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_wrong_calls_are_found(self):
        with tempfile.NamedTemporaryFile('w', suffix='.py') as file:
            file.write(USER)
            file.flush()
            lines = run('mypy', file.name).stdout.splitlines()
        errors = [line.split(':')[1] for line in lines if ' error: ' in line]
        self.assertEqual(errors, ['6', '7', '8'], lines)


if __name__ == '__main__':
    unittest.main()
