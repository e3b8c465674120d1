// Numbers from text: both parsers give the same bits and refuse the same texts. Numbers to text: the
// same characters with every release of {fmt}.
#include "base/numbers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <utility>

namespace spring_pendulum {
namespace {

bool sameBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

TEST(Numbers, AreRoundedToTheNearestDouble) {
  const std::pair<const char*, double> rows[] = {
      {"1", 1.0},
      {"+4", 4.0},
      {"-2.5e-3", -2.5e-3},
      {".5", 0.5},
      {"5.", 5.0},
      {"1E+2", 100.0},
      {"-0", -0.0},
      {"1e-400", 0.0},
      {"-1e-400", -0.0},
      {"4.9406564584124654e-324", std::numeric_limits<double>::denorm_min()},
      {"1.7976931348623157e308", std::numeric_limits<double>::max()},
      {"9007199254740993", 9007199254740992.0},  // halfway: to even
      {"9007199254740993.00000000000000000000000000000000000000000000001", 9007199254740994.0}};
  for (const auto& [text, value] : rows) {
    ASSERT_TRUE(parseNumber(text)) << text;
    EXPECT_TRUE(sameBits(*parseNumber(text), value)) << text;
    ASSERT_TRUE(parseNumberPortably(text)) << text;
    EXPECT_TRUE(sameBits(*parseNumberPortably(text), value)) << text;
  }
}

TEST(Numbers, AreNothingElse) {
  for (const char* text :
       {"",    " ",    "1 ",       " 1",    "+",      "-",     "+-1", "-+1",   "++1",
        ".",   "e5",   "1e",       "1e+",   "1x",     "0x10",  "0,5", "1e5.0", "nan",
        "inf", "-inf", "infinity", "1e999", "-1e999", "1_000", "--1", "1e--5"}) {
    EXPECT_FALSE(parseNumber(text)) << text;
    EXPECT_FALSE(parseNumberPortably(text)) << text;
  }
}

TEST(Numbers, AreTheSameWithBothParsers) {
  std::mt19937_64 random(1);
  int numbers = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(double));
    std::string text = fmt::format("{}", value);
    if (i % 2 == 1) text[random() % text.size()] = "0123456789.e+-"[random() % 14];  // may be wrong
    const auto one = parseNumber(text), other = parseNumberPortably(text);
    ASSERT_EQ(one.has_value(), other.has_value()) << text;
    if (!one) continue;
    ++numbers;
    ASSERT_TRUE(sameBits(*one, *other)) << text;
    EXPECT_TRUE(i % 2 == 1 || sameBits(*one, value)) << text;
  }
  EXPECT_GT(numbers, 80000);  // 94,000 or so
}

TEST(Numbers, AreWrittenWithTheFewestCharacters) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::pair<double, const char*> rows[] = {
      {0.0, "0"},         {-0.0, "-0"},
      {2.0, "2"},         {-10.0, "-10"},
      {0.1, "0.1"},       {1e-4, "0.0001"},
      {1e-5, "1e-05"},    {1e15, "1000000000000000"},
      {1e16, "1e+16"},    {9007199254740993.0, "9007199254740992"},
      {5e-324, "5e-324"}, {-1.7976931348623157e308, "-1.7976931348623157e+308"},
      {infinity, "inf"},  {std::nan(""), "nan"}};
  for (const auto& [value, text] : rows) EXPECT_EQ(numberText(value), text);
}

TEST(Numbers, AreRoundedToAFewDigits) {
  const std::tuple<double, int, const char*> rows[] = {
      {0.000177, 2, "0.00018"}, {0.00026, 1, "0.0003"},
      {0.0095, 1, "0.009"},     {0.0995, 2, "0.1"},
      {9.96, 2, "10"},          {151.0, 2, "150"},
      {-3.14159, 2, "-3.1"},    {2.46e-9, 2, "2.5e-09"},
      {1.46e5, 2, "1.5e+05"},   {0.0, 2, "0"},
      {std::nan(""), 2, "nan"}, {std::numeric_limits<double>::infinity(), 1, "inf"}};
  for (const auto& [value, digits, text] : rows) EXPECT_EQ(roundedText(value, digits), text);
}

TEST(Numbers, AreWrittenTheSameEverywhere) {
  std::mt19937_64 random(1);
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(double));
    if (!std::isfinite(value)) continue;
    const std::string text = numberText(value);
    ASSERT_TRUE(sameBits(*parseNumber(text), value)) << text;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  EXPECT_EQ(hash, 16683278571705022989U);
}

TEST(Numbers, TimesHaveThreeSignificantDigits) {
  const std::pair<double, const char*> rows[] = {
      {0.0, "0 ms"},          {4.2e-6, "0 ms"},   {4.2e-5, "0.04 ms"}, {1.2345e-3, "1.23 ms"},
      {0.0123456, "12.3 ms"}, {0.9994, "999 ms"}, {0.9996, "1 s"},     {1.2345, "1.23 s"},
      {59.96, "60 s"},        {99.96, "100 s"},   {1234.5, "1234 s"},
  };
  for (const auto& [seconds, text] : rows) EXPECT_EQ(durationText(seconds), text) << seconds;
}

}  // namespace
}  // namespace spring_pendulum
