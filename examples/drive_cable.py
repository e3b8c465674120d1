#!/usr/bin/python3
"""Moves the last particle of a cable on a circle of 1 m: roslaunch spring_pendulum pendulum.launch held:=last"""
import math

import rospy
from geometry_msgs.msg import PoseStamped

rospy.init_node('drive_cable')
pose = rospy.Publisher('held_6/pose', PoseStamped, queue_size=1)
while not rospy.is_shutdown():
    message, t = PoseStamped(), rospy.get_time()
    message.header.stamp, message.header.frame_id = rospy.Time.from_sec(t), 'world'
    message.pose.position.x, message.pose.position.z = 3.0 + math.cos(t), -1.0 + math.sin(t)
    message.pose.orientation.w = 1.0
    pose.publish(message)
    rospy.rostime.wallsleep(1.0 / 30.0)
