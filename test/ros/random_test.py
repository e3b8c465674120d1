"""Random and absurd inputs on every topic and service of a running node.

By hand, with a roscore: rostest_runner.py random inputs:=10000 seed:=3
"""
import math
import random
import sys
import threading
import unittest

import rospy
from geometry_msgs.msg import PoseStamped, TransformStamped, Vector3, WrenchStamped
from nav_msgs.msg import Odometry
from spring_pendulum.msg import PendulumState, PendulumStatus
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import (InteractiveMarkerFeedback, InteractiveMarkerInit,
                                    InteractiveMarkerUpdate, MarkerArray)

from pendulum_process import Folder, PendulumNode, connected, methods, project, service, wait_until

ARGUMENTS = dict(word.split(':=') for word in sys.argv if ':=' in word and not word.startswith('_'))
INPUTS = int(ARGUMENTS.get('inputs', 500))
SEED = int(ARGUMENTS.get('seed', 7))
BAD = ('gained energy', 'drift', 'diverged', 'inaccurate')
WILD = (0.0, 1.0, -3.0, 1e3, -1e6, 1e-300, 1e300, -1e308, math.nan, math.inf, -math.inf)
FRAMES = ('world', 'world', 'world', 'pendulum_camera', 'turned', 'nowhere', '', '/world', 'ä b')
CONSTANTS = ('stiffness', 'damping', 'gravity', 'rest_length', 'tolerance', 'method', 'frames', '', 'stifness')
VALUES = (0, 1, 50, 0.3, -1, -9.81, 1e-3, 1e4, 1e-300, 1e300, math.nan, math.inf)
METHODS = ('Auto', 'Radau-9', 'Dormand-Prince-5', 'Runge-Kutta-4', 'x', '', '9' * 400)


def numbers_of(message):
    """All numbers of a message."""
    if isinstance(message, float):
        yield message
    elif isinstance(message, (list, tuple)):
        for part in message:
            yield from numbers_of(part)
    elif hasattr(message, '__slots__') and not hasattr(message, 'secs'):
        for name in message.__slots__:
            yield from numbers_of(getattr(message, name))


class Judge:
    """Checks everything that the node publishes."""

    def __init__(self):
        self.faults = []
        self.messages = 0
        self.state = None
        self.exact = True  # no method with fixed steps, which may become unstable, is used
        self.diverged = self.resets = 0
        self.lock = threading.Lock()
        self.subscribers = [rospy.Subscriber('state', PendulumState, self.take_state),
                            rospy.Subscriber('status', PendulumStatus, self.take_status)]
        for topic, kind in (('markers', MarkerArray), ('handles/update', InteractiveMarkerUpdate),
                            ('handles/update_full', InteractiveMarkerInit),
                            ('held_6/wrench', WrenchStamped), ('held_11/wrench', WrenchStamped)):
            self.subscribers.append(rospy.Subscriber(topic, kind, self.take, topic))

    def fault(self, text):
        if len(self.faults) < 20:
            self.faults.append(text)

    def take(self, message, topic):
        self.messages += 1
        if not all(map(math.isfinite, numbers_of(message))):
            self.fault('%s has a number that is not finite' % topic)

    def take_state(self, message):
        self.messages += 1
        if self.state is None or message.time < self.state.time:
            self.resets += 1
        self.state = message
        if message.verdict == 'diverged':
            return
        finite = all(map(math.isfinite, numbers_of([message.positions, message.velocities, message.tensions])))
        if not finite:
            self.fault('state at %g s is not finite, verdict %s' % (message.time, message.verdict))
        if message.verdict in BAD and self.exact:
            self.fault('%s at %g s: %s, energy error %g, supplied %g J, dissipated %g J' % (
                message.method, message.time, message.verdict, message.energy_error, message.supplied_energy,
                message.dissipated_energy))

    def take_status(self, message):
        if message.code == PendulumStatus.DIVERGED:
            self.diverged += 1
            if 'no longer a finite number' not in message.text and self.exact:
                self.fault(message.text)


