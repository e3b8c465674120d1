"""How a run ends: hold, exit, a motion that diverges, and a signal in every phase, also if SIGINT was
ignored when the node started, as in a job that a script starts with `&`."""
import os
import signal
import subprocess
import time
import unittest

from spring_pendulum.msg import PendulumStatus
from visualization_msgs.msg import MarkerArray

from pendulum_process import (HORIZONTAL, NO_MASTER, Folder, NodeTest, PendulumNode, case, computing_time, ended_node,
                              program, read_frames, run_exercise, running, service, standing, total_computing_time,
                              wait_until)


def ignore_interrupts():
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class Ends(NodeTest):

    def test_hold_keeps_showing_the_last_frame(self):
        with PendulumNode(frames=3, at_end='hold') as node:
            self.listen('status', PendulumStatus).wait_for_any(lambda m: m.code == PendulumStatus.FINISHED)
            self.assertEqual(wait_until(lambda: standing(self.state.messages), 'the last frame again').frame, 2)
            node.stop()

    def test_interrupted_exits_0_and_every_frame_is_whole(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with case(signal=number), Folder() as folder, Folder() as expected_folder:
                with PendulumNode(frames=100000, output=folder, particles=HORIZONTAL) as node:
                    wait_until(lambda: os.path.exists(folder + '/frame_0050.txt'), 'frame 50')
                    node.interrupt(number)
                    node.ends()
                    self.assertIn('verdict: ', node.output())
                frames = read_frames(folder)
                self.assertEqual(sorted(frames), sorted('frame_%04d.txt' % i for i in range(len(frames))))
                expected = run_exercise(expected_folder, 'Runge-Kutta-4', '--particles', HORIZONTAL,
                                        '--frames', len(frames))
                self.assertEqual(frames, expected)

    def test_nodes_of_one_name_that_start_together(self):
        for delay in (0.0, 0.02, 0.04, 0.05, 0.06):
            with case(delay=delay), PendulumNode(frames=100000, at_end='hold') as first:
                time.sleep(delay)
                with PendulumNode(frames=100000, at_end='hold') as second:
                    wait_until(lambda: first.process.poll() is not None or second.process.poll() is not None, 'an end')
                    for node in (first, second):
                        if 'the master ends this node' not in node.output():  # a second signal would kill it
                            node.interrupt()
                        node.ends()

    def test_divergence_exits_3_and_leaves_a_latched_verdict(self):
        with Folder() as folder, Folder() as expected_folder:
            expected = run_exercise(expected_folder, 'Euler', '--particles', HORIZONTAL, status=3)
            with PendulumNode(method='Euler', particles=HORIZONTAL, output=folder, at_end='hold') as node:
                wait_until(lambda: len(read_frames(folder)) == len(expected), 'the last good frame')
                time.sleep(0.5)
                status = self.listen('status', PendulumStatus)
                message = status.wait_for_any(lambda m: m.code == PendulumStatus.DIVERGED)
                self.assertIn('diverged at t = ', message.text)
                # All of this is logged when it happens, not at the end of the node. The search for the
                # largest stable step comes between the status and the log.
                wait_until(lambda: 'until Ctrl-C' in node.output(), 'the lines about the divergence')
                for part in ('diverged at t = ', 'particle 11', 'step'):
                    self.assertIn(part, node.lines('ERROR')[0])
                self.assertIn('verdict: diverged', node.lines('INFO')[-2])
                self.assertIn('until Ctrl-C (at_end: hold)', node.lines('INFO')[-1])
                self.assertIn('because the motion diverged', self.call('pause', True, success=False))
                self.assertEqual(len(node.lines('ERROR')), 1, node.output())
                self.call('reset')
                wait_until(lambda: len(node.lines('ERROR')) == 2, 'the same again')
                self.assertEqual(read_frames(folder), expected)
                self.call('set_method', 'Auto')
                self.call('reset')
                wait_until(lambda: len(read_frames(folder)) == 500, 'the frames after those')
                node.stop()
            ended_node(3, method='Euler', particles=HORIZONTAL)

    def test_divergence_changes_the_colour_and_keeps_the_last_good_chain(self):
        markers = self.listen('markers', MarkerArray)
        ended_node(3, method='Euler', particles=HORIZONTAL, wait_for_subscribers=2)
        last = wait_until(lambda: markers.messages and 'diverged' in markers.messages[-1].markers[3].text
                          and markers.messages[-1], 'the verdict')
        springs, good = last.markers[0], markers.messages[-2].markers[0]
        self.assertEqual(springs.points, good.points)
        self.assertEqual(len({(c.r, c.g, c.b) for c in springs.colors}), 1)
        self.assertNotEqual(springs.colors, good.colors)

    def test_warns_of_a_bad_verdict_and_of_an_unstable_step(self):
        node = ended_node(method='Euler', particles=HORIZONTAL, frames=30)
        self.assertTrue(any('Euler: gained energy' in line for line in node.lines('WARN')), node.output())
        node = ended_node(3, method='Euler', particles=HORIZONTAL, time_step=0.5)
        self.assertRegex(node.lines('WARN')[0], r'Euler may be unstable with a time step of 0\.5 s; largest stable '
                                                r'step for Euler: [\d.e-]+ s; or use Auto')

    def test_the_closing_line_says_what_was_done(self):
        node = ended_node(frames=11, particles=HORIZONTAL)
        self.assertEqual(node.lines('WARN'), [])
        for part in ('Runge-Kutta-4: 11 particles, 11 frames, 100 steps, 400 force evaluations',
                     's integrating, 0 marker', 'energy error ', 'verdict: ok'):
            self.assertIn(part, node.lines('INFO')[-1])


class Signals(unittest.TestCase):
    """Without the signal, each of these nodes would run for hours or for ever."""

    def end(self, phase, **parameters):
        """Starts a node, interrupts it when phase(node) is true, and returns its output."""
        ended = {}
        for number in (signal.SIGINT, signal.SIGTERM):
            with case(signal=number), Folder() as folder, \
                    PendulumNode(preexec=ignore_interrupts,
                                 **dict(dict(particles=HORIZONTAL, output=folder), **parameters)) as node:
                wait_until(lambda: phase(node, folder), 'the phase')
                before = computing_time(node.process.pid)
                ended_before = total_computing_time()
                node.interrupt(number)
                self.assertIn(node.wait(), (0, 3), node.output())
                # Computing time, as other programs share the computer. Measured: at most 0.1 s.
                self.assertLess(total_computing_time() - ended_before - before, 1.0, node.output())
                ended[number] = node.output()
        return ended[signal.SIGINT]

    def test_record_bag(self):
        for options in (('--steps-per-frame', '2000000000', '--time-step', '1e-4'),
                        ('--time-step', '1e6', '--steps-per-frame', '1', '--reference', 'always')):
            with case(options=options), Folder() as folder, \
                    running(program('record_bag'), 'Runge-Kutta-4', HORIZONTAL, '--bag', folder + '/run.bag', *options,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                wait_until(lambda: os.path.exists(folder + '/.run.bag.tmp'), 'a bag')
                before = computing_time(process.pid)
                ended_before = total_computing_time()
                process.send_signal(signal.SIGINT)
                errors = process.communicate(timeout=60)[1]
                self.assertIn(process.returncode, (3, 128 + signal.SIGINT), errors)
                self.assertLess(total_computing_time() - ended_before - before, 1.0)

    def test_without_a_master(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with PendulumNode(env=NO_MASTER, preexec=ignore_interrupts) as node:
                wait_until(lambda: 'master' in node.output(), 'a try to find a master')
                node.stop(number)

    def test_a_second_node_that_is_refused_leaves_the_first_alone(self):
        with Folder() as folder, Folder() as other, \
                PendulumNode(output=folder, energy=other + '/e', save_state=other + '/s', frames=100000,
                             real_time_factor=1.0) as first:
            wait_until(lambda: len(read_frames(folder)) > 1, 'frames')
            for parameters in (dict(output=folder), dict(energy=other + '/e'), dict(save_state=other + '/s')):
                self.assertIn('another run is writing here', ended_node(1, **parameters).output())
            ended_node(2, frames=-1)
            ended_node(2, held='99')
            count = len(read_frames(folder))
            wait_until(lambda: len(read_frames(folder)) > count + 5, 'more frames')
            self.assertIsNone(first.process.poll())

    def test_in_every_phase(self):
        def has(text):
            return lambda node, _: text in node.output()

        def wrote(frame):
            return lambda _, folder: os.path.exists(folder + '/frame_%04d.txt' % frame)
        for phase, parameters in (
                (has('waiting for 9 subscribers'), dict(wait_for_subscribers=9, wait_timeout=0)),
                (wrote(3), dict(frames=1000000, real_time_factor=1.0)),
                # Inside a long frame.
                (wrote(0), dict(steps_per_frame=2000000000)), (wrote(0), dict(method='Taylor-8', frame_interval=1e6)),
                # One step takes no time, but the reference run has 1e7 s of motion to compute.
                (wrote(0), dict(time_step=1e7, steps_per_frame=1, reference='always')),
                # After a divergence with many frames.
                (has('diverged'), dict(method='Euler', damping=0, time_step=0.05, frames=1000000000, at_end='hold')),
                (lambda *_: service('pause')(True).success, dict(frames=1000000, real_time_factor=1.0)),
                (has('until Ctrl-C'), dict(frames=3, at_end='hold'))):
            self.assertIn('verdict: ', self.end(phase, **parameters), parameters)
