#!/usr/bin/python3
"""Runs the tests of NAME_test.py in a node of this name: rostest_runner.py NAME. rostest starts it with a master."""
import importlib
import sys

import rospy
import rostest

name = sys.argv[1]
importlib.import_module(name + '_test')  # sets parameters that the node needs
rospy.init_node(name + '_test', disable_signals=True)
rostest.rosrun('spring_pendulum', name, name + '_test')
