#!/usr/bin/python3
"""A signal ends the node in every phase of a run, also if SIGINT was ignored when the node started, as
in a job that a script starts with `&`."""
import os
import signal
import subprocess
import unittest

import rospy
import rostest
from std_srvs.srv import SetBool

from fault_injection import NO_MASTER
from pendulum_process import (Folder, PendulumNode, computing_time, program, project,
                              total_computing_time, wait_until)

SCENE = project('data/horizontal_11.txt')


class Signals(unittest.TestCase):
    """Without the signal, each of these nodes would run for hours or for ever."""

    def end(self, phase, **parameters):
        """Starts a node, interrupts it when phase(node) is true, and returns its output."""
        ended = {}
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number), Folder() as folder, \
                    PendulumNode(preexec=ignore_interrupts,
                                 **dict(dict(particles=SCENE, output=folder), **parameters)) as node:
                wait_until(lambda: phase(node, folder), 'the phase')
                before = computing_time(node.process.pid)
                ended_before = total_computing_time()
                node.interrupt(number)
                self.assertIn(node.wait(), (0, 3), node.output())
                # Computing time, as other programs share the computer. Measured: at most 0.1 s.
                self.assertLess(total_computing_time() - ended_before - before, 1.0, node.output())
                ended[number] = node.output()
        return ended[signal.SIGINT]

    def first_frame(self, node, folder):
        return os.path.exists(folder + '/frame_0000.txt')

    def test_record_bag(self):
        for options in (('--steps-per-frame', '2000000000', '--time-step', '1e-4'),
                        ('--time-step', '1e6', '--steps-per-frame', '1', '--reference', 'always')):
            with self.subTest(options=options), Folder() as folder:
                process = subprocess.Popen(
                    [program('record_bag'), 'Runge-Kutta-4', SCENE, '--bag', folder + '/run.bag', *options],
                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                try:
                    wait_until(lambda: os.path.exists(folder + '/.run.bag.tmp'), 'a bag')
                    before = computing_time(process.pid)
                    ended_before = total_computing_time()
                    process.send_signal(signal.SIGINT)
                    errors = process.communicate(timeout=60)[1]
                    self.assertIn(process.returncode, (3, 128 + signal.SIGINT), errors)
                    self.assertLess(total_computing_time() - ended_before - before, 1.0)
                finally:
                    process.kill()
                    process.wait()

    def test_without_a_master(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            node = subprocess.Popen([program('pendulum_node'), '_particles:=' + SCENE], text=True,
                                    env=dict(os.environ, **NO_MASTER), stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, preexec_fn=ignore_interrupts)
            try:
                wait_until(lambda: 'master' in node.stdout.readline(), 'a try to find a master')
                node.send_signal(number)
                self.assertIn(node.wait(60), (0, -number))  # before ROS has started, killed
            finally:
                node.kill()
                node.communicate()

    def test_waiting_for_subscribers(self):
        output = self.end(lambda node, _: 'waiting for 9 subscribers' in node.output(),
                          wait_for_subscribers=9, wait_timeout=0)
        self.assertIn('verdict: ', output)

    def test_running(self):
        self.end(lambda _, folder: os.path.exists(folder + '/frame_0003.txt'), frames=1000000,
                 real_time_factor=1.0)

    def test_inside_a_long_frame(self):
        self.end(self.first_frame, steps_per_frame=2000000000)
        self.end(self.first_frame, method='Taylor-8', frame_interval=1e6)

    def test_in_the_reference_run(self):
        # One step takes no time, but the reference run has 1e7 s of motion to compute.
        self.end(self.first_frame, time_step=1e7, steps_per_frame=1, reference='always')

    def test_after_a_divergence_with_many_frames(self):
        self.end(lambda node, _: 'diverged' in node.output(), method='Euler', damping=0, time_step=0.05,
                 frames=1000000000, at_end='hold')

    def test_paused(self):
        def pause(node, _):
            rospy.wait_for_service('/pendulum/pause', timeout=30)
            return rospy.ServiceProxy('/pendulum/pause', SetBool)(True).success
        self.end(pause, frames=1000000, real_time_factor=1.0)

    def test_at_the_end(self):
        self.end(lambda node, _: 'until Ctrl-C' in node.output(), frames=3, at_end='hold')

    def test_following_a_topic_without_messages(self):
        self.end(self.first_frame, follow='/nobody/state')


def ignore_interrupts():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


if __name__ == '__main__':
    rospy.init_node('signals_test')
    rostest.rosrun('spring_pendulum', 'signals', Signals)
