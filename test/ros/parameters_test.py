"""Valid and invalid parameters."""
import os
import re
import subprocess
import unittest
from pathlib import Path

import rosgraph
import yaml
from visualization_msgs.msg import MarkerArray

from pendulum_process import (HORIZONTAL, NO_MASTER, Folder, Listener, PendulumNode, ended_node, files_in,
                              program, project, read_frames, run_program, wait_until, write)

# Values with a visible effect, and what they need; other options get twice their default.
VALUES = {'method': 'Runge-Kutta-2', 'particles': project('data/two_masses.txt'), 'output': 'elsewhere', 'resume': True,
          'no_frames': True, 'energy': 'energy.csv', 'save_state': 'state.txt', 'start': 'at_rest',
          'on_divergence': 'continue', 'reference': 'never', 'sleep': 1e3}
EXTRA = {'on_divergence': {'time_step': 0.5}}


class Parameters(unittest.TestCase):

    def test_each_bad_one_ends_the_node_with_one_clear_line(self):
        cases = yaml.safe_load(Path(project('test/ros/bad_parameters.yaml')).read_text())
        self.assertGreater(len(cases), 30)
        for case in cases:
            with PendulumNode(**case['parameters']) as node:
                self.assertEqual(node.wait(), case.get('status', 2), (node.output()))
                self.assertEqual(len(node.output().strip().splitlines()), 1, node.output())
                self.assertIn(case['says'], node.lines('FATAL')[0])
                if case.get('status', 2) == 2:
                    # It may come from an earlier run. The chain has yet to be read when `held` is.
                    cure = '' if 'held' in case['parameters'] else 'rosparam delete /pendulum'
                    self.assertIn(cure, node.lines('FATAL')[0])

    def test_extremes_work_or_are_refused_in_one_line(self):
        numbers = [5e-324, 1e300]
        counts = ['2147483648', '9223372036854775807']
        extremes = {
            **{name: numbers for name in ('display_rate', 'real_time_factor', 'wait_timeout')},
            **{name: counts for name in ('display_limit', 'text_row', 'wait_for_subscribers')},
            'frame_id': ['a' * 10000, '\u00e4'], 'camera_frame': ['a' * 10000]}
        markers = Listener('markers', MarkerArray, keep=1)
        for name, values in extremes.items():
            for value in values:
                parameters = {'frames': 3, 'real_time_factor': 1.0, name: value}
                if name == 'wait_timeout':
                    parameters['wait_for_subscribers'] = 5
                with PendulumNode(**parameters) as node:
                    waits_for_ever = name in ('real_time_factor', 'wait_timeout', 'wait_for_subscribers')
                    wait_until(lambda: node.process.poll() is not None or
                               waits_for_ever and 'no frame files' in node.output(), 'an answer')
                    node.interrupt()
                    case = (name, value, node.wait(), node.output())
                    if case[2] != 0:
                        self.assertEqual(case[2], 2, case)
                        self.assertEqual(len(node.output().strip().splitlines()), 1, case)
                        self.assertIn(name, node.lines('FATAL')[0], case)
        markers.close()

    def test_a_clock_that_would_end_during_the_run_is_refused_before_it(self):
        with Folder() as folder:
            write(folder + '/frame_0000.txt', '1 2\n')
            node = ended_node(2, output=folder, frames=4, time_step=1e9, steps_per_frame=1, publish_clock=True)
            self.assertIn('simulated time 3e+09 s is too large', node.lines('FATAL')[0])
            self.assertEqual(Path(folder, 'frame_0000.txt').read_text(), '1 2\n')

    def test_every_option_of_a_run_acts_as_in_exercise3(self):
        defaults = yaml.safe_load(Path(project('config/pendulum.yaml')).read_text())
        self.assertGreater(len(defaults), 18)
        for key, default in defaults.items():
            value = VALUES.get(key, 2 * default if default else 0.25)
            options = {'method': 'Auto' if key in ('tolerance', 'frame_interval') else 'Euler', 'frames': 40,
                       'damping': 0.1, 'output': '.', 'particles': HORIZONTAL, **EXTRA.get(key, {}), key: value}
            words = ['--%s%s' % (name.replace('_', '-'), '' if text is True else '=%s' % text)
                     for name, text in options.items() if name != 'method']
            with Folder() as expected, Folder() as folder:
                status = subprocess.run([program('Exercise3'), options['method'], *words], cwd=expected,
                                        capture_output=True).returncode
                ended_node(status, cwd=folder, **options)
                self.assertEqual(files_in(folder), files_in(expected), key)

    def test_relative_output_and_frames_only_on_request(self):
        for output, frames in ((None, 0), ('sub/frames', 2)):
            with Folder() as folder:
                node = ended_node(arguments=['_method:=Euler', '_frames:=2'], output=output, cwd=folder)
                self.assertIn(folder + '/sub/frames' if frames else 'no frame files', node.output())
                self.assertEqual(len(files_in(folder)), frames)

    def test_other_arguments_and_invalid_names_are_refused_in_one_line(self):
        for arguments, message in (
                (['--frames', '3'], "unexpected argument '--frames': the node takes parameters, for example "
                                    '_frames:=100\n'),
                (['__name:=7th'], 'Character [7] is not valid as the first character in Graph Resource Name'),
                (['__name:=a/b'], 'Invalid node name [a/b]: node names cannot contain /'),
                (['__name:='], 'the name of the node must not be empty\n')):
            done = run_program('pendulum_node', *arguments, status=2)
            self.assertEqual((done.stderr[:len(message)], done.stderr.count('\n')), (message, 1), done.stderr)

    def test_a_text_that_ros_takes_for_a_number_is_refused_and_its_cure_works(self):
        for text, guess in (('0042', '42'), ('1e3', '1000'), ('True', 'true')):
            with Folder() as folder:
                os.mkdir(folder + '/' + guess)
                open(folder + '/' + guess + '/frame_0007.txt', 'w').close()
                node = ended_node(2, arguments=['_output:=' + text], output=None, frames=2, cwd=folder)
                self.assertIn('for a file, _output:=./NAME', node.lines('FATAL')[0])
                self.assertEqual(os.listdir(folder + '/' + guess), ['frame_0007.txt'])
                ended_node(arguments=['_output:=./' + text], output=None, frames=2, cwd=folder)
                self.assertEqual(len(read_frames(folder + '/' + text)), 2)

    def test_a_forgotten_underscore_is_an_error_with_the_cure(self):
        for argument in ('method:=Auto', 'particles:=data/x.txt', 'frames:=3'):
            self.assertEqual(run_program('pendulum_node', argument, status=2).stderr,
                             "'%s' sets no parameter: write _%s\n" % (argument, argument))
        ended_node(arguments=['markers:=elsewhere'], frames=2)
        ended_node(2, arguments=['markers:=state'], frames=2)

    def test_help_lists_every_parameter_with_its_default(self):
        known = re.search(r'known[^,]* (\w+(?:, \w+)*)', ended_node(2, bogus=1).output()).group(1).split(', ')
        done = run_program('pendulum_node', '--help', env=dict(os.environ, **NO_MASTER))
        self.assertEqual(done.stderr, '')
        self.assertEqual(re.findall(r'^  _(\w+)$', done.stdout, re.M), known)
        self.assertRegex(done.stdout, r'_time_step\n .*fixed-step methods \[0\.01 s\]')

    def test_a_missing_default_file_names_the_parameter(self):
        with Folder() as folder, PendulumNode(particles=None, cwd=folder) as node:
            self.assertEqual(node.wait(), 1)
            self.assertIn(folder + '/particle.txt: no such file; give a particle file with '
                          '_particles:=FILE', node.output())

    def test_the_log_keeps_every_character(self):
        for language in ('C', 'C.UTF-8'):
            with Folder() as folder:
                node = ended_node(output=folder + '/jörgen', frames=2, env={'LC_ALL': language, 'LANG': language})
                self.assertIn('/jörgen', node.output())

    def test_a_node_below_is_no_parameter_of_this_one_only_if_it_has_none(self):
        rosgraph.Master('/test').setParam('/other/pendulum/frames', 2)
        ended_node(frames=2)
