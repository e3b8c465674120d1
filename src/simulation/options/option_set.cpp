#include "simulation/options/option_set.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace spring_pendulum {

void OptionSet::add(std::vector<Option> options) {
  std::move(options.begin(), options.end(), std::back_inserter(options_));
}

const Option& OptionSet::find(std::string_view key, std::string_view place,
                              std::string_view kind) const {
  std::vector<std::string> known;
  for (const Option& option : options_) {
    if (option.key == key) return option;
    known.emplace_back(option.key);
  }
  const std::string_view separator = place.empty() ? "" : ": ";
  throw InputError(fmt::format("{}{}{}", place, separator, unknownName(kind, key, known)));
}

void OptionSet::set(const Option& option, std::string_view text, const std::string& place) {
  try {
    option.assign(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
  given_[option.key] = place;
}

std::string OptionSet::placeOf(std::string_view key) const {
  const auto given = given_.find(key);
  return given == given_.end() ? "" : given->second;
}

}  // namespace spring_pendulum
