# What only a build with ROS has.
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES spring_pendulum
  DEPENDS EIGEN3
  CFG_EXTRAS spring_pendulum-extras.cmake)
