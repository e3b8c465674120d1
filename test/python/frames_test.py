"""The frames of simulate have the bits of those that Exercise3 writes."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import spring_pendulum as sp

EXERCISE3 = os.environ['EXERCISE3']
SCENES = sorted(pathlib.Path(os.environ['DATA']).glob('*.txt'))


def frames_of_exercise3(method, scene, *options):
    with tempfile.TemporaryDirectory() as folder:
        command = [EXERCISE3, method, str(scene), '--output', folder, *options]
        status = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        if status not in (0, 3):
            raise AssertionError('%s ended with status %d' % (' '.join(command), status))
        paths = sorted(pathlib.Path(folder).glob('frame_*.txt'))
        return np.array([[[float(number) for number in line.split()] for line in path.read_text().splitlines()]
                         for path in paths])


class Frames(unittest.TestCase):
    def test_have_the_bits_of_exercise3(self):
        self.assertGreaterEqual(len(SCENES), 7)
        for method in sp.methods():
            for scene in SCENES:
                with self.subTest(method=method.name, scene=scene.name):
                    expected = frames_of_exercise3(method.name, scene, '--frames', '30')
                    run = sp.simulate(scene, method=method.name, frames=30)
                    self.assertEqual(run.positions.tobytes(), expected.tobytes())


if __name__ == '__main__':
    unittest.main()
