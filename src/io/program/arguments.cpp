#include "io/program/arguments.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <boost/program_options/errors.hpp>
#include <boost/program_options/parsers.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace spring_pendulum {

namespace po = boost::program_options;

namespace {

std::string unknownOption(const std::string& name, const po::options_description& description) {
  std::vector<std::string> known;
  for (const auto& option : description.options()) known.push_back("--" + option->long_name());
  return unknownName("option", name, known);
}

}  // namespace

std::vector<po::option> splitArguments(int argc, const char* const* argv,
                                       const po::options_description& description) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  namespace style = po::command_line_style;
  try {
    std::vector<po::option> options = po::command_line_parser(arguments)
                                          .options(description)
                                          .style(style::unix_style & ~style::allow_guessing)
                                          .run()
                                          .options;
    std::set<std::string> given;
    for (const po::option& option : options) {
      const std::vector<std::string>& tokens = option.original_tokens;
      if (option.string_key.empty()) continue;
      if (!given.insert(option.string_key).second)
        throw InputError(fmt::format("--{}: is given twice", option.string_key));
      if (tokens.size() < 2 || tokens[1].rfind("--", 0) != 0) continue;
      throw InputError(fmt::format("--{}: needs a value, see --help", option.string_key));
    }
    return options;
  } catch (const po::unknown_option& error) {
    throw InputError(unknownOption(error.get_option_name(), description));
  } catch (const po::invalid_command_line_syntax& error) {
    const std::string name = error.get_option_name();
    const std::size_t begin = name.find_first_not_of('-');
    const po::option_description* const option =
        begin < name.size() ? description.find_nothrow(name.substr(begin), false) : nullptr;
    if (option == nullptr) throw InputError(unknownOption(name, description));
    const bool takes_value = option->semantic()->max_tokens() > 0;
    throw InputError(
        fmt::format("{}: {} value, see --help", name, takes_value ? "needs a" : "takes no"));
  } catch (const po::error& error) {
    throw InputError(fmt::format("{}, see --help", error.what()));
  }
}

}  // namespace spring_pendulum
