"""The messages of the node: topics, stamps and contents."""
import csv
import math
import os
import time
import unittest

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock
from spring_pendulum.msg import PendulumState, PendulumStatus
from visualization_msgs.msg import Marker, MarkerArray

from pendulum_process import (HORIZONTAL, Folder, Listener, NodeTest, PendulumNode, case, ended_node, methods,
                              read_frames, run_exercise, wait_until, write)


def stamps(messages):
    return [m.header.stamp.to_nsec() for m in messages]


class Topics(NodeTest):

    def setUp(self):
        self.listeners = []  # a message without listeners is not built

    def test_one_stamp_a_state_on_every_topic_and_nothing_lost(self):
        markers, state, status = (self.listen('markers', MarkerArray), self.listen('state', PendulumState),
                                  self.listen('status', PendulumStatus))
        node = ended_node(frames=20, real_time_factor=4.0, display_rate=80.0, wait_for_subscribers=3, frame_id='base')
        for listener, count in zip((markers, state), node.messages_built()):
            self.assertEqual(len(listener.wait_for(count)), count)
        status.wait_for_any(lambda m: m.code == PendulumStatus.FINISHED)
        self.assertEqual(state.messages[0].time, 0.0)
        self.assertEqual([m.frame for m in state.messages if m.at_frame and m.frame < 19], list(range(19)))
        self.assertEqual(state.messages[-1].frame, 19)
        self.assert_increasing(state.messages)
        self.assertEqual(stamps(state.messages), [m.markers[0].header.stamp.to_nsec() for m in markers.messages])
        for message in markers.messages:
            self.assertEqual(len({(m.header.stamp, m.header.frame_id) for m in message.markers}), 1)
        self.assertEqual(state.messages[0].header.frame_id, 'base')
        # Whether the node had to wait depends on who was faster.
        started = [m for m in status.messages if m.code != PendulumStatus.WAITING]
        self.assertEqual([m.code for m in started], [PendulumStatus.RUNNING, PendulumStatus.FINISHED])
        self.assertTrue({m.header.stamp.to_nsec() for m in started} <= set(stamps(state.messages)))

    def test_markers_are_what_rviz_wants(self):
        markers = self.listen('markers', MarkerArray)
        ended_node(frames=5, wait_for_subscribers=1)
        markers.wait_for(5)
        names = ['springs', 'particles', 'anchor', 'text', 'grid']
        for message in markers.messages:
            self.assertEqual([m.ns for m in message.markers], names)
            for marker in message.markers:
                self.check_marker(marker)
        text = markers.messages[-1].markers[3].text
        for part in ('finished', 'Runge-Kutta-4', '0.01 s', 't = 0.40 s', 'energy error', 'ok'):
            self.assertIn(part, text)

    def test_markers_are_deleted_when_the_node_ends(self):
        for at_end in ('exit', 'hold'):
            markers = self.listen('markers', MarkerArray)
            with PendulumNode(frames=3, wait_for_subscribers=1, at_end=at_end) as node:
                markers.wait_for_any(lambda m: 'finished' in m.markers[3].text)
                if at_end == 'hold':
                    node.interrupt()
                node.ends()
            wait_until(lambda: markers.deleted, 'the deletion')

    def check_marker(self, marker):
        self.assertEqual((marker.id, marker.lifetime.to_sec()), (0, 0.0))
        rotation = marker.pose.orientation
        self.assertEqual((rotation.x, rotation.y, rotation.z, rotation.w), (0, 0, 0, 1))
        self.assertGreater(min(marker.scale.x, marker.scale.y, marker.scale.z), 0)
        self.assertGreater(min([marker.color.a] + [c.a for c in marker.colors]), 0)
        self.assertFalse(marker.header.frame_id.startswith('/'))
        if marker.type in (Marker.LINE_LIST, Marker.SPHERE_LIST):
            if marker.ns != 'grid':
                self.assertEqual(len(marker.points), len(marker.colors))
            self.assertEqual(marker.action, Marker.ADD if len(marker.points) > 1 else Marker.DELETE)
            self.assertTrue(all(p.y == 0 or marker.ns == 'grid' for p in marker.points))

    def test_one_particle(self):
        with Folder() as folder:
            scene = write(folder + '/one.txt', '1 2 3\n')
            markers, state = self.listen('markers', MarkerArray), self.listen('state', PendulumState)
            ended_node(particles=scene, frames=3, wait_for_subscribers=2)
            for marker in markers.wait_for(3)[-1].markers:
                self.check_marker(marker)
                self.assertEqual(marker.action, Marker.ADD if marker.ns in ('anchor', 'text', 'grid')
                                 else Marker.DELETE)
            tip = state.wait_for(3)[-1].tip_position
            self.assertEqual((tip.x, tip.y, tip.z), (1, 0, 2))

    def test_state_is_the_frame_and_its_energies_add_up(self):
        # The dissipated energy must be right for a subscriber that comes when the run is over.
        with Folder() as folder:
            frames = run_exercise(folder, 'Runge-Kutta-4', '--frames', '31', '--particles', HORIZONTAL,
                                  '--energy', folder + '/energy.csv')
            with open(folder + '/energy.csv') as file:
                row = list(csv.reader(file))[-1]
        with PendulumNode(particles=HORIZONTAL, frames=31, at_end='hold') as node:
            status = self.listen('status', PendulumStatus)
            status.wait_for_any(lambda m: m.code == PendulumStatus.FINISHED)
            last = self.listen('state', PendulumState).wait_for(1)[0]
            node.stop()
        lines = frames['frame_0030.txt'].decode().splitlines()
        self.assertEqual([(p.x, p.z) for p in last.positions], [tuple(map(float, line.split())) for line in lines])
        self.assertEqual({p.y for p in last.positions}, {0.0})
        self.assertEqual((last.tip_position.x, last.tip_position.z), (last.positions[-1].x, last.positions[-1].z))
        self.assertAlmostEqual(last.tip_speed, math.hypot(last.velocities[-1].x, last.velocities[-1].z))
        _, when, kinetic, gravity, spring, _, dissipated, residual = map(float, row[:8])
        self.assertEqual((last.time, last.kinetic_energy, last.gravity_energy, last.spring_energy,
                          last.dissipated_energy), (when, kinetic, gravity, spring, dissipated))
        self.assertGreater(dissipated, 1.0)
        self.assertAlmostEqual(last.total_energy, kinetic + gravity + spring + dissipated)
        self.assertEqual(last.energy_error, float(row[8]))
        self.assertLess(abs(residual), 0.01)
        self.assertEqual(last.verdict, 'ok')

    def test_nothing_for_nobody(self):
        with Folder() as folder:
            node = ended_node(frames=50, cwd=folder)
            self.assertIn('0 marker and 0 state messages built', node.output())
            self.assertNotIn('writing', node.output())
            self.assertEqual(os.listdir(folder), [])
        state = self.listen('state', PendulumState)
        node = ended_node(frames=50, wait_for_subscribers=1)
        self.assertIn('0 marker and 50 state messages built', node.output())
        self.assertEqual(len(state.wait_for(50)), 50)

    def test_paced_by_the_wall_clock(self):
        state = self.listen('state', PendulumState)
        with PendulumNode(frames=31, real_time_factor=2.0, display_rate=40.0, wait_for_subscribers=1) as node:
            start = time.monotonic()
            node.ends()
            self.assertGreater(time.monotonic() - start, 1.45)  # 3 s of motion at double speed
        state.wait_for_any(lambda m: m.frame == 30)
        times = [m.time for m in state.messages]
        # 40 Hz at double speed: 2 states a frame of 0.1 s; a late node leaves in-between ones out.
        self.assertGreater(len(times), 31)
        self.assertLessEqual(len(set(times)), 61)
        elapsed = (state.messages[-1].header.stamp - state.messages[0].header.stamp).to_sec()
        self.assertGreater(elapsed, 1.45)

    def test_clock_on_request(self):
        clock, state = self.listen('/clock', Clock), self.listen('state', PendulumState)
        self.assertNotIn('/clock', dict(rosgraph.Master('/test').getPublishedTopics('/')))
        with PendulumNode(frames=11, publish_clock=True, display_rate=0.0, at_end='hold',
                          wait_for_subscribers=1) as node:
            clock.wait_for_any(lambda m: m.clock.to_sec() >= 2.0)
            state.wait_for_any(lambda m: m.frame == 10)
            node.stop()
        seconds = [m.clock.to_nsec() for m in clock.messages]
        self.assertTrue(all(a < b for a, b in zip(seconds, seconds[1:])))
        for message in state.messages:
            self.assertAlmostEqual(message.header.stamp.to_sec(), 1.0 + message.time, places=6)

    def test_waits_for_subscribers_but_not_for_ever(self):
        node = ended_node(frames=2, wait_for_subscribers=5, wait_timeout=0.5)
        self.assertIn('0 of 5 subscribers after 0.5 s', node.lines('WARN')[0].replace('1 of', '0 of'))

    def test_a_slow_subscriber_gets_the_last_message_of_a_node_that_ends(self):
        def take(message):
            frames.append(message.frame)
            time.sleep(0.02)
        frames, slow = [], rospy.Subscriber('state', PendulumState, take)
        with Folder() as folder:
            scene = write(folder + '/long.txt', ''.join('%d 0 1\n' % i for i in range(2000)))
            ended_node(particles=scene, frames=150, steps_per_frame=1, track_dissipation=False, wait_for_subscribers=1)
        wait_until(lambda: frames[-1] == 149, 'the last frame')  # without waiting for it: about frame 65
        slow.unregister()

    def test_a_hundred_thousand_particles(self):
        with Folder() as folder:
            write(folder + '/long.txt', ''.join('%g 0 1\n' % (0.01 * i) for i in range(100000)))
            markers, state = (self.listen('markers', MarkerArray), self.listen('state', PendulumState))
            with PendulumNode(particles=folder + '/long.txt', frames=3, rest_length=0.01,
                              time_step=0.0001, wait_for_subscribers=2, at_end='hold') as node:
                shown = markers.wait_for(2)[-1].markers
                positions = state.wait_for(2)[-1].positions
                node.stop()
        self.assertLessEqual(len(shown[1].points), 10000)
        self.assertGreater(len(shown[1].points), 5000)
        self.assertIn('of 100000 particles drawn', shown[3].text)
        self.assertEqual(len(positions), 100000)


class Frames(unittest.TestCase):
    """The node's frame files are those of Exercise3, byte for byte."""

    def test_all_methods_with_states_in_between(self):
        self.assertGreaterEqual(len(methods()), 3)
        for method, error_controlled in methods():
            with case(method=method), Folder() as expected_folder:
                expected = run_exercise(expected_folder, method, '--particles', HORIZONTAL, '--frames', '21')
                self.assertEqual(len(expected), 21)
                self.check_displayed(method, error_controlled, expected)

    def check_displayed(self, method, error_controlled, expected):
        state = Listener('state', PendulumState)
        with Folder() as folder:
            ended_node(method=method, particles=HORIZONTAL, frames=21, output=folder, real_time_factor=5.0,
                       display_rate=350.0, wait_for_subscribers=1)
            self.assertEqual(read_frames(folder), expected)
        state.wait_for_any(lambda m: m.frame == 20)
        state.close()
        in_between = [m for m in state.messages if not m.at_frame]
        self.assertGreater(len(in_between), 3, 'states in between were to be shown')
        part = 0.1 / 8 if error_controlled else 0.01
        for message in in_between:
            self.assertAlmostEqual(message.time / part, round(message.time / part), places=6)
