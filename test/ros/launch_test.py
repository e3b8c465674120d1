#!/usr/bin/python3
"""The launch files, without a display."""
import glob
import os
import subprocess
import unittest
import xml.etree.ElementTree

import rosbag
import rostest

from pendulum_process import Folder, program, project, read_frames, run_exercise

SCENE = project('data/particle.txt')


def launch(file, *arguments, cwd='/'):
    done = subprocess.run(['roslaunch', '--wait', 'spring_pendulum', file, *arguments], cwd=cwd,
                          capture_output=True, text=True, timeout=120,
                          env=dict(os.environ, PWD=cwd))
    return done.stdout + done.stderr


class Launch(unittest.TestCase):

    def test_every_argument_is_explained(self):
        files = glob.glob(project('launch/*.launch'))
        self.assertGreaterEqual(len(files), 5)
        for file in files:
            for argument in xml.etree.ElementTree.parse(file).getroot().findall('arg'):
                if argument.get('value') is None:
                    self.assertTrue(argument.get('doc'), (file, argument.get('name')))

    def test_pendulum(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', SCENE, '--frames', '7')
            output = launch('pendulum.launch', 'rviz:=false', 'at_end:=exit', 'frames:=7',
                            'real_time_factor:=0', 'method:=Euler', cwd=folder)
            self.assertIn('frames go to ' + folder + '/frames', output)
            self.assertEqual(read_frames(folder + '/frames'), expected)
            output = launch('pendulum.launch', 'rviz:=false', 'at_end:=exit', 'frames:=7', 'no_frames:=true',
                            'real_time_factor:=0', 'config:=' + project('config/pendulum.yaml'))
            self.assertIn('no frame files', output)
            self.assertIn('7 frames, 60 steps', output)

    def test_compare(self):
        with Folder() as folder, Folder() as expected_folder:
            output = launch('compare.launch', 'rviz:=false', 'at_end:=exit', 'frames:=6',
                            'output:=' + folder, 'real_time_factor:=4.0')
            self.assertEqual(output.count('verdict: ok'), 3, output)
            for method, name in (('Euler', 'euler'), ('Runge-Kutta-2', 'runge_kutta_2'),
                                 ('Runge-Kutta-4', 'runge_kutta_4')):
                expected = run_exercise(expected_folder, method, '--particles', SCENE,
                                        '--frames', '6')
                self.assertEqual(read_frames(os.path.join(folder, name)), expected)

    def test_record_loses_nothing_and_closes_the_bag(self):
        with Folder() as folder:
            output = launch('record.launch', 'bag:=' + folder + '/one.bag', 'frames:=12',
                            'real_time_factor:=2.0', 'display_rate:=20.0')
            self.assertEqual(os.listdir(folder), ['one.bag'], output)
            with rosbag.Bag(folder + '/one.bag') as bag:
                states = [message for _, message, _ in bag.read_messages(topics=['/state'])]
                markers = bag.get_message_count('/markers')
                status = [message for _, message, _ in bag.read_messages(topics=['/status'])]
            self.assertEqual([m.frame for m in states if m.at_frame], list(range(12)))
            self.assertEqual(markers, len(states))
            self.assertIn('finished', status[-1].text)

    def test_nodes_scripts_are_found_where_rosrun_looks(self):
        for name in ('pendulum_node', 'record_bag', 'Exercise3'):
            self.assertTrue(os.access(program(name), os.X_OK))


if __name__ == '__main__':
    rostest.rosrun('spring_pendulum', 'launch', Launch)
