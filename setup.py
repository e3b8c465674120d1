"""The Python package, for catkin_python_setup(). CMake builds and installs it: python/CMakeLists.txt."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['spring_pendulum'], package_dir={'': 'python'}))
