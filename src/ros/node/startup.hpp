// Starts ROS for a program with private parameters.
#pragma once

#include <string>

namespace spring_pendulum {

/// Checks the arguments and initialises ROS, which takes the arguments with ":=" away. From then on
/// SIGINT ends the program even if it was ignored, as in a job that a script starts with `&`, and
/// the log keeps UTF-8.
/// \returns the text to print instead of a run: --help; else empty
/// \throws InputError if the master's address or the node's name is invalid, if a parameter lacks
///   its underscore, or if another argument is given
/// \throws FileError if ROS cannot create its log folder
std::string startRos(int argc, char** argv);

}  // namespace spring_pendulum
