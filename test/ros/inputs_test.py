#!/usr/bin/python3
"""Saved states, jumps back, and runs that are repeated from the inputs in a bag."""
import os
import random
import signal
import subprocess
import unittest

import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, Vector3
from spring_pendulum.msg import PendulumInput, PendulumState
from spring_pendulum.srv import ApplyForce, Set, StatePath
from std_srvs.srv import SetBool, Trigger
from visualization_msgs.msg import InteractiveMarkerFeedback

from pendulum_process import (Folder, Listener, PendulumNode, program, project, read_frames, run_exercise,
                              wait_until)

SCENE = project('data/horizontal_11.txt')
CONSTANTS = (('stiffness', '80'), ('damping', '0.5'), ('gravity', '5.25'), ('air_drag', '0.3'), ('rest_length', '0.9'))


def service(name, kind):
    rospy.wait_for_service('/pendulum/' + name, timeout=60)
    return rospy.ServiceProxy('/pendulum/' + name, kind)


def frame_of(state):
    return ''.join('%r %r\n' % (p.x, p.z) for p in state.positions)


def numbers_of(text):
    return [tuple(map(float, line.split())) for line in text.splitlines()]


CONSTANTS_OF_RUN = ['method=Runge-Kutta-4', 'frames=20', 'steps_per_frame=10', 'time_step=0.01', 'tolerance=1e-6',
                    'frame_interval=0.1', 'stiffness=50', 'damping=1', 'rest_length=1', 'gravity=9.81', 'air_drag=0',
                    'threads=1', 'sleep=0', 'on_divergence=stop']


def start(**values):
    """The first input of a run of three particles."""
    return PendulumInput(**dict(dict(start=True, scenario=CONSTANTS_OF_RUN, placed=[1, 2, 3], masses=[1.0, 1.0, 1.0],
                                     states=[float(i) if c == 0 else 0.0 for i in range(3) for c in range(4)]),
                                **values))


def change(number, time, **values):
    return PendulumInput(**dict(dict(number=number, time=time, scenario=CONSTANTS_OF_RUN), **values))


def write_inputs(path, *inputs):
    with rosbag.Bag(path, 'w') as bag:
        for i, message in enumerate(inputs):
            bag.write('/inputs', message, rospy.Time(1 + i))


