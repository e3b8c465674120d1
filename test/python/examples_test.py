"""The scripts of examples/python/ make their pictures, the notebook runs, and docs/python.md is true."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import DATA, SCENE

import spring_pendulum as sp

PROJECT = DATA.parent
EXAMPLES = PROJECT / 'examples' / 'python'


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_in_folder(self, *command):
        result = subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(result.returncode, 0, result.stdout)
        return result.stdout

    def test_scripts_make_their_pictures(self):
        scripts = sorted(EXAMPLES.glob('*.py'))
        self.assertEqual(len(scripts), 3)
        for script in scripts:
            self.run_in_folder(sys.executable, str(script))
            picture = self.folder / (script.stem + '.png')
            self.assertGreater(picture.stat().st_size, 20000, picture)

    def test_the_notebook_runs(self):
        for path in (SCENE, EXAMPLES / 'chain.ipynb'):
            shutil.copy(path, self.folder)
        text = self.run_in_folder('jupyter', 'nbconvert', '--to', 'markdown', '--execute', '--stdout',
                                  '--ExecutePreprocessor.kernel_name=python3', 'chain.ipynb')
        for expected in ('Euler: order 1.0', 'Runge-Kutta-4: order 4.0', 'verdict: ok'):
            self.assertTrue(expected in text, expected)

    def test_the_document_is_true(self):
        blocks = re.findall(r'```python\n(.*?)```', (PROJECT / 'docs' / 'python.md').read_text(), re.DOTALL)
        self.assertGreaterEqual(len(blocks), 3)
        shutil.copy(SCENE, self.folder)
        (self.folder / 'document.py').write_text('\n'.join(blocks))
        self.run_in_folder(sys.executable, 'document.py')


class Pictures(unittest.TestCase):
    def test_show_what_the_run_did(self):
        run = sp.simulate(DATA / 'horizontal_11.txt', frames=9)
        chain, energy = run.plot().axes
        self.assertEqual((chain.get_xlabel(), energy.get_ylabel()), ('x in m', 'energy in J'))
        self.assertEqual([line.get_label() for line in energy.lines],
                         ['total', 'kinetic', 'gravity', 'spring', 'dissipated'])
        self.assertEqual(energy.lines[0].get_ydata().tolist(), run.energy.total.tolist())
        self.assertEqual(len(chain.lines), 7)  # chains, anchor, path of the last particle

    def test_need_matplotlib_only_when_drawn(self):
        code = f"""import sys, spring_pendulum as sp; print("matplotlib" in sys.modules or "scipy" in sys.modules)
sys.modules["matplotlib"] = None; sp.simulate({str(SCENE)!r}, frames=3).plot()"""
        done = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.stdout, 'False\n')
        self.assertIn('install python3-matplotlib', done.stderr)
