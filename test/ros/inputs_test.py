"""Runs that are repeated from the inputs in a bag."""
import os
import random
import signal
import subprocess
from pathlib import Path

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped, Vector3
from spring_pendulum.msg import PendulumInput, PendulumState
from visualization_msgs.msg import InteractiveMarkerFeedback

from pendulum_process import (Folder, NodeTest, connected, ended_node, feedback, pose, program, read_frames,
                              run_program, service, wait_until, write)

CONSTANTS = (('stiffness', 80), ('damping', 0.5), ('gravity', 5.25), ('air_drag', 0.3), ('rest_length', 0.9),
             ('tolerance', 1e-7))
CONSTANTS_OF_RUN = ['method=Runge-Kutta-4', 'on_divergence=stop', 'frames=20', 'steps_per_frame=10', 'time_step=0.01',
                    'tolerance=1e-6', 'frame_interval=0.1', 'stiffness=50', 'damping=1', 'rest_length=1', 'gravity=9.81',
                    'air_drag=0', 'threads=1', 'sleep=0']


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


class Repeated(NodeTest):

    def setUp(self):
        super().setUp()
        self.inputs = self.listen('inputs', PendulumInput)

    def disturb(self, dice, method):
        """Acts on a node until its run is over."""
        hand, robot = connected('handles/feedback', InteractiveMarkerFeedback), connected('held_11/pose', PoseStamped)
        jumps = 0
        while self.last().frame < 79:
            choice = dice.random()
            if choice < 0.4:
                event = InteractiveMarkerFeedback.MOUSE_UP if dice.random() < 0.2 else InteractiveMarkerFeedback.POSE_UPDATE
                hand.publish(feedback(6, event, dice.uniform(3, 7), dice.uniform(-2, 2)))
            elif choice < 0.65:
                robot.publish(pose(dice.uniform(9, 10), dice.uniform(-1, 1)))
            elif choice < 0.75:
                service('apply_force')(dice.randint(2, 10), '', Vector3(dice.uniform(-5, 5), 0, 3), 0.0, 0.3)
            elif choice < 0.83:
                service('set')(*dice.choice(CONSTANTS))
            elif choice < 0.88:
                service('set_method')(dice.choice(('Auto', 'Runge-Kutta-4', 'Taylor-8', method)))
            elif choice < 0.95 and jumps < 4:
                jumps += 1
                service('set_method')(dice.choice(('Auto', method)))
                service(dice.choice(('reset', 'at_rest')))()
            else:
                service('pause')(True)
                rospy.sleep(0.02)
                service('pause')(False)
            rospy.sleep(0.02)

    def repeat(self, method, seed):
        dice = random.Random(seed)
        parameters = dict(method=method, frames=80, steps_per_frame=dice.choice((5, 10)), time_step=0.01,
                          frame_interval=dice.choice((0.05, 0.1)), damping=dice.choice((0.0, 0.5)),
                          display_rate=dice.choice((0.0, 30.0, 50.0)), air_drag=dice.choice((0.0, 0.1)),
                          rest_length=dice.uniform(0.8, 1.0), on_divergence=dice.choice(('stop', 'continue')),
                          tolerance=dice.choice((1e-6, 1e-8)), threads=dice.choice((1, 2)))
        with Folder() as folder:
            bag, live, again = (os.path.join(folder, name) for name in ('inputs.bag', 'live', 'again'))
            recorder = subprocess.Popen(['rosbag', 'record', '-O', bag, '/inputs', '__name:=recorder'],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            master = rospy.get_master()
            wait_until(lambda: any(topic == '/inputs' and '/recorder' in names
                                   for topic, names in master.getSystemState()[2][1]), 'the recorder')
            with self.node(output=live, held='last', at_end='exit', **parameters) as node:
                self.state.wait_for(2)
                try:
                    self.disturb(dice, method)
                except rospy.ServiceException:  # the run is over
                    pass
                node.ends()
            self.inputs.wait_for_any(lambda m: m.end)
            rospy.sleep(1.0)
            recorder.send_signal(signal.SIGINT)
            recorder.wait(60)
            wait_until(lambda: os.path.exists(bag), 'the end of the bag')
            with rosbag.Bag(bag) as recorded:
                numbers = {message.number for _, message, _ in recorded.read_messages()}
            self.assertEqual(numbers, {m.number for m in self.inputs.messages})
            self.assertGreater(len(numbers), 30)
            done = run_program('record_bag', '--inputs', bag, '--bag', folder + '/again.bag', '--output', again)
            self.assertEqual(done.stderr, '', parameters)
            expected = read_frames(live)
            self.assertEqual(len(expected), 80)
            self.assertTrue(read_frames(again) == expected, parameters)

    def test_a_fixed_step_run(self):
        self.repeat('Runge-Kutta-4', 1)

    def test_an_error_controlled_run(self):
        self.repeat('Auto', 2)

    def memory_of(self, count):
        """The memory for repeating a run with this number of inputs, and the size of their bag."""
        scenario = [s.replace('frames=20', 'frames=%d' % (count // 10 + 3)) for s in CONSTANTS_OF_RUN]
        pull = change(1, 0.0, held=[3], accelerations=[0.0, 0.0], scenario=scenario)
        with Folder() as folder:
            path = folder + '/inputs.bag'
            with rosbag.Bag(path, 'w') as bag:
                bag.write('/inputs', start(scenario=scenario), rospy.Time(1))
                for k in range(1, count):
                    pull.number, pull.accelerations[1] = k, 1e-9 * (k % 3 - 1)
                    bag.write('/inputs', pull, rospy.Time(1 + k // 100, k % 100))
                bag.write('/inputs', change(count, 0.1, scenario=scenario, end=True), rospy.Time(2 + count))
            process = subprocess.Popen([program('record_bag'), '--inputs', path, '--bag', folder + '/out.bag'],
                                       stdout=subprocess.DEVNULL)
            _, status, usage = os.wait4(process.pid, 0)
            self.assertEqual(status, 0)
            return 1024 * usage.ru_maxrss, os.path.getsize(path)

    def test_many_inputs_need_less_memory_than_their_bag(self):
        least, _ = self.memory_of(2)
        memory, size = self.memory_of(100000)
        self.assertLess(memory - least, size)  # measured: 20 MB of 41 MB

    def replay(self, folder, path, status=0):
        return run_program('record_bag', 'Euler', '--inputs', path, '--bag', folder + '/out.bag', status=status)

    def check_refused(self, folder, path, says, status):
        done = self.replay(folder, path, status)
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
            write(text, 'no bag')
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
                                  ('input 0: frame: must be at least 0', start(frame=-1)),
                                  ('input 0: is not complete', start(placed=[1, 1, 3])),
                                  ('input 1: particle 9', start(), change(1, 0.5, held=[9], accelerations=[0.0, 0.0])),
                                  ('input 0: nothing can act on the start', start(held=[2], accelerations=[1.0, 0.0])),
                                  ('input 2: comes after the end', start(), change(1, 0.5, end=True), change(2, 0.5)),
                                  ('input 2: comes after the end', start(), change(1, 0.5, end=True),
                                   change(2, 0.5, end=True))):
                write_inputs(path, *inputs)
                self.check_refused(folder, path, says, 2)

    def test_a_damaged_bag_has_one_line_with_its_name(self):
        with Folder() as folder:
            path = os.path.join(folder, 'inputs.bag')
            write_inputs(path, start(), change(1, 0.5), change(2, 0.5, end=True))
            whole = Path(path).read_bytes()
            at = whole.index(b'air_drag=0') - 4  # the length of a text
            header = whole.rindex(b'message_definition=') - 4  # of the index
            for place in (at, header):
                Path(path).write_bytes(whole[:place] + b'\xff\xff\xff\x0f' + whole[place + 4:])
                self.check_refused(folder, path, 'cannot be read as a bag', 1)
            for length in range(100, len(whole), 400):
                Path(path).write_bytes(whole[:length])
                self.check_refused(folder, path, 'cannot be read as a bag', 1)

    def test_repeats_a_run_that_continues_after_a_divergence(self):
        values = {'method': 'Euler', 'time_step': '0.1', 'frames': '60', 'on_divergence': 'continue'}
        constants = [text.split('=')[0] + '=' + values.get(*text.split('=')) for text in CONSTANTS_OF_RUN]
        with Folder() as folder:
            path = os.path.join(folder, 'inputs.bag')
            write_inputs(path, start(scenario=constants), change(1, 59.0, scenario=constants, end=True))
            done = self.replay(folder, path, status=3)
            self.assertIn(', 60 frames, ', done.stdout)

    def test_a_recorder_gets_all_inputs_of_a_short_run(self):
        ended_node(frames=3, at_end='exit')
        # A latched message can arrive twice.
        self.assertEqual(sorted({(m.number, m.start, m.end) for m in self.inputs.messages}),
                         [(0, True, False), (1, False, True)])

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
                self.assertIn(', %d frame%s, ' % (frames, 's' if frames > 1 else ''), done.stdout)
                self.assertIn(says, done.stderr)
                self.assertEqual(done.stderr.count('\n'), 1 if says else 0, done.stderr)
