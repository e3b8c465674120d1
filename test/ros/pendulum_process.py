"""Runs the programs of the package as processes, and reads their messages and files."""
import contextlib
import os
import re
import resource
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import rosgraph
import rospkg
import rospy
import roslib.packages
from geometry_msgs.msg import PoseStamped, TransformStamped
from spring_pendulum.msg import PendulumState
from spring_pendulum.srv import ApplyForce, Set, SetMethod, StatePath
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import InteractiveMarkerFeedback

PATIENCE = 60.0  # s before a test gives up: tests share a slow computer with others


def program(name):
    return roslib.packages.find_node('spring_pendulum', name)[0]


def project(path):
    return os.path.join(rospkg.RosPack().get_path('spring_pendulum'), path)


SCENE = project('data/particle.txt')
HORIZONTAL = project('data/horizontal_11.txt')
Folder = tempfile.TemporaryDirectory  # with Folder() as path
NO_MASTER = {'ROS_MASTER_URI': 'http://127.0.0.1:1'}


def wait_until(condition, what, patience=PATIENCE):
    """Polls until the result is true, and returns it."""
    end = time.monotonic() + patience
    while not (answer := condition()):
        if time.monotonic() > end:
            raise AssertionError('never happened: ' + what)
        time.sleep(0.02)
    return answer


def computing_time(pid):
    """The computing time of a process so far, s."""
    fields = Path('/proc/%d/stat' % pid).read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def total_computing_time():
    """The computing time of all ended children, s."""
    return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])


@contextlib.contextmanager
def case(**values):
    """A failure inside tells these values. rostest prints nothing about a failed subTest, and calls the test passed."""
    try:
        yield
    except Exception as error:
        raise AssertionError('%s: %s' % (values, error)) from error


@contextlib.contextmanager
def running(*command, end=signal.SIGKILL, **options):
    """A process that gets a signal in the end."""
    with subprocess.Popen(command, **options) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGCONT)
            process.send_signal(end)


class PendulumNode:
    """A pendulum_node: with PendulumNode('/name', frames=3) as node."""

    DEFAULTS = {'output': '', 'at_end': 'exit', 'real_time_factor': 0.0, 'particles': SCENE}

    def __init__(self, name='/pendulum', arguments=(), cwd='/', env=None, preexec=None, **parameters):
        self.name = name
        self.parameters = {k: v for k, v in {**self.DEFAULTS, **parameters}.items() if v is not None}
        rosgraph.Master('/test').setParam(name, self.parameters)  # replaces all that were there
        self.log = tempfile.TemporaryFile(mode='w+')
        namespace, _, base = name.rpartition('/')
        self.process = subprocess.Popen(
            [program('pendulum_node'), '__name:=' + base, '__ns:=' + (namespace or '/'),
             *arguments], stdout=self.log, stderr=subprocess.STDOUT, cwd=cwd,
            preexec_fn=preexec, env=dict(os.environ, ROSCONSOLE_FORMAT='[${severity}]: ${message}', **(env or {})))

    def __enter__(self):
        return self

    def __exit__(self, failure, *_):
        if failure:
            print('%s, exit status %s:\n%s' % (self.name, self.process.poll(), self.output()))
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGCONT)
            self.process.kill()
            self.process.wait()
        self.output()
        self.log.close()

    def interrupt(self, number=signal.SIGINT):
        self.process.send_signal(number)

    def wait(self, patience=PATIENCE):
        """The exit status."""
        return self.process.wait(patience)

    def ends(self, status=0):
        """Waits for the end with this exit status."""
        ended = self.wait()
        assert ended == status, 'exit status %d instead of %d:\n%s' % (ended, status, self.output())

    def stop(self, number=signal.SIGINT):
        self.interrupt(number)
        self.ends()

    def output(self):
        if not self.log.closed:
            self.log.seek(0)
            self.text = re.sub(r'\x1b\[[0-9;]*m', '', self.log.read())
        return self.text

    def lines(self, severity):
        return [line for line in self.output().splitlines() if re.match(r'\[ ?%s\]' % severity, line)]

    def messages_built(self):
        """The total numbers of marker and state messages, after the end of the node."""
        return map(int, re.search(r'(\d+) marker and (\d+) state messages built', self.output()).groups())

    def resident_bytes(self):
        status = Path('/proc/%d/status' % self.process.pid).read_text()
        return int(re.search(r'VmRSS:\s+(\d+) kB', status).group(1)) * 1024


def ended_node(status=0, **parameters):
    """A node that has ended, with this exit status."""
    with PendulumNode(**parameters) as node:
        node.ends(status)
    return node


