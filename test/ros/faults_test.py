#!/usr/bin/python3
"""The node survives a master that dies, subscribers that stop, come and go, long runs, and many
service calls."""
import os
import random
import signal
import socket
import subprocess
import time
import unittest

import rosgraph
import rospy
import rostest
from spring_pendulum.msg import PendulumState, PendulumStatus

from pendulum_process import (Folder, Listener, PendulumNode, program, project, read_frames,
                              run_exercise, service, wait_until)

SCENE = project('data/horizontal_11.txt')


class Master:
    """A ROS master of our own, on loopback: with Master(port) as master."""

    def __init__(self, port):
        self.port = port
        self.uri = 'http://127.0.0.1:%d/' % port
        self.process = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(port)], stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, env=dict(os.environ, ROS_MASTER_URI=self.uri))
        wait_until(lambda: rosgraph.is_master_online(self.uri), 'a master')

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class Faults(unittest.TestCase):

    def test_the_master_dies_and_comes_back(self):
        port = free_port()
        environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d/' % port)
        with Folder() as folder, Folder() as expected_folder:
            with Master(port):
                node = subprocess.Popen(
                    [program('pendulum_node'), '__name:=pendulum', '_particles:=' + SCENE,
                     '_output:=' + folder, '_frames:=100000', '_real_time_factor:=2'],
                    env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                wait_until(lambda: len(read_frames(folder)) > 2, 'frames')
            try:
                self.check_survival(node, port, folder)
            finally:
                node.kill()
                node.wait()
            frames = read_frames(folder)
            expected = run_exercise(expected_folder, 'Runge-Kutta-4', '--particles', SCENE,
                                    '--frames', str(len(frames)))
            self.assertEqual(frames, expected)

    def check_survival(self, node, port, folder):
        count = len(read_frames(folder))
        wait_until(lambda: len(read_frames(folder)) > count + 5, 'frames without a master')
        with Master(port):
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(60), 0)

    def test_a_subscriber_that_stops_does_not_stop_the_node_or_make_it_grow(self):
        with Folder() as folder:
            with open(folder + '/chain.txt', 'w') as file:
                file.writelines('%d 0 1\n' % i for i in range(2000))
            status = Listener('status', PendulumStatus)
            with PendulumNode(particles=folder + '/chain.txt', frames=3000, track_dissipation=False,
                              steps_per_frame=1, wait_for_subscribers=2) as node:
                listener = subprocess.Popen(['rostopic', 'echo', '/state'], stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL)
                try:
                    status.wait_for_any(lambda m: m.code == PendulumStatus.RUNNING)
                    os.kill(listener.pid, signal.SIGSTOP)
                    start = node.resident_bytes()
                    largest = start
                    while node.process.poll() is None:
                        try:
                            largest = max(largest, node.resident_bytes())
                        except (FileNotFoundError, AttributeError):
                            break
                        time.sleep(0.05)
                    # 3000 messages of 98 kB would be 290 MB; the queue holds 64 MB of them.
                    self.assertLess(largest - start, 120e6)
                    self.assertEqual(node.wait(120), 0, node.output())
                finally:
                    os.kill(listener.pid, signal.SIGCONT)
                    listener.kill()
                    listener.wait()
            status.close()

    def test_ten_minutes_at_full_speed_in_flat_memory(self):
        def memory_after(frames):
            state = Listener('state', PendulumState, keep=1)
            with PendulumNode(particles=SCENE, frames=frames, at_end='hold',
                              wait_for_subscribers=1) as node:
                wait_until(lambda: state.messages and state.messages[-1].frame == frames - 1, 'the end')
                bytes_used = node.resident_bytes()
                node.interrupt()
                self.assertEqual(node.wait(), 0, node.output())
            state.close()
            return bytes_used
        self.assertLess(memory_after(6001) - memory_after(1201), 3e6)

    def test_a_thousand_service_calls(self):
        random.seed(20)
        with Folder() as folder, Folder() as expected_folder:
            with PendulumNode(particles=SCENE, frames=40, real_time_factor=20.0, output=folder,
                              at_end='hold') as node:
                calls = {name: service(name, True) for name in ('pause', 'step', 'reset')}
                for _ in range(1000):
                    name = random.choice(list(calls))
                    arguments = [random.random() < 0.5] if name == 'pause' else []
                    self.assertTrue(calls[name](*arguments).message)
                calls['pause'](False)
                wait_until(lambda: len(read_frames(folder)) == 40, 'the end')
                node.interrupt()
                self.assertEqual(node.wait(), 0, node.output())
            self.assertEqual(read_frames(folder),
                             run_exercise(expected_folder, 'Runge-Kutta-4', '--particles', SCENE,
                                          '--frames', '40'))

    def test_subscribers_that_come_and_go(self):
        with PendulumNode(particles=SCENE, frames=100000, real_time_factor=1.0) as node:
            for _ in range(30):
                listener = Listener('state', PendulumState)
                listener.wait_for(1)
                listener.close()
            node.interrupt()
            self.assertEqual(node.wait(), 0, node.output())


if __name__ == '__main__':
    rospy.init_node('faults_test')
    rostest.rosrun('spring_pendulum', 'faults', Faults)
