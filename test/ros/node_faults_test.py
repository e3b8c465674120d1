"""pendulum_node with failing system calls, a clock that steps back, no master, a master that dies, a closed
terminal, subscribers that stop, come and go, and long runs."""
import contextlib
import os
import pty
import resource
import signal
import socket
import subprocess
import threading
import time
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
from geometry_msgs.msg import PoseStamped
from rosgraph.xmlrpc import ThreadingXMLRPCServer
from spring_pendulum.msg import PendulumState, PendulumStatus

from fault_injection import INJECTION, check_faults
from pendulum_process import (HORIZONTAL, SCENE, Folder, Listener, PendulumNode, case, connected, ended_node, pose,
                              program, read_frames, run_exercise, running, service, wait_until, write)


@contextlib.contextmanager
def master_between(act):
    """The address of a server that passes all calls on to the master, after act(method, *arguments)."""
    def pass_on(method, arguments):
        act(method, *arguments)
        return getattr(ServerProxy(os.environ['ROS_MASTER_URI']), method)(*arguments)
    with ThreadingXMLRPCServer(('127.0.0.1', 0), False) as server:
        server._dispatch = pass_on
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield 'http://127.0.0.1:%d' % server.server_address[1]
        finally:
            server.shutdown()


class Node(unittest.TestCase):

    def run_node(self, folder, environment=None):
        with PendulumNode(particles=folder + '/particle.txt', output=folder, frames=2,
                          energy=folder + '/e.csv', env=environment) as node:
            return node.wait(), node.output()

    def test_every_call_fails(self):
        check_faults(self, ('fail', 'kill'), self.run_node,  # it may get the port of a killed one, which the master calls
                     r'\A[^[]*(\[( ?(INFO|WARN)|ERROR\]: a header of).*\n)*\[FATAL\]: .*\n\Z', {'e_csv': b'earlier'})

    def test_the_clock_steps_back(self):
        with Folder() as folder:
            start = time.monotonic()
            ended_node(output=folder, frames=31, real_time_factor=1.0,
                       env={'LD_PRELOAD': INJECTION, 'CLOCK_BACK': '3600'})
            self.assertGreater(time.monotonic() - start, 3.0)  # it was paced all the same
            self.assertEqual(len(read_frames(folder)), 31)

    def test_refuses_an_invalid_address_of_the_master(self):
        valid = 'http://127.0.0.1:1'
        for uri in ('', '127.0.0.1:1', 'https://127.0.0.1:1', 'http://127.0.0.1', 'http://127.0.0.1:x',
                    'http://127.0.0.1:65536', 'http://:1'):
            for source, variable, arguments in (('ROS_MASTER_URI', uri, []), ('__master', valid, ['__master:=' + uri])):
                with case(variable=variable, arguments=arguments):
                    self.assertEqual(self.fail_to_start({'ROS_MASTER_URI': variable}, arguments),
                                     (2, "%s: must be http://HOST:PORT, got '%s'\n" % (source, uri)))

    def test_a_master_that_is_lost_before_the_parameters_are_read_is_an_error(self):
        for lost in ('hasParam', 'getParam'):
            def lose(*call):
                if call == (lost, '/pendulum', '/pendulum'):
                    raise OSError('lost')
            with master_between(lose) as uri:
                node = ended_node(1, frames=2, env={'ROS_MASTER_URI': uri})
                self.assertEqual(node.lines('FATAL'), ['[FATAL]: /pendulum: the ROS master at %s did not answer when '
                                                       'the parameters were read' % uri])

    def start(self, act, **parameters):
        """Runs a node until its end. Before its call k of the master, act(k, node, method, *arguments)."""
        calls, nodes = [], []

        def between(*call):
            calls.append(call)
            act(len(calls), wait_until(lambda: nodes, 'the node')[0], *call)
        with master_between(between) as uri, \
                PendulumNode(env={'ROS_MASTER_URI': uri}, held='1, last=gripper', **parameters) as node:
            nodes.append(node)
            node.ends()
        return calls

    def test_it_can_be_ended_at_every_call_of_its_start(self):
        def interrupt(node, *_):
            node.interrupt()

        def shut_down(_, method, *arguments):
            ServerProxy(arguments[-1]).shutdown('/master', 'test')
        calls = self.start(lambda *_: None, frames=2)
        last = [call[2] for call in calls].index('/pendulum/load_state')
        for k, (method, _, what, *_) in enumerate(calls[:last + 1], 1):
            if '/statistics' in what:  # many
                continue
            # roscpp itself cannot be shut down while it advertises /rosout.
            for end in (interrupt, shut_down) if method == 'registerPublisher' and what != '/rosout' else (interrupt,):
                with case(end=end, method=method, what=what):
                    self.start(lambda at, *call: end(*call) if at == k else None, frames=100000, real_time_factor=1.0)

    def test_names_a_log_folder_that_cannot_be_created(self):
        with Folder() as folder:
            open(folder + '/file', 'w').close()
            status, output = self.fail_to_start({'HOME': folder + '/file', 'ROS_HOME': None, 'ROS_LOG_DIR': None})
            self.assertEqual(status, 1)
            self.assertRegex(output, r'^%s/file/.ros/?: the log folder of ROS could not be created: '
                             r'Not a directory.*; set ROS_HOME to a writable folder\n$' % folder)

    def fail_to_start(self, changes, arguments=()):
        environment = {k: v for k, v in dict(os.environ, **changes).items() if v is not None}
        done = subprocess.run([program('pendulum_node'), *arguments], text=True, timeout=60,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
        return done.returncode, done.stdout

    def test_ended_by_ros_it_closes_its_files_and_says_so(self):
        for moved in (False, True):
            with Folder() as folder, PendulumNode(particles=SCENE, output=folder + '/out',
                                                  frames=1000000, real_time_factor=1.0) as node:
                wait_until(lambda: os.path.exists(folder + '/out/frame_0003.txt'), 'frames')
                if moved:
                    os.rename(folder + '/out', folder + '/moved')
                subprocess.run(['rosnode', 'kill', '/pendulum'], check=True, stdout=subprocess.DEVNULL)
                node.ends(1 if moved else 0)
                self.assertIn('out: was moved or removed during the run' if moved else 'verdict: ',
                              node.output().splitlines()[-1])

    def test_a_thread_that_cannot_be_started_is_an_error(self):
        # The stack of a thread has the size of the limit, and this size exceeds the address space.
        limit = 'import os, resource, sys; resource.setrlimit(resource.RLIMIT_STACK, ' \
                '(1 << 47, resource.RLIM_INFINITY)); os.execv(sys.argv[1], sys.argv[1:])'
        done = subprocess.run(['/usr/bin/python3', '-c', limit, program('pendulum_node')],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr.count('\n')), (1, 1), done.stderr)

    def test_a_vanished_terminal_does_not_end_it(self):
        ours, other_end = pty.openpty()
        with Folder() as folder, \
                running(program('pendulum_node'), '__name:=on_terminal', '_particles:=' + SCENE, '_output:=' + folder,
                        '_frames:=30', '_at_end:=exit', stdin=subprocess.DEVNULL, stdout=other_end,
                        stderr=other_end) as node:
            os.close(other_end)
            wait_until(lambda: os.path.exists(folder + '/frame_0003.txt'), 'frames')
            os.close(ours)
            self.assertEqual(node.wait(60), 0)
            self.assertEqual(len(read_frames(folder)), 30)


