#!/usr/bin/python3
"""Hands, robots, forces and services change a run while it runs."""
import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped, Vector3, WrenchStamped
from nav_msgs.msg import Odometry
from spring_pendulum.msg import PendulumState, PendulumStatus
from spring_pendulum.srv import ApplyForce, Set
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray

from pendulum_process import Listener, PendulumNode, project, wait_until

SCENE = project('data/horizontal_11.txt')
BAD = ('gained energy', 'drift', 'diverged', 'inaccurate')


class LiveTest(unittest.TestCase):

    def setUp(self):
        self.state = Listener('state', PendulumState, keep=500)

    def tearDown(self):
        self.state.close()

    def node(self, **parameters):
        values = dict(particles=SCENE, frames=100000, real_time_factor=1.0, at_end='hold',
                      wait_for_subscribers=1)
        values.update(parameters)
        return PendulumNode(**values)

    def call(self, name, kind, *arguments):
        rospy.wait_for_service('/pendulum/' + name, timeout=60)
        return rospy.ServiceProxy('/pendulum/' + name, kind)(*arguments)

    def last(self):
        return self.state.messages[-1]

    def wait_state(self, condition, what):
        return wait_until(lambda: condition(self.last()) and self.last(), what)

    def hand(self):
        publisher = rospy.Publisher('handles/feedback', InteractiveMarkerFeedback, queue_size=100)
        wait_until(lambda: publisher.get_num_connections() > 0, 'the server of the handles')
        return publisher

    @staticmethod
    def feedback(particle, event, x=0.0, z=0.0, frame='world', menu=0):
        message = InteractiveMarkerFeedback()
        message.header.frame_id = frame
        message.client_id = 'test'
        message.marker_name = 'particle_%d' % particle
        message.event_type = event
        message.menu_entry_id = menu
        message.pose.position.x, message.pose.position.z = x, z
        message.pose.orientation.w = 1.0
        return message

    def drag(self, hand, particle, x, z, frame='world'):
        """Pulls a particle until it is there. The hand is not silent meanwhile."""
        hand.publish(self.feedback(particle, InteractiveMarkerFeedback.MOUSE_DOWN))

        def there():
            hand.publish(self.feedback(particle, InteractiveMarkerFeedback.POSE_UPDATE, x, z, frame))
            rospy.sleep(0.02)
            p = self.last().positions[particle - 1]
            return math.hypot(p.x - x, p.z - z) < 1e-3
        wait_until(there, 'the particle follows the hand')

    def check_energy(self):
        message = self.last()
        self.assertNotIn(message.verdict, BAD)
        self.assertLess(abs(message.energy_error), 1e-4)


