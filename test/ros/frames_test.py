#!/usr/bin/python3
"""The node's frame files are those of Exercise3, byte for byte."""
import unittest

import rospy
import rostest
from spring_pendulum.msg import PendulumState

from pendulum_process import (Folder, Listener, PendulumNode, methods, project, read_frames,
                              run_exercise)

SCENE = project('data/horizontal_11.txt')


class Frames(unittest.TestCase):

    def test_all_methods_with_and_without_states_in_between(self):
        self.assertGreaterEqual(len(methods()), 3)
        for method, error_controlled in methods():
            with self.subTest(method=method), Folder() as expected_folder:
                expected = run_exercise(expected_folder, method, '--particles', SCENE, '--frames', '21')
                self.assertEqual(len(expected), 21)
                self.check_plain(method, expected)
                self.check_displayed(method, error_controlled, expected)

    def check_plain(self, method, expected):
        with Folder() as folder:
            with PendulumNode(method=method, particles=SCENE, frames=21, output=folder) as node:
                self.assertEqual(node.wait(), 0, node.output())
            self.assertEqual(read_frames(folder), expected)

    def check_displayed(self, method, error_controlled, expected):
        state = Listener('state', PendulumState)
        with Folder() as folder:
            with PendulumNode(method=method, particles=SCENE, frames=21, output=folder,
                              real_time_factor=5.0, display_rate=350.0,
                              wait_for_subscribers=1) as node:
                self.assertEqual(node.wait(), 0, node.output())
            self.assertEqual(read_frames(folder), expected)
        state.wait_for_any(lambda m: m.frame == 20)
        state.close()
        in_between = [m for m in state.messages if not m.at_frame]
        self.assertGreater(len(in_between), 3, 'states in between were to be shown')
        part = 0.1 / 8 if error_controlled else 0.01
        for message in in_between:
            self.assertAlmostEqual(message.time / part, round(message.time / part), places=6)


if __name__ == '__main__':
    rospy.init_node('frames_test')
    rostest.rosrun('spring_pendulum', 'frames', Frames)
