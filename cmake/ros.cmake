# What only a build with ROS has: the messages, and how other packages find this one. The ROS
# library and its executables follow in src/ros/CMakeLists.txt.
find_package(catkin REQUIRED COMPONENTS geometry_msgs interactive_markers message_generation
  nav_msgs rosbag_storage roscpp rosgraph_msgs std_msgs std_srvs tf2 tf2_msgs visualization_msgs)

# The module and the messages are one Python package. catkin would install it with setup.py into the prefix of
# the configuration; python/CMakeLists.txt installs it instead.
if(pybind11_FOUND)
  catkin_python_setup()
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/catkin_generated/safe_execute_install.cmake "")
endif()
add_message_files(FILES PendulumInput.msg PendulumState.msg PendulumStatus.msg)
add_service_files(FILES ApplyForce.srv Set.srv SetMethod.srv StatePath.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES spring_pendulum
  CATKIN_DEPENDS geometry_msgs message_runtime std_msgs
  DEPENDS EIGEN3
  CFG_EXTRAS spring_pendulum-extras.cmake)
