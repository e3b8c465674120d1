// Tables in the documents agree with the code and with the measured results.
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace spring_pendulum {
namespace {

/// The rows of the first table in a file of the project whose header begins like this.
std::vector<std::string> tableRows(const std::string& path, const std::string& header) {
  std::ifstream file(PROJECT_DIR "/" + path);
  std::string line;
  while (std::getline(file, line) && line.rfind(header, 0) != 0) continue;
  std::getline(file, line);  // the line below the header
  std::vector<std::string> rows;
  while (std::getline(file, line) && line.rfind('|', 0) == 0) rows.push_back(line);
  return rows;
}

TEST(Documents, ShowTheCheapestMethodsThatWereMeasured) {
  const std::string header = "| scene | to 1e-3 m | to 1e-6 m | to 1e-9 m |";
  const auto measured = tableRows("benchmark/results/cheapest_methods.md", header);
  ASSERT_FALSE(measured.empty());
  EXPECT_EQ(tableRows("docs/benchmarks.md", header), measured)
      << "copy the rows from there to docs/benchmarks.md";
}

TEST(Documents, ListTheMethodsOfTheTable) {
  const auto rows = tableRows("docs/methods.md", "| name | order | steps | use |");
  ASSERT_EQ(rows.size(), methodTable().size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Method& method = methodTable()[i];
    // The order of Auto is that of the active method.
    const std::string order = method.name == "Auto" ? "" : fmt::format(" {}", method.order);
    EXPECT_EQ(rows[i], fmt::format("| `{}` |{} | {} | {} |", method.name, order,
                                   method.hasFixedStep() ? "fixed" : "own", method.use));
  }
}

std::string replaced(std::string text, char from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, 1, to);
  return text;
}

std::string textOf(const std::string& path) {
  std::ifstream file(PROJECT_DIR "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Documents, ShowTheExamplesAsTheyAre) {
  EXPECT_THAT(
      textOf("docs/library.md"),
      testing::AllOf(testing::HasSubstr("```cpp\n" + textOf("examples/simulate.cpp") + "```"),
                     testing::HasSubstr("```cpp\n" + textOf("examples/judge.cpp") + "```")));
  const std::string methods = textOf("examples/own_methods.hpp");
  const std::string shown = methods.substr(methods.find("/// Ralston"));
  ASSERT_GT(shown.size(), 500U);
  EXPECT_THAT(textOf("docs/methods.md"), testing::HasSubstr("```cpp\n" + shown + "```"));
}

/// Calls `visit` with every match of `pattern` in `text`.
template <typename Visitor>
void forEachMatch(const std::string& text, const std::string& pattern, const Visitor& visit) {
  const std::regex regex(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    visit(*match);
}

/// "Suite.Test", "ros.bag" and, for whole programs, "io_documents_test".
std::set<std::string> testNames() {
  const std::string folder = "test/";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PROJECT_DIR "/test")) {
    const std::filesystem::path path = entry.path().lexically_relative(PROJECT_DIR "/test");
    const std::string stem = path.stem().string();
    const std::size_t end = stem.rfind("_test");
    if (path.extension() == ".py" && end != std::string::npos)
      names.insert("ros." + stem.substr(0, end));
    if (path.extension() != ".cpp") continue;
    names.insert(replaced(path.parent_path() / path.stem(), '/', "_"));
    forEachMatch(
        textOf(folder + path.string()), R"(TEST(?:_F|_P)?\((\w+),\s*(\w+)\))",
        [&](const std::smatch& match) { names.insert(match.str(1) + '.' + match.str(2)); });
  }
  forEachMatch(textOf("test/ros/CMakeLists.txt"), R"(NAME (ros\.\w+))",
               [&](const std::smatch& match) { names.insert(match.str(1)); });
  return names;
}

TEST(Documents, NameTestsThatExist) {
  const std::set<std::string> names = testNames();
  int found = 0;
  forEachMatch(
      textOf("docs/reliability.md"), R"(`([A-Z][a-z]\w+\.|ros\.[a-z_]+|[a-z]\w+_test)(\w*)(\*?)`)",
      [&](const std::smatch& match) {
        const std::string name = match.str(1) + match.str(2);
        const auto least = names.lower_bound(name);
        const bool exists = least != names.end() &&
                            (match.length(3) == 0 ? *least == name : least->rfind(name, 0) == 0);
        EXPECT_TRUE(exists) << match.str();
        ++found;
      });
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace spring_pendulum