class RandomInputs(unittest.TestCase):

    def connect(self):
        self.hand = connected('handles/feedback', InteractiveMarkerFeedback)
        self.pose = connected('held_11/pose', PoseStamped)
        self.odometry = connected('held_11/odom', Odometry)
        self.tf = connected('/tf', TFMessage)
        self.set, self.set_method, self.force, self.pause = (
            service(name, True) for name in ('set', 'set_method', 'apply_force', 'pause'))
        self.triggers = [service(name, True) for name in ('clear_forces', 'at_rest', 'step', 'reset')]
        self.reset = self.triggers[-1]

    def number(self):
        return self.dice.choice(WILD) if self.dice.random() < 0.2 else self.dice.uniform(-5.0, 12.0)

    def stamped(self, kind):
        message = kind()
        message.header.frame_id = self.dice.choice(FRAMES)
        message.header.stamp = rospy.Time(self.dice.randint(0, 1000))
        return message

    def place(self, pose):
        p, q = pose.position, pose.orientation
        p.x, p.z = self.number(), self.number()
        q.w = 1.0
        if self.dice.random() < 0.2:
            p.y = self.number()
        if self.dice.random() < 0.2:
            q.x, q.y, q.z, q.w = (self.number() for _ in range(4))

    def send_hand(self):
        message = self.stamped(InteractiveMarkerFeedback)
        message.client_id = self.dice.choice(('a', 'a', 'b', ''))
        message.marker_name = 'particle_%d' % self.dice.randint(0, 13)
        message.event_type = self.dice.choice((0, 1, 1, 1, 2, 3, 4, 5, 99))
        self.place(message.pose)
        self.hand.publish(message)

    def send_pose(self):
        message = self.stamped(PoseStamped)
        self.place(message.pose)
        self.pose.publish(message)

    def send_odometry(self):
        message = self.stamped(Odometry)
        self.place(message.pose.pose)
        self.odometry.publish(message)

    def send_transforms(self):
        transforms = []
        for child in ('gripper', 'turned'):
            message = self.stamped(TransformStamped)
            message.header.frame_id, message.child_frame_id = 'world', child
            message.header.stamp = rospy.Time.now()
            message.transform.translation.x = self.number()
            message.transform.translation.z = self.number()
            message.transform.rotation.w = self.dice.choice((1.0, 1.0, 1.0, 0.0, math.nan))
            transforms.append(message)
        self.tf.publish(TFMessage(transforms))

    def call_set(self):
        if self.dice.random() < 0.2:
            method = self.dice.choice(METHODS)
            self.set_method('Auto' if method in self.unstable else method)
        else:
            self.set(self.dice.choice(CONSTANTS), self.dice.choice(VALUES))

    def call_force(self):
        self.force(self.dice.randint(-1, 13), self.dice.choice(FRAMES),
                   Vector3(self.number(), self.number(), self.number()), self.number(), self.number())

    def call_pause(self):
        self.pause(self.dice.random() < 0.3)

    def call_trigger(self):
        self.dice.choice(self.triggers)()

    def test_inputs(self):
        self.dice = random.Random(SEED)
        judge = Judge()
        kinds = ((self.send_hand, 45), (self.send_pose, 8), (self.send_odometry, 8), (self.send_transforms, 8),
                 (self.call_set, 8), (self.call_force, 9), (self.call_pause, 4), (self.call_trigger, 4))
        self.unstable = {name for name, error_controlled in methods() if not error_controlled}
        with Folder() as folder, PendulumNode(
                cwd=folder, particles=project('data/horizontal_11.txt'), frames=1000000, method='Auto',
                real_time_factor=1.0, at_end='hold', held='6=gripper, last') as node:
            self.connect()
            wait_until(lambda: judge.state is not None, 'a state')
            for k in range(INPUTS):
                if k == INPUTS // 2:
                    judge.exact = False
                    self.unstable = ()
                self.dice.choices([kind for kind, _ in kinds], [weight for _, weight in kinds])[0]()
                if k % 10 == 0:
                    rospy.sleep(self.dice.choice((0.0, 0.02, 0.1)))
                if k % 100 == 99:
                    self.pause(False)
                    self.set_method(self.dice.choice(('Auto', 'Taylor-12', 'Radau-9')))
                    if judge.state.verdict in BAD or self.dice.random() < 0.2:
                        self.reset()
                if judge.faults or node.process.poll() is not None:
                    break
            self.assertEqual(judge.faults, [], 'input %d, seed %d\n%s' % (k, SEED, node.output()[-3000:]))
            self.assertIsNone(node.process.poll(), node.output())
            self.pause(False)
            wait_until(lambda: judge.state.time > 0, 'a state after the start')
            time, resets = judge.state.time, judge.resets
            self.reset()
            wait_until(lambda: judge.resets > resets, 'the reset')
            print('%d inputs, %d messages, %d divergences, %g s' % (INPUTS, judge.messages, judge.diverged, time))
            node.interrupt()
            self.assertIn(node.wait(), (0, 3), node.output())
