"""record_bag with failing system calls, and with other runs that use its files."""
import os
import signal
import subprocess
import unittest

import rosbag

from fault_injection import check_faults, fill
from pendulum_process import NO_MASTER, Folder, files_in, program, running, wait_until


def record(folder, *arguments, env=None, bag='run.bag'):
    return subprocess.run(
        [program('record_bag'), 'Runge-Kutta-4', '--particles', 'particle.txt', '--bag', bag,
         '--frames', '2', '--display-rate', '0', *arguments], cwd=folder, capture_output=True,
        text=True, env=dict(os.environ, **NO_MASTER, **(env or {})))


class RecordBag(unittest.TestCase):

    def run_bag(self, *arguments):
        def run(folder, environment=None):
            done = record(folder, *arguments, env=environment)
            return done.returncode, done.stderr
        return run

    def test_every_call_fails(self):
        check_faults(self, ('fail', 'broken', 'kill'), self.run_bag(), r'\A/.*: .*\n\Z', {'run_bag': b'earlier bag'})

    def test_appending_fails_at_every_call(self):
        with Folder() as folder:
            fill(folder)
            self.assertEqual(record(folder, '--namespace', 'a').returncode, 0)
            bag = files_in(folder)['run.bag']
        # What was appended before a kill is appended again.
        check_faults(self, ('fail', 'kill'), self.run_bag('--append', '--namespace', 'b'), r'\A/.*: .*\n\Z',
                     {'run_bag': bag}, repeats=False)

    def test_a_second_run_into_the_same_bag_is_refused(self):
        with Folder() as folder:
            fill(folder)
            with running(program('record_bag'), 'Runge-Kutta-4', '--bag', 'run.bag', '--frames', '1000000',
                         cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as first:
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
