#include "io/program/arguments.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <boost/program_options/errors.hpp>
#include <boost/program_options/parsers.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace spring_pendulum {

namespace po = boost::program_options;

std::vector<po::option> splitArguments(int argc, const char* const* argv,
                                       const po::options_description& description) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  namespace style = po::command_line_style;
  try {
    const std::vector<po::option> options = po::command_line_parser(arguments)
                                                .options(description)
                                                .style(style::unix_style & ~style::allow_guessing)
                                                .run()
                                                .options;
    for (const po::option& option : options) {
      const std::vector<std::string>& tokens = option.original_tokens;
      if (option.string_key.empty() || tokens.size() < 2 || tokens[1].rfind("--", 0) != 0) continue;
      throw InputError(fmt::format("--{}: needs a value, see --help", option.string_key));
    }
    return options;
  } catch (const po::unknown_option& error) {
    std::vector<std::string> known;
    for (const auto& option : description.options()) known.push_back("--" + option->long_name());
    throw InputError(unknownName("option", error.get_option_name(), known));
  } catch (const po::invalid_command_line_syntax& error) {
    const bool lacks_value = error.kind() == po::invalid_syntax::missing_parameter ||
                             error.kind() == po::invalid_syntax::empty_adjacent_parameter;
    if (!lacks_value) throw InputError(error.what());
    throw InputError(fmt::format("{}: needs a value, see --help", error.get_option_name()));
  } catch (const po::error& error) {
    throw InputError(fmt::format("{}, see --help", error.what()));
  }
}

}  // namespace spring_pendulum
