"""rviz on a virtual display shows the running node, a replayed bag and the comparison. The tests check
colours in the pictures, and keep the pictures in the folder PENDULUM_PICTURES."""
import math
import os
import re
import signal
import subprocess
import tempfile

import rosbag
import rosgraph
import rospy
from tf2_msgs.msg import TFMessage

from pendulum_process import (HORIZONTAL, SCENE, Folder, NodeTest, PendulumNode, project, run_program, service,
                              standing, wait_until)

WIDTH, HEIGHT = 1280, 800
PICTURES = os.environ.get('PENDULUM_PICTURES', '/tmp')


class Picture:
    """A portable pixmap as rows of (r, g, b)."""

    def __init__(self, data):
        header = re.match(rb'P6\s+(\d+)\s+(\d+)\s+255\s', data)
        self.width, self.height = int(header.group(1)), int(header.group(2))
        self.pixels = data[header.end():]

    def at(self, column, row):
        start = 3 * (row * self.width + column)
        return tuple(self.pixels[start:start + 3])

    def near(self, column, row, condition, radius=6):
        return any(condition(self.at(x, y))
                   for x in range(max(column - radius, 0), min(column + radius + 1, self.width))
                   for y in range(max(row - radius, 0), min(row + radius + 1, self.height)))

    def count(self, condition):
        colors = (self.pixels[i:i + 3] for i in range(0, len(self.pixels), 3))
        return sum(1 for color in colors if condition(color))


def is_yellow(color):
    return color[0] > 170 and color[1] > 140 and color[2] < 0.8 * color[1]


def is_spring(color):
    """Between white and full red."""
    return color[0] > 200 and color[0] >= color[1] - 5 and color[0] >= color[2] - 5


def is_background(color):
    return max(color) < 90


def is_marker(color):
    """Anything but the background."""
    return max(abs(a - b) for a, b in zip(color, (22, 25, 31))) > 4


def is_pale(color):
    """The true motion, or the text of a chain without a colour."""
    return tuple(color) == (105, 108, 114) or min(color) > 200


def is_like(wanted):
    return lambda color: all(abs(a - b) < 30 for a, b in zip(color, wanted))


