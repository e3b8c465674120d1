#!/usr/bin/python3
"""Runs rviz with a configuration that fits the node or bag to be shown.

Usage: view.py CONFIG BAG [arguments of rviz]

BAG is "none", or a bag that will be played. Then rviz shows every topic of markers in it. If the bag
holds no camera transform, which shows the whole scene, the view is set from the markers. Without a bag,
rviz also shows the pendulums that run in namespaces."""
import signal
signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C while Python starts is no reason for a traceback

import contextlib
import math
import os
import re
import sys

import rosbag
import rosgraph
import rospkg
import yaml

CAMERA = 'pendulum_camera'
ASPECT = 1.3
HALF_VIEW = math.pi / 8  # half the field of view of rviz


def marker_topics(bag):
    topics = bag.get_type_and_topic_info()[1]
    return sorted(name for name, info in topics.items() if info.msg_type == 'visualization_msgs/MarkerArray')


def has_camera(bag):
    return any(transform.child_frame_id == CAMERA for _, message, _ in
               bag.read_messages(topics=['/tf_static', 'tf_static']) for transform in message.transforms)


def live_topics():
    """The topics of markers of the running nodes."""
    try:
        topics = dict(rosgraph.Master('/view').getPublishedTopics(''))
    except (OSError, rosgraph.MasterException):
        topics = {}
    return sorted(name for name in topics if name.endswith('/markers') and
                  topics.get(name[:-len('markers')] + 'state') == 'spring_pendulum/PendulumState')


@contextlib.contextmanager
def configuration(path):
    """Around what reads or changes the configuration of rviz in a file: if it is none, the program ends."""
    try:
        yield
    except OSError as error:
        sys.exit('%s: %s' % (path, error.strerror))
    except (AttributeError, LookupError, RecursionError, TypeError, ValueError, yaml.YAMLError):
        sys.exit('%s: is not a configuration of rviz' % path)


def set_displays(config, topics, keep):
    displays = config['Visualization Manager']['Displays']
    template = next((d for d in displays if d['Class'] == 'rviz/MarkerArray'),
                    {'Class': 'rviz/MarkerArray', 'Enabled': True, 'Value': True})
    others = [d for d in displays if keep or d['Class'] != 'rviz/MarkerArray']
    own = os.environ.get('ROS_NAMESPACE', '/')
    known = {rosgraph.names.ns_join(own, d['Marker Topic']) for d in others if 'Marker Topic' in d}
    shown = [dict(template, Name=topic, **{'Marker Topic': topic}) for topic in topics if topic not in known]
    config['Visualization Manager']['Displays'] = others + shown


def view_of(bag, topics):
    """The frame of all points, and a position at which all are visible."""
    points, frame = [], 'world'
    for _, message, _ in bag.read_messages(topics=topics):
        for marker in message.markers:
            if marker.ns == 'grid':
                continue  # reaches beyond the picture
            frame = marker.header.frame_id
            shown = marker.points or [marker.pose.position]
            points += [(p.x, p.z) for p in shown if math.isfinite(p.x + p.z)]
    xs, zs = zip(*points) if points else ((0, 1), (0, 1))
    size = max(max(zs) - min(zs), (max(xs) - min(xs)) / ASPECT)
    return frame, {'X': (min(xs) + max(xs)) / 2, 'Y': -0.5 * 1.4 * size / math.tan(HALF_VIEW),
                   'Z': (min(zs) + max(zs)) / 2 + 0.1 * size}


def set_view(config, frame, position):
    manager = config['Visualization Manager']
    manager.setdefault('Global Options', {})['Fixed Frame'] = frame
    manager.setdefault('Views', {}).setdefault('Current', {}).update(Position=position, Yaw=math.pi / 2)


def adapted(path, bag_path):
    """The path of a configuration with the topics of the bag or of the running nodes."""
    with configuration(path), open(path) as file:
        config = yaml.safe_load(file)
        set_displays(config, [], keep=True)
    view = None
    if bag_path == 'none':
        topics = live_topics()
        if not topics:
            return path
    else:
        with rosbag.Bag(bag_path) as bag:
            topics = marker_topics(bag)
            if not topics:
                sys.exit('%s: contains no markers (visualization_msgs/MarkerArray)' % bag_path)
            if not has_camera(bag):
                view = view_of(bag, topics)
    with configuration(path):
        set_displays(config, topics, keep=bag_path == 'none')
        if view:
            set_view(config, *view)
    # Each rviz has its own.
    node = os.environ.get('ROS_MASTER_URI', '') + os.environ.get('ROS_NAMESPACE', '')
    copy = os.path.join(rospkg.get_ros_home(), 'spring_pendulum_%s.rviz' % re.sub(r'\W+', '_', node))
    os.makedirs(os.path.dirname(copy), exist_ok=True)
    with open(copy, 'w') as file:
        yaml.safe_dump(config, file, sort_keys=False)
    return copy


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    config, bag, *others = sys.argv[1:]
    if not any(os.environ.get(name) for name in ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM')):
        sys.exit('rviz needs a display, and DISPLAY is not set; without one, use rviz:=false')
    try:
        config = adapted(config, bag)
    except (OSError, ValueError, rosbag.ROSBagException) as error:
        sys.exit('%s: %s' % (bag, error))
    try:
        os.execvp('rviz', ['rviz', '-d', config] + [o for o in others if o != '--'])
    except FileNotFoundError:
        sys.exit('rviz is not installed: run scripts/setup.sh rviz, or use rviz:=false')


if __name__ == '__main__':
    main()
