// Splits a command line, with the same messages in all programs.
#pragma once

#include <boost/program_options/option.hpp>
#include <boost/program_options/options_description.hpp>

#include <vector>

namespace spring_pendulum {

/// Returns the arguments in their order; one without a name is positional.
/// \param argv the name of the program and its arguments
/// \throws InputError for an unknown option, with the one that was probably meant, or a missing value
std::vector<boost::program_options::option> splitArguments(
    int argc, const char* const* argv,
    const boost::program_options::options_description& description);

}  // namespace spring_pendulum