class Display:
    """A virtual display: with Display() as display."""

    def __enter__(self):
        read_end, write_end = os.pipe()
        self.process = subprocess.Popen(
            ['Xvfb', '-displayfd', str(write_end), '-screen', '0', '%dx%dx24' % (WIDTH, HEIGHT),
             '-nolisten', 'tcp', '-noreset'], pass_fds=[write_end], stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            self.name = ':' + pipe.readline().strip()
        # Mesa's other software renderer compiles with LLVM, and has crashed there as rviz started.
        self.environment = dict(os.environ, DISPLAY=self.name, LIBGL_ALWAYS_SOFTWARE='1',
                                GALLIUM_DRIVER='softpipe', QT_QPA_PLATFORM='xcb')
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def picture(self, name=None):
        data = subprocess.run(['import', '-silent', '-window', 'root', '-depth', '8', 'ppm:-'],
                              env=self.environment, capture_output=True, check=True).stdout
        if name:
            os.makedirs(PICTURES, exist_ok=True)
            subprocess.run(['convert', 'ppm:-', os.path.join(PICTURES, name)], input=data, check=True)
        return Picture(data)


class Viewer:
    """A launch file that shows rviz: with Viewer(display, 'view.launch', ...) as viewer."""
    MOST_STARTS = 3

    def __init__(self, display, file, *arguments):
        self.display = display
        self.command = ['roslaunch', '--wait', '--screen', 'spring_pendulum', file, *arguments]
        self.starts = 0

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(60)

    def start(self):
        self.starts += 1
        self.log = tempfile.TemporaryFile(mode='w+')
        self.process = subprocess.Popen(self.command, env=self.display.environment,
                                        stdout=self.log, stderr=subprocess.STDOUT)

    def look_after(self):
        """A dead rviz, with which roslaunch ends, fails the test at once. Only a crash inside the
        renderer, before rviz has any picture to draw, is none of ours: then it is started again."""
        if self.process.poll() is None:
            return
        self.log.seek(0)
        output = self.log.read()
        crash = re.search(r'process has died \[pid \d+, exit code -\d+, cmd \S*/rviz ', output)
        if not crash or 'OpenGl version' in output or self.starts == self.MOST_STARTS:
            raise AssertionError('rviz ended (start %d):\n%s' % (self.starts, output))
        print('rviz crashed before its first picture, and is started again: ' + crash.group())
        self.start()

    def wait_for_picture(self, name, condition, what):
        def shown():
            self.look_after()
            return condition(self.display.picture())
        try:
            wait_until(shown, what, patience=90)
        finally:
            picture = self.display.picture(name)
        return picture


FOCAL_LENGTH = 0.5 * HEIGHT / math.tan(math.pi / 8)  # pixels: rviz's camera sees 45 degrees


def pixel_of(point, camera):
    """The pixel of a point of the plane, seen from the camera of /tf_static."""
    scale = FOCAL_LENGTH / (point.y - camera.y)
    return round(WIDTH / 2 + scale * (point.x - camera.x)), round(HEIGHT / 2 - scale * (point.z - camera.z))


class Rviz(NodeTest):

    def test_the_running_node_and_the_next_one(self):
        with Display() as display, Viewer(display, 'view.launch', 'rviz_args:=--fullscreen') as viewer:
            self.check_running_node(viewer)
            self.check_next_node(viewer)

    def check_running_node(self, viewer):
        with PendulumNode(method='Euler', frames=500, real_time_factor=2.0, wait_for_subscribers=1) as node:
            cameras = self.listen('/tf_static', TFMessage)
            self.state.wait_for_any(lambda state: state.frame >= 22)
            service('pause')(True)
            state = wait_until(lambda: standing(self.state.messages), 'the pause')
            camera = cameras.wait_for(1)[-1].transforms[0].transform.translation
            pixels = [pixel_of(p, camera) for p in state.positions]
            for x, y in pixels:
                self.assertTrue(0 < x < WIDTH and 0 < y < HEIGHT, ('the whole chain is seen', pixels, state.frame))
            picture = viewer.wait_for_picture(
                'running_node.png', lambda p: all(p.near(*pixel, is_yellow) for pixel in pixels[1:]), 'the chain')
            self.check_chain(picture, pixels)
            self.assertGreater(picture.count(is_yellow), 1000)  # measured: 6556
            self.assertGreater(picture.count(is_pale), 500)  # measured: 3421
            node.stop()

    def check_next_node(self, viewer):
        viewer.wait_for_picture('ended_node.png', lambda p: p.count(is_marker) == 0,
                                'a picture without markers of the node that has ended')
        with PendulumNode(frames=500, real_time_factor=2.0, wait_for_subscribers=2, color='#3fb6ff') as node:
            picture = viewer.wait_for_picture(
                'next_node.png', lambda p: p.count(is_like((63, 182, 255))) > 1000, 'the next chain')
            self.assertEqual(picture.count(is_yellow), 0)
            self.assertEqual(picture.count(is_pale), 0)
            node.stop()

    def check_chain(self, picture, pixels):
        self.assertTrue(picture.near(*pixels[0], is_like((154, 164, 178))), 'the anchor')
        for (x0, y0), (x1, y1) in zip(pixels[1:], pixels[2:]):
            self.assertTrue(picture.near((x0 + x1) // 2, (y0 + y1) // 2, is_spring), 'a spring')
        self.assertTrue(is_background(picture.at(5, 5)))
        self.assertGreater(picture.count(is_background), 0.9 * WIDTH * HEIGHT)

    def test_the_mouse_pulls_the_tip(self):
        with Display() as display, \
                Viewer(display, 'view.launch', 'rviz_args:=--fullscreen') as viewer, \
                PendulumNode(frames=100000, real_time_factor=1.0, wait_for_subscribers=1, at_end='hold',
                             start='at_rest', particles=HORIZONTAL) as node:
            cameras = self.listen('/tf_static', TFMessage)
            cameras.wait_for(1)

            def now():
                return cameras.messages[-1].transforms[0].transform.translation
            rest = self.state.wait_for(2)[-1].positions[-1]

            def mouse(*arguments):
                subprocess.run(['xdotool', *map(str, arguments)], env=display.environment, check=True)
            column, row = pixel_of(rest, now())
            viewer.wait_for_picture('hand_before.png', lambda p: p.near(column, row, is_yellow), 'the tip')

            def grabbed():
                viewer.look_after()
                mouse('mousemove', column, row)
                rospy.sleep(1.0)
                mouse('mousedown', 1)
                for shift in range(0, 161, 20):
                    mouse('mousemove', column + shift, row)
                    rospy.sleep(0.1)
                rospy.sleep(1.0)
                if self.last().positions[-1].x > rest.x + 0.5:
                    return True
                mouse('mousemove', column, row)  # without a handle, the mouse has turned the camera
                mouse('mouseup', 1)
                return False
            wait_until(grabbed, 'the tip follows the mouse', patience=120)
            tip = self.last().positions[-1]
            wanted = tip.x, tip.z
            pixel = pixel_of(tip, now())  # the camera follows a chain that leaves the picture
            self.assertLess(abs(pixel[0] - column - 160), 25)
            self.assertLess(abs(pixel[1] - row), 25)
            display.picture('hand_pulls.png')
            rospy.sleep(0.5)
            tip = self.last().positions[-1]
            self.assertLess(math.hypot(tip.x - wanted[0], tip.z - wanted[1]), 1e-3)
            mouse('mouseup', 1)
            wait_until(lambda: self.last().positions[-1].x < wanted[0] - 0.5, 'the tip swings back')
            self.assertLess(abs(self.last().energy_error), 1e-4)
            node.stop()

    def test_a_replayed_bag_of_any_namespaces(self):
        colors = {'left': (63, 182, 255), 'a/right': (255, 90, 79)}
        with Folder() as folder, Display() as display:
            bag = folder + '/two runs.bag'
            for row, (name, color) in enumerate(colors.items()):
                run_program('record_bag', 'Runge-Kutta-4', '--frames', 60, '--bag', bag, '--particles', SCENE,
                            *(['--append'] if row else []), '--namespace', name, '--gravity', 9 - row,
                            '--color', '#%02x%02x%02x' % color, '--text-row', row + 1)
            with Viewer(display, 'replay.launch', 'bag:=' + bag) as viewer:
                viewer.wait_for_picture(
                    'replayed_bag.png', lambda p: min(p.count(is_like(color)) for color in colors.values()) > 100,
                    'both chains')
            self.assertFalse(rosgraph.Master('/test').hasParam('/use_sim_time'))

    def test_a_film_shows_the_whole_bag_and_tells_its_progress(self):
        with Folder() as folder:
            for run in ('Runge-Kutta-4 --frames 121', 'Euler --frames 3 --append --namespace short'):
                run_program('record_bag', *run.split(), '--particles', SCENE, '--bag', folder + '/a.bag')
            with rosbag.Bag(folder + '/a.bag') as bag, rosbag.Bag(folder + '/b.bag', 'w') as copy:
                for message in bag.read_messages():
                    copy.write(*message)  # and latch nothing
            done, failed = (
                subprocess.run([project('scripts/film.sh'), folder + name, folder + '/a.gif', '--fps', '10', '--slow',
                                '1', '--size', '320x240', *options], capture_output=True, text=True)
                for name, options in (('/a.bag', ()), ('/b.bag', ('--start', '9'))))
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn('film.sh: rviz drew no markers; with --start, /tf_static must be latched', failed.stderr)
            pictures = subprocess.run(['identify', folder + '/a.gif'], capture_output=True, text=True,
                                      check=True).stdout.count('\n')
        self.assertIn('filming 12 s of 12 s', done.stdout)
        self.assertRegex(done.stdout, 'filmed [0-9.]+ of 12 s')
        self.assertGreater(pictures, 110)  # measured: 117

    def test_the_comparison(self):
        colors = {'Euler': (255, 90, 79), 'Runge-Kutta-2': (255, 197, 61), 'Runge-Kutta-4': (63, 182, 255)}
        with Display() as display, Viewer(display, 'compare.launch', 'frames:=600') as viewer:
            def all_shown(picture):
                # The chain of Runge-Kutta-2 hides behind the one of Runge-Kutta-4; its text does not.
                return (picture.count(is_like(colors['Runge-Kutta-4'])) > 150 and
                        picture.count(is_like(colors['Euler'])) > 150 and
                        picture.count(is_like(colors['Runge-Kutta-2'])) > 20)
            viewer.wait_for_picture('comparison.png', all_shown, 'three chains')
