"""With use_sim_time and no publisher of /clock, the node neither hangs nor sends stamps of 0. Stamps
increase even if the clock jumps back."""
import math
import time

import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped, Vector3
from rosgraph_msgs.msg import Clock
from spring_pendulum.msg import PendulumInput
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback as Feedback

from pendulum_process import NodeTest, connected, feedback, pose, transform, wait_until

rospy.set_param('/use_sim_time', True)  # before the node of this test starts


class SimTime(NodeTest):

    def test_no_clock(self):
        self.assertTrue(rosgraph.Master('/test').getParam('/use_sim_time'))
        with self.node(frames=11, real_time_factor=2.0, at_end='exit') as node:
            node.ends()
        self.state.wait_for_any(lambda m: m.frame == 10)
        self.assertGreater(len(self.state.messages), 11)
        self.assert_increasing(self.state.messages)

    def test_every_interaction_in_four_states_of_the_clock(self):
        clock = rospy.Publisher('/clock', Clock, queue_size=10, latch=True)
        inputs = self.listen('inputs', PendulumInput)
        for state in ('none', 'stopped', 'own', 'real'):
            rospy.set_param('/use_sim_time', state != 'real')
            if state == 'stopped':
                clock.publish(Clock(rospy.Time(100)))
            del inputs.messages[:]
            with self.node(publish_clock=state == 'own', held='5=nope, last') as node:
                self.interact(node, state != 'none')
                self.assert_increasing([m for _, m in sorted({m.number: m for m in inputs.wait_for(3)}.items())])  # some come late
                node.stop()
        rospy.set_param('/use_sim_time', True)

    def interact(self, node, has_clock):
        hand, robot = connected('handles/feedback', Feedback), connected('held_11/pose', PoseStamped)

        def is_warned(text, publish):
            publish()
            return any(text in line for line in node.lines('WARN'))
        wait_until(lambda: is_warned('held_5: no transform', lambda: None), 'the warning of the frame')
        if has_clock:  # at ROS time 0, the server of interactive_markers rejects all feedback
            pull = feedback(3, Feedback.POSE_UPDATE, frame='nowhere')
            wait_until(lambda: is_warned('handle particle_3: no transform', lambda: hand.publish(pull)), 'the warning')
        self.assertIn('no transform', self.call('apply_force', 3, 'nowhere', Vector3(1, 0, 0), 0.0, 1.0, success=False))
        for name, *arguments in (('pause', True), ('step',), ('set', 'damping', 0.5), ('set_method', 'Auto'), ('at_rest',),
                                 ('apply_force', 3, '', Vector3(1, 0, 0), 0.0, 1.0), ('clear_forces',),
                                 ('pause', False), ('reset',)):
            self.call(name, *arguments)

        def is_moved():
            robot.publish(pose(9.0, 0.0, rospy.Time(5)))
            time.sleep(0.02)
            return math.hypot(self.last().positions[10].x - 9.0, self.last().positions[10].z) < 1e-3
        wait_until(is_moved, 'the last particle meets its holder')

    def test_a_clock_that_jumps(self):
        clock, tf = (rospy.Publisher(*topic, queue_size=10) for topic in (('/clock', Clock), ('/tf', TFMessage)))
        with self.node(held='last=gripper') as node:
            hand = connected('handles/feedback', Feedback)
            wait_until(lambda: clock.get_num_connections() and tf.get_num_connections(), 'the subscribers')
            # The jump to 4e9 s is longer than a duration of ROS, which interactive_markers computes for a new handle.
            for second in (100, 101, 5, 1000000005, 1000, 3, 4000000000, 7):
                clock.publish(Clock(rospy.Time(second)))
                tf.publish(TFMessage([transform('gripper', stamp=rospy.Time())]))
                if second == 4000000000:
                    self.wait_state(lambda m: m.header.stamp.secs >= 4000000000, 'the clock')
                for _ in range(5):
                    self.state.wait_for(len(self.state.messages) + 1)
                    hand.publish(feedback(4 if second == 4000000000 else 6, Feedback.POSE_UPDATE, 4.0, 1.0))
            self.wait_state(lambda m: math.hypot(m.positions[5].x - 4.0, m.positions[5].z - 1.0) < 1e-3, 'the pull')
            wait_until(lambda: 'refused: Duration is out of' in node.output(), 'the refusal')
            node.stop()
        self.assert_increasing(self.state.messages)