class Listener:
    """Keeps all messages of a topic. The deletion of all markers at the end is not kept, only noted."""

    def __init__(self, topic, message_type, keep=None):
        self.messages = []
        self.deleted = False
        self.subscriber = rospy.Subscriber(topic, message_type, self._take)
        self.keep = keep

    def _take(self, message):
        if hasattr(message, 'markers') and message.markers[0].action == 3:
            self.deleted = True
            return
        self.messages.append(message)
        if self.keep and len(self.messages) > self.keep:
            del self.messages[0]

    def wait_for(self, count, patience=PATIENCE):
        wait_until(lambda: len(self.messages) >= count,
                   '%d messages on %s' % (count, self.subscriber.resolved_name), patience)
        return self.messages

    def wait_for_any(self, condition, patience=PATIENCE):
        return wait_until(lambda: next((m for m in list(self.messages) if condition(m)), None),
                          'the message on ' + self.subscriber.resolved_name, patience)

    def close(self):
        self.subscriber.unregister()


SERVICES = {'pause': SetBool, 'step': Trigger, 'reset': Trigger, 'set': Set, 'set_method': SetMethod,
            'apply_force': ApplyForce, 'clear_forces': Trigger, 'at_rest': Trigger, 'save_state': StatePath,
            'load_state': StatePath}


def service(name, persistent=False, node='/pendulum'):
    rospy.wait_for_service('%s/%s' % (node, name), timeout=PATIENCE)
    return rospy.ServiceProxy('%s/%s' % (node, name), SERVICES[name], persistent=persistent)


def connected(topic, kind):
    """A publisher to which the node listens."""
    publisher = rospy.Publisher(topic, kind, queue_size=100)
    wait_until(lambda: publisher.get_num_connections() > 0, 'a subscriber of ' + topic)
    return publisher


def feedback(particle, event, x=0.0, z=0.0, frame='world'):
    """What rviz says about the mouse."""
    message = InteractiveMarkerFeedback(client_id='test', marker_name='particle_%d' % particle, event_type=event)
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.z = x, z
    message.pose.orientation.w = 1.0
    return message


def pose(x, z, stamp=None, frame='world', y=0.0):
    """Where a holder is."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp or rospy.Time.now()
    message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
    message.pose.orientation.w = 1.0
    return message


def transform(child, x=0.0, z=0.0, stamp=None, parent='world'):
    """Where a tf frame is in its parent."""
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = parent, rospy.Time.now() if stamp is None else stamp
    message.transform.translation.x, message.transform.translation.z = x, z
    message.transform.rotation.w = 1.0
    return message


class NodeTest(unittest.TestCase):
    """Tests of a node at /pendulum, which plays for hours unless told otherwise."""
    PARAMETERS = dict(particles=HORIZONTAL, frames=100000, real_time_factor=1.0, at_end='hold', wait_for_subscribers=1)

    def setUp(self):
        self.listeners = []
        self.state = self.listen('state', PendulumState, keep=500)

    def tearDown(self):
        for listener in self.listeners:
            listener.close()

    def listen(self, topic, kind, keep=None):
        self.listeners.append(Listener(topic, kind, keep))
        return self.listeners[-1]

    def node(self, **parameters):
        return PendulumNode(**dict(self.PARAMETERS, **parameters))

    def call(self, name, *arguments, success=True):
        """Calls a service, which answers with a sentence."""
        answer = service(name)(*arguments)
        self.assertRegex(answer.message, r'\w+ .*\w')
        self.assertNotIn('\n', answer.message)
        self.assertEqual(answer.success, success, (name, arguments, answer.message))
        return answer.message

    def last(self):
        return self.state.wait_for(1)[-1]

    def wait_state(self, condition, what):
        return wait_until(lambda: condition(self.last()) and self.last(), what)

    def assert_increasing(self, messages):
        stamps = [m.header.stamp.to_nsec() for m in messages]
        self.assertGreater(stamps[0], 0)
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])), stamps)


def standing(states):
    """The last state if it was sent twice, as a paused node does; else None."""
    last = states[-2:]
    return last[1] if len(last) == 2 and last[0].time == last[1].time else None


def run_program(name, *arguments, status=0, **options):
    """Runs a program, which ends with this exit status, and returns what it printed."""
    command = [program(name), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, **options)
    assert done.returncode == status, (command, done.returncode, done.stderr)
    return done


def run_exercise(folder, method='Runge-Kutta-4', *options, status=0):
    """The frames of Exercise3 by file name."""
    run_program('Exercise3', method, '--output', folder, *options, status=status, cwd=folder)
    return read_frames(folder)


def write(path, text):
    Path(path).write_text(text)
    return path


def files_in(folder, start=''):
    """The contents of all files below a folder whose names have this start, by path."""
    paths = sorted(path for path in Path(folder).rglob(start + '*') if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def read_frames(folder):
    return files_in(folder, 'frame_')


def methods():
    """Names of all methods, and whether they control their error."""
    found, error_controlled = [], False
    for line in run_program('Exercise3', '--list-methods').stdout.splitlines():
        error_controlled = error_controlled or line.startswith('Error-controlled')
        if re.match(r'  \S', line):
            found.append((line.split()[0], error_controlled))
    return found