class States(unittest.TestCase):

    def setUp(self):
        self.state = Listener('state', PendulumState)

    def tearDown(self):
        self.state.close()

    def node(self, folder, **parameters):
        values = dict(particles=SCENE, frames=60, real_time_factor=5.0, at_end='hold', wait_for_subscribers=1,
                      display_rate=0.0, cwd=folder)
        values.update(parameters)
        return PendulumNode(**values)

    def check_frames(self, states, frames):
        """All states have the bits of the frames."""
        for state in states:
            expected = numbers_of(frames['frame_%04d.txt' % state.frame].decode())
            self.assertEqual([(p.x, p.z) for p in state.positions], expected)

    def test_saves_and_loads(self):
        with Folder() as folder, self.node(folder, method='Runge-Kutta-4'):
            frames = run_exercise(folder, 'Runge-Kutta-4', '--particles', SCENE, '--frames', '60')
            self.state.wait_for_any(lambda m: m.frame >= 20)
            answer = service('save_state', StatePath)('')
            self.assertTrue(answer.success, answer.message)
            path = os.path.join(folder, 'pendulum_state.txt')
            self.assertIn(path, answer.message)
            with open(path) as saved:
                frame = int(saved.readline().split('frame ')[1].split(',')[0])
            self.assertGreaterEqual(frame, 20)
            self.state.wait_for_any(lambda m: m.frame == 59)
            del self.state.messages[:]
            answer = service('load_state', StatePath)(path)
            self.assertTrue(answer.success, answer.message)
            self.state.wait_for_any(lambda m: m.frame == frame)
            self.state.wait_for_any(lambda m: m.frame == 59)
            at = [m.frame for m in self.state.messages].index(frame)
            self.check_frames(self.state.messages[at:], frames)
            # Exercise3 goes on from it as well.
            os.mkdir(os.path.join(folder, 'resumed'))
            resumed = run_exercise(os.path.join(folder, 'resumed'), 'Runge-Kutta-4', path, '--resume',
                                   '--frames', '60')
            self.assertEqual(sorted(resumed), sorted(frames)[frame:])
            self.assertTrue(all(frames[name] == text for name, text in resumed.items()))

    def test_loads_what_it_saved_after_a_change_of_the_method(self):
        with Folder() as folder, self.node(folder, method='Runge-Kutta-4', frames=100000, real_time_factor=10.0):
            self.state.wait_for_any(lambda m: m.frame >= 20)
            self.assertTrue(service('set', Set)('method', 'Auto').success)
            self.state.wait_for_any(lambda m: m.method == 'Auto' and m.frame >= 36)
            for _ in range(5):
                self.assertTrue(service('save_state', StatePath)('').success)
                answer = service('load_state', StatePath)('')
                self.assertTrue(answer.success, answer.message)

    def test_writes_the_frames_that_a_jump_left_out_when_it_reaches_them(self):
        with Folder() as folder:
            expected = run_exercise(folder, 'Runge-Kutta-4', '--particles', SCENE, '--frames', '60')
            state_file, written = os.path.join(folder, 'state.txt'), os.path.join(folder, 'written')
            done = subprocess.run([program('Exercise3'), 'Runge-Kutta-4', '--particles', SCENE, '--frames',
                                   '31', '--no-frames', '--save-state', state_file], capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            state = Listener('state', PendulumState)
            with PendulumNode(method='Runge-Kutta-4', particles=SCENE, frames=60, output=written,
                              at_end='hold', real_time_factor=2.0):
                state.wait_for(2)
                load = service('load_state', StatePath)(state_file)
                self.assertTrue(load.success, load.message)
                state.wait_for_any(lambda m: m.frame >= 31)
                self.assertLess(len(read_frames(written)), 30)
                self.assertTrue(service('reset', Trigger)().success)  # the end of the run ends the files
                wait_until(lambda: len(read_frames(written)) == 60, 'all frames')
                frames = read_frames(written)
            state.close()
            self.assertTrue(frames == expected)

    def test_a_run_that_has_not_started_has_no_state(self):
        with Folder() as folder:
            kept = os.path.join(folder, 'kept.txt')
            with open(kept, 'w') as file:
                file.write('kept')
            with PendulumNode(particles=SCENE, wait_for_subscribers=9, wait_timeout=100):
                for answer in (service('save_state', StatePath)(kept), service('load_state', StatePath)(kept)):
                    self.assertFalse(answer.success)
                    self.assertEqual(answer.message, 'the run has not started yet')
            with open(kept) as file:
                self.assertEqual(file.read(), 'kept')

    def test_refuses_what_is_no_state(self):
        with Folder() as folder, self.node(folder):
            self.state.wait_for(3)
            load, save = service('load_state', StatePath), service('save_state', StatePath)
            other = os.path.join(folder, 'other.txt')
            with open(other, 'w') as file:
                file.write('# state of 11 particles at frame 0, t = 0 s\n' +
                           ''.join('%d 0 2 0 0\n' % i for i in range(11)))
            for path, says in (('nothing.txt', 'nothing.txt'), (SCENE, 'must be'), (folder, folder),
                               (other, 'masses differ')):
                answer = load(path)
                self.assertFalse(answer.success, path)
                self.assertIn(says, answer.message)
                self.assertNotIn('\n', answer.message)
            for path, says in (('/proc/nowhere/state.txt', 'could not be written'), (folder, 'is a folder'),
                               (os.path.dirname(SCENE), 'is a folder with ' + SCENE), (SCENE, 'is an input')):
                answer = save(path)
                self.assertFalse(answer.success, path)
                self.assertIn('%s: ' % path, answer.message)
                self.assertIn(says, answer.message)
                self.assertNotIn('\n', answer.message)
            del self.state.messages[:]
            self.state.wait_for(3)


class Repeated(unittest.TestCase):

    def disturb(self, dice, hand, robot, state):
        """Acts on a node until its run is over."""
        force, set_constant = service('apply_force', ApplyForce), service('set', Set)
        pause, reset = service('pause', SetBool), service('reset', Trigger)
        jumps = 0
        while state.messages[-1].frame < 79:
            choice = dice.random()
            if choice < 0.5:
                message = InteractiveMarkerFeedback(marker_name='particle_6', client_id='test', event_type=1)
                message.header.frame_id = 'world'
                message.pose.position.x, message.pose.position.z = dice.uniform(3, 7), dice.uniform(-2, 2)
                message.pose.orientation.w = 1.0
                if dice.random() < 0.2:
                    message.event_type = InteractiveMarkerFeedback.MOUSE_UP
                hand.publish(message)
            elif choice < 0.75:
                pose = PoseStamped()
                pose.header.frame_id, pose.header.stamp = 'world', rospy.Time.now()
                pose.pose.position.x, pose.pose.position.z = dice.uniform(9, 10), dice.uniform(-1, 1)
                pose.pose.orientation.w = 1.0
                robot.publish(pose)
            elif choice < 0.85:
                force(particle=dice.randint(2, 10), force=Vector3(dice.uniform(-5, 5), 0, 3), frame_id='',
                      start_time=0.0, duration=0.3)
            elif choice < 0.93:
                set_constant(*dice.choice(CONSTANTS))
            elif choice < 0.96 and jumps < 3:
                jumps += 1
                reset()
            else:
                pause(True)
                rospy.sleep(0.02)
                pause(False)
            rospy.sleep(0.02)

    def repeat(self, method, seed):
        with Folder() as folder:
            bag, live, again = (os.path.join(folder, name) for name in ('inputs.bag', 'live', 'again'))
            recorder = subprocess.Popen(['rosbag', 'record', '-O', bag, '/inputs', '__name:=recorder'],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            master = rospy.get_master()
            wait_until(lambda: any(topic == '/inputs' for topic, _ in master.getSystemState()[2][1]), 'the recorder')
            hand = rospy.Publisher('handles/feedback', InteractiveMarkerFeedback, queue_size=100)
            robot = rospy.Publisher('held_11/pose', PoseStamped, queue_size=100)
            state, inputs = Listener('state', PendulumState), Listener('inputs', PendulumInput)
            with PendulumNode(method=method, particles=SCENE, frames=80, real_time_factor=1.0, output=live,
                              held='last', wait_for_subscribers=1) as node:
                state.wait_for(2)
                try:
                    self.disturb(random.Random(seed), hand, robot, state)
                except rospy.ServiceException:  # the run is over
                    pass
                self.assertEqual(node.wait(), 0)
            wait_until(lambda: os.path.exists(bag + '.active'), 'the bag')
            rospy.sleep(1.0)
            recorder.send_signal(signal.SIGINT)
            recorder.wait(60)
            wait_until(lambda: os.path.exists(bag), 'the end of the bag')
            with rosbag.Bag(bag) as recorded:
                count = recorded.get_message_count('/inputs')
            self.assertGreater(count, 30)
            with rosbag.Bag(bag) as recorded:
                last = max((message for _, message, _ in recorded.read_messages()), key=lambda m: m.number)
            self.assertTrue(last.end)
            self.assertEqual(last.number + 1, len({m.number for m in inputs.messages}))
            done = subprocess.run([program('record_bag'), '--inputs', bag, '--bag',
                                   os.path.join(folder, 'again.bag'), '--output', again],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ''))
            expected = read_frames(live)
            self.assertEqual(len(expected), 80)
            self.assertNotEqual(expected, run_exercise(folder, method, '--particles', SCENE, '--frames', '80'))
            self.assertTrue(read_frames(again) == expected)
            for listener in (state, inputs):
                listener.close()
            hand.unregister()
            robot.unregister()
            return bag

    def test_a_fixed_step_run(self):
        self.repeat('Runge-Kutta-4', 1)

    def test_an_error_controlled_run(self):
        self.repeat('Auto', 2)

    def replay(self, folder, path, *arguments):
        return subprocess.run([program('record_bag'), 'Euler', '--inputs', path, '--bag',
                               os.path.join(folder, 'out.bag'), *arguments], capture_output=True, text=True)

    def check_refused(self, folder, path, says, status):
        done = self.replay(folder, path)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertIn(says, done.stderr)
        self.assertIn(path, done.stderr)
        # A run that is refused at a later input has warned that the closing one is missing.
        self.assertEqual(len([line for line in done.stderr.splitlines() if not line.startswith('warning: ')]), 1)
        self.assertFalse(os.path.exists(os.path.join(folder, 'out.bag')))

    def test_refuses_other_bags(self):
        with Folder() as folder:
            empty, cut, text, fifo = (os.path.join(folder, name)
                                      for name in ('empty.bag', 'cut.bag', 'text.bag', 'fifo.bag'))
            with rosbag.Bag(empty, 'w') as bag:
                bag.write('/state', PendulumState(), rospy.Time(1))
            write_inputs(cut, PendulumInput(number=3))
            with open(text, 'w') as file:
                file.write('no bag')
            os.mkfifo(fifo)  # reading it would wait forever
            for path, says, status in ((empty, 'has no inputs', 2), (cut, 'input 0 is missing', 2),
                                       (text, 'cannot be read as a bag', 1), (fifo, 'it is a pipe', 1),
                                       (os.path.join(folder, 'none.bag'), 'No such file', 1), ('', '--inputs: ', 2)):
                self.check_refused(folder, path, says, status)

    def test_refuses_inputs_that_no_node_sends(self):
        wrong = [s.replace('stiffness=50', 'stiffness=-3') for s in CONSTANTS_OF_RUN]
        with Folder() as folder:
            path = os.path.join(folder, 'inputs.bag')
            for says, *inputs in (('input 0: has no method', start(scenario=[])),
                                  ('input 1: has no method', start(), change(1, 0.5, scenario=[])),
                                  ('input 0: stiffness: must be', start(scenario=wrong)),
                                  ('input 1: stiffness: must be', start(), change(1, 0.5, scenario=wrong)),
                                  ('input 0: mass of particle 2', start(masses=[1.0, -1.0, 1.0])),
                                  ('input 0: frames: must be', start(frame=-1)),
                                  ('input 0: is not complete', start(placed=[1, 1, 3])),
                                  ('input 1: particle 9', start(), change(1, 0.5, held=[9], accelerations=[0.0, 0.0])),
                                  ('input 2: comes after the end', start(), change(1, 0.5, end=True), change(2, 0.5))):
                write_inputs(path, *inputs)
                self.check_refused(folder, path, says, 2)

    def test_a_damaged_bag_has_one_line_with_its_name(self):
        with Folder() as folder:
            path = os.path.join(folder, 'inputs.bag')
            write_inputs(path, start(), change(1, 0.5), change(2, 0.5, end=True))
            with open(path, 'rb') as file:
                whole = file.read()
            at = whole.index(b'air_drag=0') - 4  # the length of a text
            header = whole.rindex(b'message_definition=') - 4  # of the index
            for place in (at, header):
                with open(path, 'wb') as file:
                    file.write(whole[:place] + b'\xff\xff\xff\x0f' + whole[place + 4:])
                self.check_refused(folder, path, 'cannot be read as a bag', 1)
            for length in range(100, len(whole), 400):
                with open(path, 'wb') as file:
                    file.write(whole[:length])
                self.check_refused(folder, path, 'cannot be read as a bag', 1)

    def test_repeats_a_run_that_continues_after_a_divergence(self):
        values = {'method': 'Euler', 'time_step': '0.1', 'frames': '60', 'on_divergence': 'continue'}
        constants = [text.split('=')[0] + '=' + values.get(*text.split('=')) for text in CONSTANTS_OF_RUN]
        with Folder() as folder:
            path = os.path.join(folder, 'inputs.bag')
            write_inputs(path, start(scenario=constants), change(1, 59.0, scenario=constants, end=True))
            done = self.replay(folder, path)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn(', 60 frames, ', done.stdout)

    def test_a_recorder_gets_all_inputs_of_a_short_run(self):
        inputs = Listener('inputs', PendulumInput)
        with PendulumNode(frames=3, at_end='exit') as node:
            self.assertEqual(node.wait(), 0, node.output())
        inputs.close()
        self.assertEqual([(m.number, m.start, m.end) for m in inputs.messages], [(0, True, False), (1, False, True)])

    def test_ends_where_the_node_ended_and_tells_if_that_is_unknown(self):
        with Folder() as folder:
            path, pull = os.path.join(folder, 'inputs.bag'), dict(held=[3], accelerations=[0.0, 1.0])
            for frames, says, *inputs in ((6, '', start(), change(1, 0.2, **pull), change(2, 0.5, end=True)),
                                          (1, '', start(), change(1, 0.0, end=True)),
                                          (20, 'the last inputs may be missing', start(), change(1, 0.2, **pull)),
                                          (20, 'ended before input 1 at t = 9 s', start(), change(1, 9.0, **pull),
                                           change(2, 9.5, end=True))):
                write_inputs(path, *inputs)
                done = self.replay(folder, path)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(', %d frame%s, ' % (frames, 's' if frames > 1 else ''), done.stdout)
                self.assertIn(says, done.stderr)
                self.assertEqual(done.stderr.count('\n'), 1 if says else 0, done.stderr)


if __name__ == '__main__':
    rospy.init_node('inputs_test', disable_signals=True)
    rostest.rosrun('spring_pendulum', 'inputs', '__main__')
