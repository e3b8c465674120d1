#!/usr/bin/python3
"""record_bag with failing system calls, and with other runs that use its files."""
import os
import signal
import subprocess
import unittest

import rosbag
import rostest

from fault_injection import CLEANS_UP, NO_MASTER, disturbed_runs, files_in, fill
from pendulum_process import Folder, program, wait_until


def record(folder, *arguments, env=None, bag='run.bag'):
    return subprocess.run(
        [program('record_bag'), 'Runge-Kutta-4', '--particles', 'particle.txt', '--bag', bag,
         '--frames', '2', '--display-rate', '0', *arguments], cwd=folder, capture_output=True,
        text=True, env=dict(os.environ, **NO_MASTER, **(env or {})))


class RecordBag(unittest.TestCase):

    def check(self, kind, arguments=(), bag=b'earlier bag'):
        def run(folder, environment=None):
            return record(folder, *arguments, env=environment)
        with Folder() as folder:
            fill(folder, run_bag=bag)
            self.assertEqual(run(folder).returncode, 0)
            finished = files_in(folder)
        self.assertEqual(sorted(finished), ['particle.txt', 'run.bag'])
        for name, result, folder in disturbed_runs(self, kind, run, {'run_bag': bag}):
            files = files_in(folder)
            self.assertIn(files['run.bag'], (bag, finished['run.bag']))
            self.assertEqual(files['particle.txt'], finished['particle.txt'])
            if kind == 'kill':
                self.assertEqual(result.returncode, -signal.SIGKILL)
                again = run(folder)
                if not arguments:  # what was appended before the kill is appended again
                    self.assertEqual(files_in(folder), finished, again.stderr)
                self.assertEqual(again.returncode, 0, again.stderr)
            elif result.returncode == 0:
                self.assertEqual(result.stderr, '')
                self.assertEqual(files['run.bag'], finished['run.bag'])
            else:
                self.assertEqual(result.returncode, 1)
                self.assertRegex(result.stderr, r'\A/.*: .*\n\Z')
                if kind == 'fail' and name not in CLEANS_UP:
                    self.assertEqual(len(files), 2, files.keys())

    def test_every_call_fails(self):
        self.check('fail')

    def test_the_disk_breaks_at_every_call(self):
        self.check('broken')

    def test_killed_at_every_call(self):
        self.check('kill')

    def test_appending_fails_at_every_call(self):
        with Folder() as folder:
            fill(folder)
            self.assertEqual(record(folder, '--namespace', 'a').returncode, 0)
            bag = files_in(folder)['run.bag']
        for kind in ('fail', 'kill'):
            self.check(kind, ('--append', '--namespace', 'b'), bag)

    def test_a_second_run_into_the_same_bag_is_refused(self):
        with Folder() as folder:
            fill(folder)
            first = subprocess.Popen(
                [program('record_bag'), 'Runge-Kutta-4', '--bag', 'run.bag', '--frames', '1000000'],
                cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            try:
                wait_until(lambda: os.path.exists(folder + '/.run.bag.tmp'), 'a bag')
                for arguments in ((), ('--append',)):
                    second = record(folder, *arguments)
                    self.assertEqual(second.returncode, 1)
                    self.assertEqual(second.stderr, folder + '/run.bag: another run is writing here; '
                                     'use a different path for each run\n')
                first.send_signal(signal.SIGINT)
                output, errors = first.communicate()
                self.assertEqual(first.returncode, 128 + signal.SIGINT, errors)
                self.assertEqual(errors, '')
            finally:
                first.kill()
                first.wait()
            with rosbag.Bag(folder + '/run.bag') as bag:
                self.assertGreater(bag.get_message_count(), 2)

    def test_check_and_inputs_write_nothing(self):
        with Folder() as folder:
            fill(folder, run_bag=b'earlier bag')
            before = files_in(folder)
            checked = record(folder, '--check')
            self.assertEqual((checked.returncode, checked.stderr), (0, ''))
            self.assertIn('Runge-Kutta-4', checked.stdout)
            refused = record(folder, bag='particle.txt')
            self.assertEqual(refused.returncode, 2)
            self.assertIn('particle.txt: is an input of this run', refused.stderr)
            self.assertEqual(files_in(folder), before)


if __name__ == '__main__':
    rostest.rosrun('spring_pendulum', 'bag_faults', RecordBag)