class Hands(LiveTest):

    def test_a_hand_pulls_and_releases(self):
        with self.node(method='Auto') as node:
            hand = self.hand()
            self.state.wait_for(5)
            self.drag(hand, 11, 6.0, 1.0)
            self.drag(hand, 11, 5.0, -1.0)
            self.check_energy()
            self.assertGreater(abs(self.last().supplied_energy), 1.0)
            hand.publish(self.feedback(11, InteractiveMarkerFeedback.MOUSE_UP))
            self.wait_state(lambda m: m.positions[10].z < -2.0, 'the released tip falls')
            self.drag(hand, 1, 0.5, 0.5)
            hand.publish(self.feedback(1, InteractiveMarkerFeedback.MOUSE_UP))
            rospy.sleep(0.5)
            self.assertAlmostEqual(self.last().positions[0].x, 0.5, places=3)  # P_1 stays
            self.check_energy()
            self.assertIsNone(node.process.poll())

    def test_the_camera_stays_while_a_hand_pulls(self):
        markers, cameras = Listener('markers', MarkerArray), Listener('/tf_static', TFMessage)
        with self.node():
            hand = self.hand()
            cameras.wait_for(1)
            self.state.wait_for(5)
            self.drag(hand, 11, 5.0, 8.0)  # out of the picture
            self.assertEqual(len(cameras.messages), 1)
            hand.publish(self.feedback(11, InteractiveMarkerFeedback.MOUSE_UP))
            cameras.wait_for(2)
        markers.close()
        cameras.close()

    def test_a_silent_hand_lets_go(self):
        with self.node() as node:
            hand = self.hand()
            self.state.wait_for(5)
            self.drag(hand, 11, 5.0, 2.0)
            wait_until(lambda: any('released' in line for line in node.lines('WARN')), 'the release')
            self.wait_state(lambda m: m.positions[10].z < 0.0, 'the tip falls')

    def test_a_paused_particle_is_placed_at_rest(self):
        with self.node():
            hand = self.hand()
            self.state.wait_for(5)
            self.assertTrue(self.call('pause', SetBool, True).success)
            self.drag(hand, 6, 4.0, 1.0)
            v = self.last().velocities[5]
            self.assertEqual((v.x, v.z), (0.0, 0.0))
            hand.publish(self.feedback(6, InteractiveMarkerFeedback.MOUSE_UP))
            self.assertTrue(self.call('pause', SetBool, False).success)
            self.wait_state(lambda m: m.positions[5].z < 0.5, 'it falls')
            self.check_energy()

    def menu_entries(self):
        init = rospy.wait_for_message('handles/update_full', InteractiveMarkerInit, timeout=60)
        return {entry.title.replace('[x] ', '').replace('[ ] ', ''): entry
                for entry in init.markers[0].menu_entries}, init

    def test_the_menu_acts(self):
        with self.node(method='Auto'):
            hand = self.hand()
            self.state.wait_for(5)
            entries, init = self.menu_entries()
            self.assertEqual(len(init.markers), 11)

            def choose(title, particle=11):
                hand.publish(self.feedback(particle, InteractiveMarkerFeedback.MENU_SELECT,
                                           menu=entries[title].id))
            choose('Hold here')
            rospy.sleep(0.5)
            before = self.last().positions[10]
            rospy.sleep(0.5)
            after = self.last().positions[10]
            self.assertLess(math.hypot(before.x - after.x, before.z - after.z), 1e-6)
            choose('Release')
            self.wait_state(lambda m: m.positions[10].z < after.z - 0.1, 'the released tip falls')
            choose('Gravity')
            choose('Damping')
            for method in ('Runge-Kutta-4', 'Radau-9', 'Velocity-Verlet', 'Taylor-12'):
                choose(method)
                self.wait_state(lambda m, method=method: m.method == method, method)
                self.check_energy()
            choose('Pause or go on')
            status = Listener('status', PendulumStatus)
            status.wait_for_any(lambda m: m.code == PendulumStatus.PAUSED)
            frame = self.last().frame
            choose('Step')
            self.wait_state(lambda m: m.frame == frame + 1, 'a step')
            choose('Reset')
            self.wait_state(lambda m: m.frame == 0, 'the start')
            status.close()

    def test_constants_change_live(self):
        with self.node(method='Auto'):
            self.state.wait_for(5)
            for name, value in (('stiffness', '200'), ('damping', '0.2'), ('gravity', '-3'),
                                ('rest_length', '0.5'), ('method', 'Dormand-Prince-5'),
                                ('real_time_factor', '2')):
                answer = self.call('set', Set, name, value)
                self.assertTrue(answer.success, answer.message)
                rospy.sleep(0.2)
            self.wait_state(lambda m: m.method == 'Dormand-Prince-5', 'the method')
            self.check_energy()
            for name, value in (('stiffness', '-1'), ('stifness', '1'), ('frames', '3'),
                                ('gravity', 'nan'), ('method', 'Eular'), ('real_time_factor', 'x')):
                answer = self.call('set', Set, name, value)
                self.assertFalse(answer.success, name)
                self.assertRegex(answer.message, r'\w+ .*\w')

    def test_forces_push(self):
        with self.node(method='Auto', gravity=0.0):
            self.state.wait_for(5)
            answer = self.call('apply_force', ApplyForce, 11, '', Vector3(0.0, 7.0, 20.0), 0.0, 0.5)
            self.assertTrue(answer.success, answer.message)
            self.wait_state(lambda m: m.velocities[10].z > 1.0, 'the push')
            self.check_energy()
            self.assertTrue(self.call('apply_force', ApplyForce, 5, '', Vector3(5.0, 0.0, 0.0), 0.0,
                                      -1.0).success)
            self.assertRegex(self.call('clear_forces', Trigger).message, '^[12] forces? cleared')
            for particle, force, frame in ((1, 1.0, ''), (12, 1.0, ''), (0, 1.0, ''),
                                           (3, float('nan'), ''), (3, 1.0, 'nowhere')):
                answer = self.call('apply_force', ApplyForce, particle, frame,
                                   Vector3(force, 0.0, 0.0), 0.0, 1.0)
                self.assertFalse(answer.success)
    def test_constants_that_the_run_would_refuse_are_refused_at_once(self):
        with self.node(method='Auto') as node:
            self.state.wait_for(5)
            for name, value in (('gravity', '-1e9'), ('rest_length', '1e9')):
                answer = self.call('set', Set, name, value)
                self.assertFalse(answer.success)
                self.assertIn('tolerance: must be at least', answer.message)
            rospy.sleep(0.3)
            self.assertFalse([line for line in node.lines('ERROR') if 'refused' in line])

    def test_it_rests_with_constants_changed_just_before(self):
        with self.node():
            self.state.wait_for(5)
            self.assertTrue(self.call('set', Set, 'stiffness', '300').success)
            self.assertTrue(self.call('at_rest', Trigger).success)
            self.wait_state(lambda m: m.tip_speed < 1e-9, 'the rest')
            del self.state.messages[:]
            self.state.wait_for(20)
            self.assertLess(max(m.tip_speed for m in self.state.messages), 1e-6)

    def test_it_comes_to_rest(self):
        with self.node():
            self.state.wait_for(5)
            answer = self.call('at_rest', Trigger)
            self.assertTrue(answer.success, answer.message)
            self.wait_state(lambda m: m.tip_speed < 1e-9, 'the rest')
            rospy.sleep(0.5)
            self.assertLess(self.last().tip_speed, 1e-9)
            tensions = self.last().tensions
            self.assertEqual(len(tensions), 10)
            for i, tension in enumerate(tensions):
                self.assertAlmostEqual(tension, 9.81 * (10 - i), places=6)


