"""record_bag: a bag with the messages of the node, the same bytes in every run, readable by all ROS
tools."""
import math
import os
import subprocess
import unittest
from pathlib import Path

import rosbag
from spring_pendulum.msg import PendulumState, PendulumStatus
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from pendulum_process import NO_MASTER, SCENE, Folder, Listener, case, read_frames, run_exercise, run_program


def record(folder, name, *arguments, method='Runge-Kutta-4', status=0):
    path = os.path.join(folder, name)
    done = run_program('record_bag', method, '--particles', SCENE, '--bag', path, *arguments, status=status,
                       env=dict(os.environ, **NO_MASTER))
    return path, done.stdout + done.stderr


def contents(path, topic):
    with rosbag.Bag(path) as bag:
        return [(message, stamp) for _, message, stamp in bag.read_messages(topics=[topic])]


class Bag(unittest.TestCase):

    def test_two_runs_give_the_same_bytes(self):
        with Folder() as folder:
            one, _ = record(folder, 'one.bag')
            two, _ = record(folder, 'two.bag')
            self.assertTrue(Path(one).read_bytes() == Path(two).read_bytes())
            self.assertEqual(sorted(os.listdir(folder)), ['one.bag', 'two.bag'])

    def test_holds_the_500_frames_of_the_exercise(self):
        with Folder() as folder:
            frames = run_exercise(folder, 'Runge-Kutta-4', '--particles', SCENE)
            path, _ = record(folder, 'one.bag')
            states = contents(path, '/state')
            markers = contents(path, '/markers')
        at_frames = [message for message, _ in states if message.at_frame]
        self.assertEqual([message.frame for message in at_frames], list(range(500)))
        for message in at_frames:
            lines = frames['frame_%04d.txt' % message.frame].decode().splitlines()
            self.assertEqual([(p.x, p.z) for p in message.positions], [tuple(map(float, line.split())) for line in lines])
        self.assertEqual(len(states), 1498)  # 3 states a frame at 30 Hz
        self.assertEqual([m.header.stamp for m, _ in states], [m.markers[0].header.stamp for m, _ in markers])
        for message, stamp in states:
            self.assertEqual(message.header.stamp, stamp)
            self.assertAlmostEqual(stamp.to_sec(), 1.0 + message.time, places=6)
        stamps = [stamp.to_nsec() for _, stamp in states]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))

    def test_the_display_rate_is_kept_by_every_kind_of_method(self):
        for method, rate in (('Auto', 30), ('Auto', 25), ('Auto', 60), ('Auto', 11), ('Runge-Kutta-4', 30), ('Runge-Kutta-4', 25)):
            with Folder() as folder:
                path, _ = record(folder, 'one.bag', '--frames', '101', '--display-rate', str(rate), method=method)
                states = [message for message, _ in contents(path, '/state')]
            self.assertEqual([m.frame for m in states if m.at_frame], list(range(101)))
            self.assertAlmostEqual((len(states) - 1) / (10.0 * rate), 1.0, delta=0.1, msg=(method, rate))

    def test_status_is_latched(self):
        with Folder() as folder:
            path, _ = record(folder, 'one.bag', '--frames', '5')
            codes = [message.code for message, _ in contents(path, '/status')]
            with rosbag.Bag(path) as bag:
                latched = {c.topic: c.header.get('latching') for c in bag._get_connections()}
        self.assertEqual(codes, [PendulumStatus.RUNNING, PendulumStatus.FINISHED])
        self.assertIn(latched['/status'], (b'1', '1'))
        self.assertNotIn(latched['/state'], (b'1', '1'))

    def test_several_methods_in_one_bag(self):
        with Folder() as folder:
            record(folder, 'all.bag', '--namespace', 'euler', '--frames', '5', method='Euler')
            path, _ = record(folder, 'all.bag', '--namespace', '/rk4/', '--append', '--frames', '5')
            self.assertEqual({m.method for m, _ in contents(path, '/euler/state')}, {'Euler'})
            self.assertEqual({m.method for m, _ in contents(path, '/rk4/state')}, {'Runge-Kutta-4'})

    def test_appends_only_to_a_complete_bag(self):
        with Folder() as folder:
            path, _ = record(folder, 'one.bag', '--frames', '2')
            whole = Path(path).read_bytes()
            for text in (b'', b'no bag', whole[:5000], whole[:-100]):
                Path(path).write_bytes(text)
                _, output = record(folder, 'one.bag', '--append', '--time-step', '0.5', status=1)
                self.assertEqual(output, path + ': is not a complete bag, so nothing can be appended to it\n')
                self.assertEqual(Path(path).read_bytes(), text)

    def test_rosbag_info_and_play(self):
        with Folder() as folder:
            path, _ = record(folder, 'one.bag', '--frames', '11', '--display-rate', '0')
            info = subprocess.run(['rosbag', 'info', '-y', path], capture_output=True, text=True, check=True).stdout
            self.assertIn('messages: 25', info)  # 11 markers, 11 states, 2 status, the camera
            state, markers = Listener('/state', PendulumState), Listener('/markers', MarkerArray)
            status, camera = Listener('/status', PendulumStatus), Listener('/tf_static', TFMessage)
            subprocess.run(['rosbag', 'play', '--quiet', '--wait-for-subscribers', path],
                           check=True, timeout=60, stdout=subprocess.DEVNULL)
            self.assertEqual(len(state.wait_for(11)), 11)
            self.assertEqual(len(markers.wait_for(11)), 11)
            status.wait_for_any(lambda m: m.code == PendulumStatus.FINISHED)
            self.assertEqual(camera.wait_for(1)[0].transforms[0].child_frame_id, 'pendulum_camera')

    def test_divergence_is_in_the_bag_and_in_the_exit_status(self):
        with Folder() as folder:
            path, output = record(folder, 'one.bag', '--time-step', '0.5', '--steps-per-frame', '5000', status=3)
            self.assertIn('warning: Runge-Kutta-4 may be unstable with a time step of 0.5 s', output)
            self.assertRegex(output, r'diverged at t = .*; largest stable step for Runge-Kutta-4: ')
            self.assertEqual(contents(path, '/status')[-1][0].code, PendulumStatus.DIVERGED)
            self.assertFalse([m for m, *_ in contents(path, '/state') if math.isnan(m.tip_speed) and m.verdict == 'ok'])

    def test_obeys_the_options_of_the_exercise(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', SCENE, '--frames', '5',
                                    '--damping', '0', '--energy', expected_folder + '/energy.csv')
            record(folder, 'one.bag', '--frames=5', '--energy', folder + '/energy.csv', '--output', folder + '/frames',
                               '--damping', '0', method='Euler')
            self.assertEqual(sorted(os.listdir(folder)), ['energy.csv', 'frames', 'one.bag'])
            self.assertEqual(read_frames(folder + '/frames'), expected)
            self.assertEqual(*(Path(name, 'energy.csv').read_text() for name in (folder, expected_folder)))

    def test_energy_tracking_can_be_switched_off_where_it_costs(self):
        for steps, tracked in (('10', True), ('1000000', False)):
            with case(steps=steps), Folder() as folder:
                path, _ = record(folder, 'one.bag', '--frames', '2', '--time-step', '1e-6',
                                 '--steps-per-frame', steps, '--track-dissipation', 'false')
                error = contents(path, '/state')[-1][0].energy_error
                self.assertEqual(math.isnan(error), not tracked)

    def test_bad_use_leaves_no_file(self):
        cases = [(('--color', 'red'), 2, "--color: must be #rrggbb"), (('--frames', '0'), 2, 'frames'),
                 (('--at-end', 'loop'), 2, '--at-end'), (('--text-row',), 2, '--text-row: needs a value'),
                 (('--time-step', '0,5'), 2, 'use a decimal point'), (('Euler',), 2, 'only one METHOD'),
                 (('--bag', 'x.bag'), 2, '--bag: is given twice'), ((), 1, 'particle.txt'),
                 (('--time-step', '0.5'), 1, 'particle.txt')]
        for arguments, status, message in cases:
            with case(arguments=arguments), Folder() as folder:
                # A bag that is to lie in a file cannot be written.
                name = SCENE + '/x.bag' if status == 1 else 'one.bag'
                _, output = record(folder, name, *arguments, status=status)
                self.assertIn(message, output)
                self.assertEqual(len(output.strip().splitlines()), 1)
                self.assertEqual(os.listdir(folder), [])
