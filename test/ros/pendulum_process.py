"""Runs the programs of the package as processes, and reads their messages and files."""
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time

import rosgraph
import rospkg
import rospy
import roslib.packages

PATIENCE = 60.0  # s before a test gives up: tests share a slow computer with others


def program(name):
    return roslib.packages.find_node('spring_pendulum', name)[0]


def project(path):
    return os.path.join(rospkg.RosPack().get_path('spring_pendulum'), path)


def wait_until(condition, what, patience=PATIENCE):
    """Polls until the result is true, and returns it."""
    end = time.monotonic() + patience
    while True:
        answer = condition()
        if answer:
            return answer
        if time.monotonic() > end:
            raise AssertionError('never happened: ' + what)
        time.sleep(0.02)


def computing_time(pid):
    """The computing time of a process so far, s."""
    with open('/proc/%d/stat' % pid) as status:
        fields = status.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def total_computing_time():
    """The computing time of all ended children, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Folder:
    """A temporary folder: with Folder() as path."""

    def __enter__(self):
        self.path = tempfile.mkdtemp(prefix='pendulum_')
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path)


class PendulumNode:
    """A pendulum_node: with PendulumNode('/name', frames=3) as node."""

    DEFAULTS = {'output': '', 'at_end': 'exit', 'real_time_factor': 0.0}

    def __init__(self, name='/pendulum', arguments=(), cwd='/', env=None, preexec=None, **parameters):
        self.name = name
        self.parameters = dict(self.DEFAULTS, particles=project('data/particle.txt'))
        self.parameters.update(parameters)
        self.parameters = {k: v for k, v in self.parameters.items() if v is not None}
        master = rosgraph.Master('/test')
        if master.hasParam(name):
            master.deleteParam(name)
        master.setParam(name, self.parameters)
        self.log = tempfile.TemporaryFile(mode='w+')
        namespace, _, base = name.rpartition('/')
        self.process = subprocess.Popen(
            [program('pendulum_node'), '__name:=' + base, '__ns:=' + (namespace or '/'),
             *arguments], stdout=self.log, stderr=subprocess.STDOUT, cwd=cwd,
            preexec_fn=preexec, env=dict(os.environ, ROSCONSOLE_FORMAT='[${severity}]: ${message}', **(env or {})))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            os.kill(self.process.pid, signal.SIGCONT)
            self.process.kill()
            self.process.wait()
        self.log.close()

    def interrupt(self, number=signal.SIGINT):
        self.process.send_signal(number)

    def wait(self, patience=PATIENCE):
        """The exit status."""
        return self.process.wait(patience)

    def output(self):
        self.log.seek(0)
        return re.sub(r'\x1b\[[0-9;]*m', '', self.log.read())

    def lines(self, severity):
        return [line for line in self.output().splitlines() if line.startswith('[%5s]' % severity)]

    def messages_built(self):
        """The total numbers of marker and state messages, after the end of the node."""
        return map(int, re.search(r'(\d+) marker and (\d+) state messages built', self.output()).groups())

    def resident_bytes(self):
        with open('/proc/%d/status' % self.process.pid) as status:
            return int(re.search(r'VmRSS:\s+(\d+) kB', status.read()).group(1)) * 1024


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
        def first():
            return next((m for m in list(self.messages) if condition(m)), None)
        return wait_until(first, 'the message on ' + self.subscriber.resolved_name, patience)

    def close(self):
        self.subscriber.unregister()


def standing(states):
    """The last state if it was sent twice, as a paused node does; else None."""
    last = states[-2:]
    return last[1] if len(last) == 2 and last[0].time == last[1].time else None


def run_exercise(folder, method='Runge-Kutta-4', *options, status=0):
    """The frames of Exercise3 by file name."""
    done = subprocess.run([program('Exercise3'), method, '--output', folder, *options], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    return read_frames(folder)


def read_frames(folder):
    frames = {}
    for name in sorted(os.listdir(folder)):
        if name.startswith('frame_'):
            with open(os.path.join(folder, name), 'rb') as frame:
                frames[name] = frame.read()
    return frames


def methods():
    """Names of all methods, and whether they control their error."""
    listed = subprocess.run([program('Exercise3'), '--list-methods'], capture_output=True,
                            text=True, check=True).stdout
    found, error_controlled = [], False
    for line in listed.splitlines():
        error_controlled = error_controlled or line.startswith('Error-controlled')
        if re.match(r'  \S', line):
            found.append((line.split()[0], error_controlled))
    return found
