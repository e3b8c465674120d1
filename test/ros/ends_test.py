#!/usr/bin/python3
"""How a run ends: hold, exit, loop, a signal, a motion that diverges."""
import os
import signal
import time
import unittest

import rospy
import rostest
from spring_pendulum.msg import PendulumState, PendulumStatus
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import MarkerArray

from pendulum_process import (Folder, Listener, PendulumNode, project, read_frames, run_exercise,
                              wait_until)

HORIZONTAL = project('data/horizontal_11.txt')


def stamps(messages):
    return [m.header.stamp.to_nsec() for m in messages]


class Ends(unittest.TestCase):

    def test_hold_keeps_showing_the_last_frame(self):
        status = Listener('status', PendulumStatus)
        with PendulumNode(frames=3, at_end='hold') as node:
            status.wait_for_any(lambda m: m.code == PendulumStatus.FINISHED)
            status.close()
            listener = Listener('state', PendulumState)
            messages = listener.wait_for(2)
            listener.close()
            self.assertEqual({m.frame for m in messages}, {2})
            node.interrupt()
            self.assertEqual(node.wait(), 0, node.output())

    def test_loop_starts_again_and_time_stamps_go_on(self):
        listener = Listener('state', PendulumState)
        with Folder() as folder:
            with PendulumNode(frames=4, at_end='loop', output=folder, wait_for_subscribers=1) as node:
                wait_until(lambda: sum(m.time == 0 for m in listener.messages) >= 2, 'a second round')
                wait_until(lambda: listener.messages[-1].frame == 3, 'its end')
                node.interrupt()
                self.assertEqual(node.wait(), 0, node.output())
            self.assertEqual(len(read_frames(folder)), 4)
        listener.close()
        seconds = stamps(listener.messages)
        self.assertTrue(all(a < b for a, b in zip(seconds, seconds[1:])))

    def test_interrupted_exits_0_and_every_frame_is_whole(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number), Folder() as folder, Folder() as expected_folder:
                with PendulumNode(frames=100000, output=folder, particles=HORIZONTAL) as node:
                    wait_until(lambda: os.path.exists(folder + '/frame_0050.txt'), 'frame 50')
                    node.interrupt(number)
                    self.assertEqual(node.wait(), 0, node.output())
                    self.assertIn('verdict: ', node.output())
                frames = read_frames(folder)
                self.assertEqual(sorted(frames),
                                 sorted('frame_%04d.txt' % i for i in range(len(frames))))
                expected = run_exercise(expected_folder, 'Runge-Kutta-4', '--particles', HORIZONTAL,
                                        '--frames', str(len(frames)))
                self.assertEqual(frames, expected)

    def test_divergence_exits_3_and_leaves_a_latched_verdict(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', HORIZONTAL, status=3)
            with PendulumNode(method='Euler', particles=HORIZONTAL, output=folder,
                              at_end='hold') as node:
                wait_until(lambda: len(read_frames(folder)) == len(expected), 'the last good frame')
                time.sleep(0.5)
                late = Listener('status', PendulumStatus)
                message = late.wait_for_any(lambda m: m.code == PendulumStatus.DIVERGED)
                self.assertIn('diverged at t = ', message.text)
                late.close()
                # All of this is logged when it happens, not at the end of the node. The search for the
                # largest stable step comes between the status and the log.
                wait_until(lambda: 'until Ctrl-C' in node.output(), 'the lines about the divergence')
                for part in ('diverged at t = ', 'particle 11', 'step'):
                    self.assertIn(part, node.lines('ERROR')[0])
                self.assertIn('verdict: diverged', node.lines('INFO')[-2])
                self.assertIn('until Ctrl-C (at_end: hold)', node.lines('INFO')[-1])
                rospy.wait_for_service('/pendulum/pause', timeout=30)
                answer = rospy.ServiceProxy('/pendulum/pause', SetBool)(True)
                self.assertFalse(answer.success)
                self.assertIn('because the motion diverged', answer.message)
                node.interrupt()
                self.assertEqual(node.wait(), 3, node.output())
                self.assertEqual(len(node.lines('ERROR')), 1, node.output())
            self.assertEqual(read_frames(folder), expected)
            with PendulumNode(method='Euler', particles=HORIZONTAL) as node:
                self.assertEqual(node.wait(), 3, node.output())

    def test_a_second_divergence_is_logged_too(self):
        with PendulumNode(method='Euler', particles=HORIZONTAL, at_end='hold') as node:
            for count in (1, 2):
                wait_until(lambda: len(node.lines('ERROR')) == count, 'the divergence')
                rospy.wait_for_service('/pendulum/reset', timeout=30)
                self.assertTrue(rospy.ServiceProxy('/pendulum/reset', Trigger)().success)
            node.interrupt()
            node.wait()

    def test_divergence_changes_the_colour_and_keeps_the_last_good_chain(self):
        markers = Listener('markers', MarkerArray)
        with PendulumNode(method='Euler', particles=HORIZONTAL, wait_for_subscribers=1) as node:
            self.assertEqual(node.wait(), 3, node.output())
        last = wait_until(lambda: markers.messages and 'diverged' in markers.messages[-1].markers[4].text
                          and markers.messages[-1], 'the verdict')
        markers.close()
        springs, good = last.markers[0], markers.messages[-2].markers[0]
        self.assertEqual(springs.points, good.points)
        self.assertEqual(len({(c.r, c.g, c.b) for c in springs.colors}), 1)
        self.assertNotEqual(springs.colors, good.colors)

    def test_a_bad_verdict_is_a_warning_when_it_happens(self):
        with PendulumNode(method='Euler', particles=HORIZONTAL, frames=30) as node:
            self.assertEqual(node.wait(), 0, node.output())
            self.assertTrue(any('gained energy' in line for line in node.lines('WARN')), node.output())

    def test_a_time_step_above_the_stability_limit_is_a_warning_at_the_start(self):
        with PendulumNode(method='Euler', particles=HORIZONTAL, wait_for_subscribers=1) as node:
            warning = wait_until(lambda: node.lines('WARN'), 'the warning')[0]
            self.assertRegex(warning, r'Euler is unstable with a time step of 0\.01 s .*; largest stable '
                                      r'step for Euler: [\d.e-]+ s; or use Auto')
            node.interrupt()
            self.assertEqual(node.wait(), 0, node.output())
        with PendulumNode(method='Runge-Kutta-4', particles=HORIZONTAL, frames=30) as node:
            self.assertEqual(node.wait(), 0, node.output())
            self.assertEqual(node.lines('WARN'), [])

    def test_the_method_that_auto_chose_is_said(self):
        with PendulumNode(method='Auto', particles=HORIZONTAL, frames=30) as node:
            self.assertEqual(node.wait(), 0, node.output())
            self.assertRegex(node.output(), r'Auto chose \S+ for 0\.\d+ s')

    def test_the_closing_line_says_what_was_done(self):
        with PendulumNode(frames=11, particles=HORIZONTAL) as node:
            self.assertEqual(node.wait(), 0, node.output())
            for part in ('Runge-Kutta-4: 11 particles, 11 frames, 100 steps, 400 force evaluations',
                         's integrating, 0 marker', 'energy error ', 'verdict: ok'):
                self.assertIn(part, node.lines('INFO')[-1])


if __name__ == '__main__':
    rospy.init_node('ends_test')
    rostest.rosrun('spring_pendulum', 'ends', Ends)