class Robots(LiveTest):
    """Both ends follow robots: one by tf, one by odometry."""

    def test_a_cable_between_two_robots(self):
        tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        odometry = rospy.Publisher('held_11/odom', Odometry, queue_size=10)
        wrenches = Listener('held_11/wrench', WrenchStamped)
        particles = Listener('/tf', TFMessage)
        start = rospy.get_time()

        def publish(_=None):
            t = rospy.get_time() - start
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id, transform.child_frame_id = 'world', 'gripper'
            transform.transform.translation.x = 0.2 * math.sin(t)
            transform.transform.rotation.w = 1.0
            tf.publish(TFMessage([transform]))
            message = Odometry()
            message.header.stamp = rospy.Time.now()
            message.header.frame_id = 'world'
            message.pose.pose.position.x, message.pose.pose.position.z = 8.0, 0.3 * math.sin(2.0 * t)
            message.pose.pose.orientation.w = 1.0
            message.twist.twist.linear.z = 0.6 * math.cos(2.0 * t)
            odometry.publish(message)
        timer = rospy.Timer(rospy.Duration(0.02), publish)
        with self.node(method='Auto', held=[1, 11], held_1_frame='gripper',
                       tf_particles='6, last') as node:
            self.state.wait_for(5)
            self.wait_state(lambda m: abs(m.positions[10].x - 8.0) < 1e-3, 'the end reaches its robot')
            for _ in range(20):
                rospy.sleep(0.1)
                t = rospy.get_time() - start
                p = self.last().positions
                self.assertLess(abs(p[10].z - 0.3 * math.sin(2.0 * t)), 0.15)
                self.assertLess(abs(p[0].x - 0.2 * math.sin(t)), 0.1)
            self.check_energy()
            force = wrenches.wait_for(1)[-1].wrench.force
            self.assertLess(force.x, 0.0)  # the cable pulls its right end to the left
            names = {t.child_frame_id for m in particles.messages for t in m.transforms}
            self.assertLessEqual({'pendulum/particle_6', 'pendulum/particle_11'}, names)
            timer.shutdown()
            wait_until(lambda: any('held_11 has stopped' in line for line in node.lines('WARN')),
                       'the warning')
            rospy.sleep(1.0)
            place = self.last().positions[10]
            rospy.sleep(0.5)
            self.assertAlmostEqual(self.last().positions[10].z, place.z, places=6)
            self.check_energy()
        wrenches.close()
        particles.close()

    def test_bad_inputs_hold_the_particle(self):
        poses = rospy.Publisher('held_11/pose', PoseStamped, queue_size=100)
        with self.node(held='last') as node:
            wait_until(lambda: poses.get_num_connections() > 0, 'the subscriber of poses')
            self.state.wait_for(5)

            def send(x, z, seconds, frame='world', y=0.0):
                message = PoseStamped()
                message.header.frame_id = frame
                message.header.stamp = rospy.Time(seconds)
                message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
                message.pose.orientation.w = 1.0
                poses.publish(message)
                rospy.sleep(0.05)
            for k in range(20):
                send(9.0, 1.0, 100.0 + k)
            send(9.0, 1.0, 50.0)
            send(1e9, 1.0, 200.0)
            send(float('nan'), 1.0, 201.0)
            send(9.0, 1.0, 202.0, 'nowhere')
            send(9.0, 1.0, 203.0, 'world', 0.5)
            rospy.sleep(0.3)
            p = self.last().positions[10]
            self.assertLess(math.hypot(p.x - 9.0, p.z - 1.0), 1e-3)
            warnings = '\n'.join(node.lines('WARN'))
            for text in ('backwards in time', 'followed again', 'out of the plane'):
                self.assertIn(text, warnings)
            self.check_energy()

    def test_wrong_parameters_are_refused(self):
        for parameters, text in (({'held': '12'}, 'not a particle'), ({'held': 'x'}, 'not a particle'),
                                 ({'held_3_frame': 'a'}, 'not in held'),
                                 ({'held': '3', 'held_3_frame': '/a'}, "without a leading '/'"),
                                 ({'held_x_frame': 'a'}, 'held_1_frame'),
                                 ({'tf_particles': '1, 1'}, 'given twice')):
            with self.node(wait_for_subscribers=0, **parameters) as node:
                self.assertEqual(node.wait(), 2, node.output())
                self.assertIn(text, node.output())


if __name__ == '__main__':
    rospy.init_node('live_test')
    rostest.rosrun('spring_pendulum', 'live', '__main__')