@contextlib.contextmanager
def master(port):
    """A ROS master of our own, on loopback."""
    uri = 'http://127.0.0.1:%d/' % port
    with running('rosmaster', '--core', '-p', str(port), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                 env=dict(os.environ, ROS_MASTER_URI=uri)):
        wait_until(lambda: rosgraph.is_master_online(uri), 'a master')
        yield


class Faults(unittest.TestCase):

    def test_the_master_dies_and_comes_back(self):
        with socket.socket() as probe:
            probe.bind(('127.0.0.1', 0))
            port = probe.getsockname()[1]
        with Folder() as folder, Folder() as expected_folder, \
                PendulumNode(env={'ROS_MASTER_URI': 'http://127.0.0.1:%d/' % port},
                             arguments=['_particles:=' + HORIZONTAL, '_output:=' + folder, '_frames:=100000',
                                        '_real_time_factor:=2']) as node:
            with master(port):
                wait_until(lambda: len(read_frames(folder)) > 2, 'frames')
            count = len(read_frames(folder))
            wait_until(lambda: len(read_frames(folder)) > count + 5, 'frames without a master')
            with master(port):
                node.stop()
            frames = read_frames(folder)
            expected = run_exercise(expected_folder, 'Runge-Kutta-4', '--particles', HORIZONTAL, '--frames', len(frames))
            self.assertEqual(frames, expected)

    def test_a_frame_that_a_service_cannot_write_ends_it(self):
        state = Listener('state', PendulumState)
        with Folder() as folder, PendulumNode(output=folder, frames=2, real_time_factor=0.02, at_end='hold') as node:
            state.wait_for_any(lambda m: m.time > 0.0)
            resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, (0, 0))
            self.assertIn('File too large', service('pause')(True).message)
            node.ends(1)
        state.close()

    def test_a_subscriber_that_stops_does_not_stop_the_node_or_make_it_grow(self):
        with Folder() as folder:
            scene = write(folder + '/chain.txt', ''.join('%d 0 1\n' % i for i in range(2000)))
            status = Listener('status', PendulumStatus)
            with running('rostopic', 'echo', '/state', stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as listener, \
                    PendulumNode(particles=scene, frames=3000, track_dissipation=False, steps_per_frame=1,
                                 wait_for_subscribers=2) as node:
                status.wait_for_any(lambda m: m.code == PendulumStatus.RUNNING)
                listener.send_signal(signal.SIGSTOP)
                largest = start = node.resident_bytes()
                while node.process.poll() is None:
                    with contextlib.suppress(FileNotFoundError, AttributeError):
                        largest = max(largest, node.resident_bytes())
                    time.sleep(0.05)
                # 3000 messages of 98 kB would be 290 MB; the queue holds 64 MB of them.
                self.assertLess(largest - start, 120e6)
                node.ends()
            status.close()

    def test_a_holder_is_met_while_nobody_looks(self):
        with PendulumNode(particles=HORIZONTAL, frames=100000, real_time_factor=1.0, held='last') as node:
            robot = connected('held_11/pose', PoseStamped)
            for k in range(180):
                robot.publish(pose(11.0 + 0.08 * k, 0.0))
                time.sleep(0.03)
            self.assertNotIn('has not been met', node.output())
