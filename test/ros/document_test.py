"""docs/ros.md names what the node has, its recipe works, and nodes in two namespaces do not mix."""
import math
import os
import re
import signal
import subprocess

import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped, Vector3, WrenchStamped
from spring_pendulum.msg import PendulumState
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback

from pendulum_process import (Folder, NodeTest, connected, feedback, pose, project, running, service, transform,
                              wait_until, write)

OF_ROS = {'/rosout', '/pendulum/get_loggers', '/pendulum/set_logger_level'}


def document():
    with open(project('docs/ros.md')) as file:
        return file.read()


def names_in_table(heading):
    """The names in the first column of the first table after a line that starts with the heading."""
    rows = document().split('\n' + heading, 1)[1].split('\n|', 2)[2].split('\n\n', 1)[0].split('\n')[1:]
    names = [name for row in rows for name in re.findall('`([^`]+)`', row.split('|')[1])]
    return {name.replace('~', '/pendulum/') if name[0] in '/~' else '/' + name for name in names}


class Document(NodeTest):

    def test_it_names_every_topic_and_service(self):
        with self.node(held='1=gripper, last', publish_clock=True):
            service('load_state')  # is advertised last
            system = rosgraph.Master('/test').getSystemState()
        for entries, heading in zip(system, ('**Topics**', 'The node subscribes to', '**Services**')):
            found = {name for name, nodes in entries if '/pendulum' in nodes} - OF_ROS
            patterns = {re.sub(r'held_\d+/', 'held_<i>/', name) for name in found}
            self.assertEqual(patterns, names_in_table(heading), heading)

    def test_the_services_set_names_its_constants(self):
        with self.node():
            self.state.wait_for(1)
            answer = service('set')('nothing', 1.0)
        row = next(row for row in document().split('\n') if row.startswith('| `~set`'))
        constants = re.findall('`(\\w+)`', row.split('|')[3])
        self.assertGreater(len(constants), 5)
        for constant in constants:
            self.assertIn(constant, answer.message)

    def test_the_recipe_of_a_cable_between_two_frames(self):
        recipe = re.search('```xml\n(.*?)```', document(), re.S).group(1)
        self.assertLessEqual(recipe.count('\n'), 10)
        wrench = self.listen('held_11/wrench', WrenchStamped)
        tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        timer = rospy.Timer(rospy.Duration(0.02), lambda _: tf.publish(TFMessage([
            transform('left_gripper', 0.3 * math.sin(rospy.get_time())), transform('right_gripper', 8.0, 1.0)])))
        self.addCleanup(timer.shutdown)
        with Folder() as folder, \
                running('roslaunch', write(folder + '/cable.launch', recipe), stdout=subprocess.DEVNULL,
                        stderr=subprocess.STDOUT, env=dict(os.environ, ROS_HOME=folder), end=signal.SIGINT):
            self.state.wait_for(1)
            self.wait_state(lambda m: math.hypot(m.positions[10].x - 8.0, m.positions[10].z - 1.0) < 2e-3,
                            'the right end arrives')
            self.assertTrue(service('at_rest', node='/cable')().success)
            rospy.sleep(2.0)
            last = self.last()
            t = last.header.stamp.to_sec()
            self.assertLess(abs(last.positions[0].x - 0.3 * math.sin(t)), 0.15)
            self.assertGreater(min(last.tensions), 0.0)
            self.assertLess(abs(last.energy_error), 1e-3)
            force = wrench.wait_for(1)[-1].wrench.force
            self.assertAlmostEqual(math.hypot(force.x, force.z + 9.81), last.tensions[9], delta=5.0)
            self.assertLess(force.x, 0.0)
            self.assertFalse(any(name.startswith('frame_') for name in os.listdir(folder)))

    def test_inputs_reach_their_own_node_only(self):
        states = {name: self.listen('/%s/state' % name, PendulumState, keep=5) for name in ('left', 'right')}
        with self.node(name='/left/pendulum', start='at_rest', held='last') as left, \
                self.node(name='/right/pendulum', start='at_rest', held='last'):
            for listener in states.values():
                listener.wait_for(3)
            rest = states['right'].messages[-1].positions
            supplied = states['right'].messages[-1].supplied_energy
            hand = connected('/left/handles/feedback', InteractiveMarkerFeedback)
            robot = connected('/left/held_11/pose', PoseStamped)

            def moved():
                hand.publish(feedback(6, InteractiveMarkerFeedback.POSE_UPDATE, 3.0))
                robot.publish(pose(1.0, rest[10].z))
                rospy.sleep(0.02)
                p = states['left'].messages[-1].positions
                return abs(p[5].x - 3.0) < 1e-3 and abs(p[10].x - 1.0) < 2e-3
            wait_until(moved, 'the left chain is pulled')
            for name, *arguments in (('apply_force', 3, '', Vector3(50.0, 0.0, 0.0), 0.0, 1.0), ('set', 'gravity', -2),
                                     ('pause', True)):
                self.assertTrue(service(name, node='/left/pendulum')(*arguments).success)
            rospy.sleep(0.5)
            frame = states['right'].messages[-1].frame
            states['right'].wait_for_any(lambda m: m.frame > frame)
            for before, now in zip(rest, states['right'].messages[-1].positions):
                self.assertLess(math.hypot(before.x - now.x, before.z - now.z), 1e-6)
            self.assertAlmostEqual(states['right'].messages[-1].supplied_energy, supplied, places=6)
            self.assertIsNone(left.process.poll())
