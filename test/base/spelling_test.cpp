// Suggestions for misspelt names.
#include "base/spelling.hpp"

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace spring_pendulum {
namespace {

TEST(Spelling, FindsTheMethodThatWasMeant) {
  std::vector<std::string> methods;
  for (const Method& method : methodTable()) methods.push_back(method.name);
  const std::pair<const char*, const char*> rows[] = {
      {"euler", "Euler"},
      {"Oiler", "Euler"},
      {"RK4", "Runge-Kutta-4"},
      {"rk2", "Runge-Kutta-2"},
      {"RungeKutta4", "Runge-Kutta-4"},
      {"Runge_Kutta_2", "Runge-Kutta-2"},
      {"runge kuta 4", "Runge-Kutta-4"},
      {"verlet", "Velocity-Verlet"},
      {"dopri5", "Dormand-Prince-5"},
      {"radau", "Radau-9"},
      {"SemiImplicitEuler", "Semi-Implicit-Euler"},
      {"auto", "Auto"},
      {"Runge-Kutta-5", ""},  // as near to 2 as to 4
      {"Taylor", "Taylor-8"},
      {"Leapfrog", ""},
      {"4", ""},
      {"", ""},
  };
  for (const auto& [given, meant] : rows) EXPECT_EQ(closestName(given, methods), meant) << given;
}

TEST(Spelling, MethodsAreFoundInAnyCase) {
  for (const Method& method : methodTable()) {
    std::string name = method.name;
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
      return c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    });
    EXPECT_EQ(&findMethod(name), &method) << name;
  }
}

TEST(Spelling, MethodsOfOtherProgramsHaveANearestOne) {
  const std::pair<const char*, const char*> rows[] = {{"DOP853", "Taylor-8"},
                                                      {"verlet", "Velocity-Verlet"},
                                                      {"leapfrog", "Velocity-Verlet"},
                                                      {"heun", "Runge-Kutta-2"},
                                                      {"lsoda", "Auto"}};
  for (const auto& [given, nearest] : rows) {
    try {
      findMethod(given);
      ADD_FAILURE() << given;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("did you mean '" + std::string(nearest) + "'"));
    }
  }
}

TEST(Spelling, QuotesOnOneLine) {
  EXPECT_EQ(inQuotes("a\tb\nc\x7f"), "'a?b?c?'");
  EXPECT_EQ(inQuotes(std::string(40, 'x')), "'" + std::string(40, 'x') + "'");
  EXPECT_EQ(inQuotes(std::string(41, 'x')), "'" + std::string(40, 'x') + "...'");
  EXPECT_EQ(inQuotes(std::string(39, 'x') + "²x"), "'" + std::string(39, 'x') + "...'");
}

TEST(Spelling, PrintsNoByteThatIsNotUtf8) {
  EXPECT_EQ(onOneLine("g = 9.81 m/s², jörg, 重力, 🙂"),
            "g = 9.81 m/s², jörg, 重力, 🙂");
  EXPECT_EQ(onOneLine("\xff\xfe"
                      "0"),
            "??0");                                       // UTF-16
  EXPECT_EQ(onOneLine("j\xf6rg"), "j?rg");                // Latin-1
  EXPECT_EQ(onOneLine("\xc0\xaf\xe0\x80\x80"), "?????");  // too many bytes
  EXPECT_EQ(onOneLine("\xed\xa0\x80"), "???");            // a surrogate
  EXPECT_EQ(onOneLine("\xf4\x90\x80\x80"), "????");       // beyond the last character
  EXPECT_EQ(onOneLine("a\xe9\x87"), "a??");               // cut off
}

TEST(Spelling, TellsTheKnownNames) {
  EXPECT_EQ(unknownName("key", "framse", {"frames", "sleep"}),
            "unknown key 'framse'; did you mean 'frames'? Known keys: frames, sleep");
  EXPECT_EQ(unknownName("key", "mass", {"x", "y"}), "unknown key 'mass'; known keys: x, y");
  EXPECT_LT(unknownName("key", std::string(100000, 'x'), {"frames"}).size(), 100U);
}

}  // namespace
}  // namespace spring_pendulum
