#!/usr/bin/python3
"""With use_sim_time and no publisher of /clock, the node neither hangs nor sends stamps of 0. Stamps
increase even if the clock jumps back."""
import time
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Vector3
from rosgraph_msgs.msg import Clock
from spring_pendulum.msg import PendulumInput, PendulumState
from spring_pendulum.srv import ApplyForce, Set
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import InteractiveMarkerFeedback

from pendulum_process import Listener, PendulumNode, wait_until


class SimTime(unittest.TestCase):

    def test_no_clock(self):
        self.assertTrue(rosgraph.Master('/test').getParam('/use_sim_time'))
        listener = Listener('state', PendulumState)
        with PendulumNode(frames=11, real_time_factor=2.0, wait_for_subscribers=1) as node:
            self.assertEqual(node.wait(), 0, node.output())
        listener.wait_for_any(lambda m: m.frame == 10)
        listener.close()
        self.assertGreater(len(listener.messages), 11)
        self.assert_increasing(listener)

    def test_every_interaction_in_four_states_of_the_clock(self):
        clock = rospy.Publisher('/clock', Clock, queue_size=10, latch=True)
        inputs = Listener('inputs', PendulumInput)
        for state in ('none', 'stopped', 'own', 'real'):
            rospy.set_param('/use_sim_time', state != 'real')
            if state == 'stopped':
                clock.publish(Clock(rospy.Time(100)))
            del inputs.messages[:]
            with PendulumNode(frames=100000, real_time_factor=1.0, at_end='hold',
                              publish_clock=state == 'own') as node:
                self.interact(node, state != 'none')
                self.assertGreater(min(m.header.stamp.to_nsec() for m in inputs.wait_for(3)), 0)
                node.interrupt()
                self.assertEqual(node.wait(), 0, node.output())
        rospy.set_param('/use_sim_time', True)
        inputs.close()

    def interact(self, node, has_clock):
        def call(name, kind, *arguments):
            rospy.wait_for_service('/pendulum/' + name, timeout=60)
            return rospy.ServiceProxy('/pendulum/' + name, kind)(*arguments)
        hand = rospy.Publisher('handles/feedback', InteractiveMarkerFeedback, queue_size=10)
        message = InteractiveMarkerFeedback(client_id='test', marker_name='particle_3',
                                            event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        message.header.frame_id = 'nowhere'

        def is_warned():  # the connection may still be that to an earlier node
            hand.publish(message)
            return any('handle particle_3: no transform' in line for line in node.lines('WARN'))
        if has_clock:  # at ROS time 0, the server of interactive_markers rejects all feedback
            wait_until(is_warned, 'the warning')
        for frame in ('pendulum_camera', 'nowhere'):
            call('apply_force', ApplyForce, 3, frame, Vector3(1, 0, 0), 0.0, 1.0)
        for name, kind, *arguments in (('pause', SetBool, True), ('step', Trigger), ('set', Set, 'damping', '0.5'),
                                       ('at_rest', Trigger), ('clear_forces', Trigger), ('pause', SetBool, False),
                                       ('reset', Trigger)):
            answer = call(name, kind, *arguments)
            self.assertTrue(answer.success, answer.message)

    def test_without_a_clock_every_call_answers_and_a_signal_ends_the_node(self):
        with PendulumNode(frames=100000, real_time_factor=1.0, at_end='hold', held='last',
                          held_6_frame='nope') as node:
            rospy.wait_for_service('/pendulum/apply_force', timeout=60)
            force = rospy.ServiceProxy('/pendulum/apply_force', ApplyForce)
            answer = force(particle=3, frame_id='nowhere', force=Vector3(1, 0, 0), duration=1.0)
            self.assertFalse(answer.success)
            self.assertIn('no transform from frame', answer.message)
            wait_until(lambda: any('held_6_frame: no transform' in line for line in node.lines('WARN')),
                       'the warning of the frame that does not exist')
            node.interrupt()
            self.assertEqual(node.wait(), 0, node.output())

    def test_a_clock_that_jumps(self):
        listener = Listener('/b/state', PendulumState)
        clock = rospy.Publisher('/clock', Clock, queue_size=10)
        with PendulumNode('/b/pendulum', frames=1000, real_time_factor=1.0, wait_for_subscribers=1) as node:
            for second in (100, 101, 5, 1000, 3, 7):
                wait_until(lambda: clock.get_num_connections() >= 1, 'a subscriber of /clock')
                clock.publish(Clock(rospy.Time(second)))
                listener.wait_for(len(listener.messages) + 5)
            node.interrupt()
            self.assertEqual(node.wait(), 0, node.output())
        listener.close()
        self.assert_increasing(listener)

    def assert_increasing(self, listener):
        stamps = [m.header.stamp.to_nsec() for m in listener.messages]
        self.assertGreater(stamps[0], 0)
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))


if __name__ == '__main__':
    rospy.set_param('/use_sim_time', True)
    rospy.init_node('sim_time_test')
    rostest.rosrun('spring_pendulum', 'sim_time', SimTime)
