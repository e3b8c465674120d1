#!/usr/bin/python3
"""Films rviz on a virtual display while the mouse pulls the tip of a chain and lets it go.

Usage: devel/env.sh scripts/film_pull.py OUT.gif
"""
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

PROJECT = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')
sys.path.insert(0, os.path.join(PROJECT, 'test', 'ros'))
with socket.socket() as free:
    free.bind(('127.0.0.1', 0))
    os.environ['ROS_MASTER_URI'] = 'http://127.0.0.1:%d' % free.getsockname()[1]
os.environ['ROS_IP'] = '127.0.0.1'

import rospy  # noqa: E402 (after the address of the master)
import rviz_test  # noqa: E402
from pendulum_process import Listener, PendulumNode, project, wait_until  # noqa: E402
from rviz_test import Display, Viewer, is_yellow, pixel_of  # noqa: E402
from spring_pendulum.msg import PendulumState  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

FPS = 12
PATH = [(-40, -30), (-90, -80), (-130, -140), (-140, -200), (-60, -260), (60, -270), (130, -230)]  # pixels


def film(out):
    rviz_test.WIDTH, rviz_test.HEIGHT = 600, 460
    rviz_test.FOCAL_LENGTH *= 460 / 800
    config = tempfile.NamedTemporaryFile('w', suffix='.rviz')
    with open(project('rviz/pendulum.rviz')) as file:
        config.write(re.sub('Height: .*', 'Height: 460', re.sub('Width: [0-9]*', 'Width: 600', file.read())))
    config.flush()
    with Display() as display, \
            Viewer(display, 'view.launch', 'rviz_args:=--fullscreen', 'config:=' + config.name) as viewer, \
            PendulumNode(frames=100000, real_time_factor=1.0, at_end='hold', start='at_rest', method='Auto',
                         stiffness=400.0, particles=project('data/horizontal_11.txt')):
        state, cameras = Listener('state', PendulumState, keep=2), Listener('/tf_static', TFMessage)

        def mouse(*arguments):
            subprocess.run(['xdotool', *map(str, arguments)], env=display.environment, check=True)

        tip = state.wait_for(2)[-1].positions[-1]
        column, row = pixel_of(tip, cameras.wait_for(1)[-1].transforms[0].transform.translation)
        viewer.wait_for_picture('film_tip.png', lambda p: p.near(column, row, is_yellow), 'the tip at %s' % ((column, row),))
        mouse('mousemove', column + 30, row)
        camera = subprocess.Popen(
            ['ffmpeg', '-v', 'error', '-y', '-f', 'x11grab', '-framerate', str(FPS), '-video_size',
             '600x460', '-i', display.name, '-c:v', 'libx264rgb', '-crf', '0', out + '.mkv'],
            stdin=subprocess.DEVNULL)
        time.sleep(0.3)
        mouse('mousemove', column, row)
        time.sleep(0.2)
        mouse('mousedown', 1)
        before = (0, 0)
        for after in PATH:
            for k in range(1, 11):
                mouse('mousemove', *(round(p + a + (b - a) * k / 10)
                                     for p, a, b in zip((column, row), before, after)))
                time.sleep(0.04)
            before = after
        time.sleep(0.2)
        mouse('mouseup', 1)
        end = state.messages[-1].time + 4.0
        wait_until(lambda: state.messages[-1].time > end, 'the swing', patience=120)
        camera.send_signal(signal.SIGINT)
        camera.wait()
    look = 'fps=%d,split[a][b];[a]palettegen=max_colors=64[p];[b][p]paletteuse=dither=none' % FPS
    subprocess.run(['ffmpeg', '-v', 'error', '-y', '-i', out + '.mkv', '-filter_complex',
                    look + ':diff_mode=rectangle', out], check=True)
    os.remove(out + '.mkv')


if __name__ == '__main__':
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    port = os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]
    master = subprocess.Popen(['rosmaster', '--core', '-p', port], stdout=subprocess.DEVNULL)
    try:
        rospy.init_node('film', disable_signals=True)
        rospy.set_param('/run_id', 'film')  # roslaunch waits for it
        film(os.path.abspath(sys.argv[1]))
    finally:
        master.terminate()
        master.wait()
