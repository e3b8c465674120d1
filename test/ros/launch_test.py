"""The launch files, without a display."""
import glob
import os
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

import rosbag
import rosgraph
import rospy
import yaml

from pendulum_process import (SCENE, Folder, PendulumNode, files_in, program, project, read_frames, run_exercise,
                              run_program, write)


def launch(file, *arguments, cwd='/'):
    done = subprocess.run(['roslaunch', '--wait', 'spring_pendulum', file, *arguments], cwd=cwd,
                          capture_output=True, text=True, timeout=120, env=dict(os.environ, PWD=cwd))
    return done.stdout + done.stderr


class Launch(unittest.TestCase):

    def test_every_argument_is_explained(self):
        files = glob.glob(project('launch/*.launch'))
        self.assertGreaterEqual(len(files), 5)
        for file in files:
            for argument in xml.etree.ElementTree.parse(file).getroot().findall('arg'):
                if argument.get('value') is None:
                    self.assertTrue(argument.get('doc'), (file, argument.get('name')))
                    self.assertNotEqual(argument.get('default'), '', 'roslaunch would call it required')

    def test_a_number_reaches_the_node_as_the_text_that_was_written(self):
        with Folder() as folder:
            shutil.copy(SCENE, folder + '/1e3')
            launch('pendulum.launch', 'rviz:=false', 'at_end:=exit', 'frames:=2', 'output:=0042',
                   'particles:=1e3', 'real_time_factor:=0', 'tolerance:=9999999999', cwd=folder)
            self.assertEqual(sorted(os.listdir(folder)), ['0042', '1e3'])

    def test_pendulum(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', SCENE, '--frames', '7', '--damping', '0.5')
            output = launch('pendulum.launch', 'rviz:=false', 'at_end:=exit', 'frames:=7',
                            'real_time_factor:=0', 'method:=Euler', 'damping:=0.5', 'output:=frames', cwd=folder)
            self.assertIn(folder + '/frames', output)
            self.assertEqual(read_frames(folder + '/frames'), expected)

    def test_a_value_in_config_holds_unless_an_argument_is_given(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', SCENE, '--frames', '4',
                                    '--time-step', '0.002', '--gravity', '1.62')
            shutil.copy(SCENE, folder + '/mine.txt')
            write(folder + '/mine.yaml', 'method: Euler\nframes: 9\ntime_step: 0.002\ngravity: 9.0\noutput: mine\n'
                  'particles: mine.txt\nreal_time_factor: 0.0\nat_end: exit\n')
            launch('pendulum.launch', 'rviz:=false', 'config:=' + folder + '/mine.yaml', 'frames:=4',
                   'params:={gravity: 1.62, frames: 7}', cwd=folder)
            self.assertEqual(read_frames(folder + '/mine'), expected)

    def test_no_frames_are_written_unless_asked_for(self):
        with Folder() as folder:
            for output in ([], ['output:=']):
                launch('pendulum.launch', 'rviz:=false', 'at_end:=exit', 'frames:=3', 'real_time_factor:=0', *output,
                       cwd=folder)
                self.assertEqual(os.listdir(folder), [])

    def test_compare(self):
        with Folder() as folder, Folder() as expected_folder:
            output = launch('compare.launch', 'rviz:=false', 'at_end:=exit', 'frames:=6',
                            'output:=0042', 'real_time_factor:=4.0', cwd=folder)
            self.assertEqual(output.count('verdict: ok'), 3, output)
            for method, name in (('Euler', 'euler'), ('Runge-Kutta-2', 'runge_kutta_2'),
                                 ('Runge-Kutta-4', 'runge_kutta_4')):
                expected = run_exercise(expected_folder, method, '--particles', SCENE, '--frames', '6')
                self.assertEqual(read_frames(os.path.join(folder, '0042', name)), expected)

    def test_record_loses_nothing_and_closes_the_bag(self):
        with Folder() as folder:
            # A replay with --clock leaves this behind.
            rosgraph.Master('/test').setParam('/use_sim_time', True)
            others = [subprocess.Popen(['rostopic', 'echo', topic], stdout=subprocess.DEVNULL)
                      for topic in ('/markers', '/state', '/status')]
            output = launch('record.launch', 'bag:=one run.bag', 'frames:=12',
                            'params:={display_rate: 20.0, real_time_factor: 2.0}', cwd=folder)
            for other in others:
                other.terminate()
                other.wait()
            self.assertEqual(os.listdir(folder), ['one run.bag'], output)
            with rosbag.Bag(folder + '/one run.bag') as bag:
                self.assertGreaterEqual(bag.get_message_count('/tf_static'), 1)
                states = [message for _, message, _ in bag.read_messages(topics=['/state'])]
                markers = bag.get_message_count('/markers')
                status = [message for _, message, _ in bag.read_messages(topics=['/status'])]
            self.assertEqual([m.frame for m in states if m.at_frame], list(range(12)))
            self.assertEqual(markers, len(states) + 1, 'the last one deletes them')
            self.assertIn('finished', status[-1].text)

    def test_record_says_that_no_bag_was_written(self):
        output = launch('record.launch', 'bag:=/dev/null/one.bag', 'frames:=12')
        self.assertIn('no bag was written to /dev/null/one.bag', output)
        with Folder() as folder:
            write(folder + '/one.bag', 'earlier')
            output = launch('record.launch', 'bag:=one.bag', 'method:=Oiler', cwd=folder)
            self.assertEqual(files_in(folder), {'one.bag': b'earlier'})
        self.assertIn("unknown method 'Oiler'", output)
        self.assertIn('no bag was written to ' + folder + '/one.bag: nothing was recorded', output)
        self.assertNotIn('Traceback', output)

    def test_record_waits_for_the_topics_that_are_wanted(self):
        for topics, count in (('/state', 1), ('state /markers /joint_states', 2), ('/tf_static', 3), ('-a', 3)):
            listed = launch('record.launch', 'topics:=' + topics, 'rviz:=true', '--dump-params')
            self.assertIn('/pendulum/wait_for_subscribers: %d\n' % count, listed, topics)

    def test_record_sh_replaces_an_earlier_bag_only_by_a_new_one(self):
        with Folder() as folder:
            bag, rosrun, link = folder + '/one.bag', folder + '/rosrun', folder + '/link.bag'
            os.symlink('one.bag', link)
            for recorder, text, message in (
                    ('exit 1', 'earlier', 'no bag was written to ' + bag),
                    ('head -c 4117 /dev/zero > "$4.active"; mv "$4.active" "$4"', 'earlier', 'nothing was recorded'),
                    ('yes new | head -n 2000 > "$4.active"; exit 1', 'earlier', 'may repair %s.active' % bag),
                    ('yes new | head -n 2000 > "$4"; exit 1', 'earlier', 'what was recorded is in ' + bag[:-4]),
                    ('yes new | head -n 2000 > "$4.active"; mv "$4.active" "$4"', 'new', ''),
                    ('group=$(ps -o pgid= $PPID); trap "trap : INT; sleep 0.1; kill -INT -${group##* }; sleep 0.3; '
                     'mv $4.active $4; exit" INT; yes new | head -n 2000 > "$4.active"; kill -INT $PPID; '
                     'for i in $(seq 50); do sleep 0.1; done', 'new', '')):  # two signals, though ignored by the caller
                write(bag, 'earlier\n')
                write(rosrun, '#!/bin/sh\n' + recorder + '\n')
                os.chmod(rosrun, 0o755)
                done = subprocess.run(['sh', '-c', 'trap "" INT; "$@"', '', project('scripts/record.sh'), link, '/state'],
                                      capture_output=True, text=True, start_new_session=True,
                                      env=dict(os.environ, PATH=folder + ':/usr/bin:/bin'))
                self.assertEqual(done.returncode, 1 if message else 0)
                self.assertIn(message, done.stderr)
                self.assertEqual(files_in(folder)['one.bag'].split(b'\n')[0].decode(), text)
            self.assertEqual(os.readlink(link), 'one.bag')
            self.assertEqual(sorted(re.sub(r'\.\w{6}\.', '.part.', name) for name in os.listdir(folder)),
                             ['link.bag', 'one.bag', 'one.bag.active', 'one.part.bag', 'rosrun'])

    def test_film_sh_refuses_what_makes_no_film_before_it_films(self):
        with Folder() as folder:
            bag = folder + '/one.bag'
            open(bag, 'w').close()
            os.mkdir(folder + '/a.gif')
            for out, options, message in (
                    ('one.gif', ['--fps', '0.0'], "--fps is '0.0': must be above 0"),
                    ('one.gif', ['--size', '0x0'], "--size is '0x0': must be WIDTHxHEIGHT, for example 800x600"),
                    ('one.gif', ['--slow', '0.0'], "--slow is '0.0': must be above 0"),
                    ('one.gif', ['--duration', '0.0'], "--duration is '0.0': must be above 0"),
                    ('a.mp4', ['--size', '9x8'], "--size is '9x8': an .mp4 needs an even width and height"),
                    ('nowhere/a.gif', [], "the folder of '%s' does not exist"), ('a.gif', [], "'%s' cannot be written")):
                path = os.path.realpath(folder + '/' + out)
                done = subprocess.run([project('scripts/film.sh'), bag, path, *options], capture_output=True, text=True)
                message = message % path if '%' in message else message
                self.assertEqual((done.returncode, done.stderr), (1, 'film.sh: %s\n' % message))

    def view(self, folder, source='none', rviz='cat "$2"', config=project('rviz/pendulum.rviz'), **environment):
        """Runs view.py with a shell script in place of rviz."""
        for name, text in (('python3', 'exit 9'), ('rviz', rviz)):  # another python3 does no harm
            if text:
                write(folder + '/' + name, '#!/bin/sh\n%s\n' % text)
                os.chmod(folder + '/' + name, 0o755)
        changes = {'PATH': folder + ':' + os.environ['PATH'], 'QT_QPA_PLATFORM': 'offscreen', 'ROS_HOME': folder,
                   **environment}
        return subprocess.run([project('scripts/view.py'), config, source], capture_output=True, text=True,
                              env={k: v for k, v in dict(os.environ, **changes).items() if v is not None})

    def test_view_says_what_is_missing(self):
        for message, changes in (('rviz needs a display, and DISPLAY is not set; without one, use rviz:=false\n',
                                  dict(DISPLAY=None, WAYLAND_DISPLAY=None, QT_QPA_PLATFORM=None)),
                                 ('rviz is not installed: run scripts/setup.sh rviz, or use rviz:=false\n',
                                  dict(rviz='', PATH='/nowhere'))):
            with Folder() as folder:
                done = self.view(folder, **changes)
            self.assertEqual((done.returncode, done.stderr), (1, message))

    def test_view_names_a_config_that_cannot_be_used(self):
        with Folder() as folder:
            for text in ('no configuration', 'a: [', 'Visualization Manager: {}',
                         'Visualization Manager: {Displays: [Class]}',
                         'Visualization Manager: {Displays: [{Class: rviz/MarkerArray, Marker Topic: null}]}'):
                path = write(folder + '/text.rviz', text)
                for source in ('none', 'nope.bag'):
                    for name, says in ((path, 'is not a configuration of rviz'), ('x.rviz', 'No such file or directory')):
                        done = self.view(folder, source, config=name)
                        self.assertEqual((done.returncode, done.stderr), (1, '%s: %s\n' % (name, says)))

    def test_a_bag_without_a_camera_is_seen_from_near(self):
        with Folder() as folder:
            run_program('record_bag', 'Runge-Kutta-4', '--particles', project('data/one_spring.txt'), '--frames', 20,
                        '--camera-frame', '', '--bag', folder + '/one.bag')
            done = self.view(folder, folder + '/one.bag')
            for views in ('null', '{Current: null}'):
                config = write(folder + '/a.rviz', 'Visualization Manager: {Displays: [], Views: %s}' % views)
                refused = self.view(folder, folder + '/one.bag', config=config)
                self.assertEqual(refused.stderr, config + ': is not a configuration of rviz\n')
        view = yaml.safe_load(done.stdout)['Visualization Manager']['Views']['Current']
        self.assertLess(view['Position']['Y'], -2.0)
        self.assertGreater(view['Position']['Y'], -5.0)  # -2.5 measured

    def test_rviz_shows_nodes_in_namespaces(self):
        with Folder() as folder, PendulumNode('/left/pendulum', frames=100000, real_time_factor=1.0):
            rospy.wait_for_service('/left/pendulum/reset', timeout=60)
            done = self.view(folder)
        displays = yaml.safe_load(done.stdout)['Visualization Manager']['Displays']
        topics = [d['Marker Topic'] for d in displays if d['Class'] == 'rviz/MarkerArray']
        self.assertEqual(topics, ['markers', '/left/markers'])

    def test_replay_without_loop_plays_the_bag_and_ends(self):
        with Folder() as folder:
            run_program('record_bag', 'Euler', '--particles', SCENE, '--frames', 5, '--bag', folder + '/one.bag')
            output = launch('replay.launch', 'bag:=one.bag', 'rviz:=false', 'loop:=false', 'rate:=10', cwd=folder)
        self.assertIn('process has finished cleanly', output)

    def test_record_sh_refuses_to_record_nothing_or_parts(self):
        for arguments, status, message in (([], 2, 'Usage: record.sh BAG TOPIC ...'),
                                           (['--spl', '/state'], 1, '--split would make several bags')):
            done = subprocess.run([project('scripts/record.sh'), 'one.bag', *arguments], capture_output=True, text=True)
            self.assertEqual((done.returncode, message in done.stderr), (status, True), done.stderr)
