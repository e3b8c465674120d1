// Particle files: what is accepted, and the message for everything that is not.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <support/bad_text.hpp>

namespace spring_pendulum {
namespace {

using test::BadText;

constexpr const char* kPlain = "0 0 1\n1 -0.5 2.5\n";

void expectPlain(const std::string& text) {
  const Scene particles = parseParticles(text, "particle.txt");
  ASSERT_EQ(particles.state.size(), 2) << text;
  EXPECT_EQ(particles.state.x()[0], 0.0);
  EXPECT_EQ(particles.state.x()[1], 1.0);
  EXPECT_EQ(particles.state.y()[1], -0.5);
  EXPECT_EQ(particles.masses[0], 1.0);
  EXPECT_EQ(particles.masses[1], 2.5);
  EXPECT_TRUE(particles.state.velocities().isZero(0.0));
}

TEST(ParticleFile, AcceptsEveryWayToWriteIt) {
  expectPlain(kPlain);
  expectPlain("0 0 1\n1 -0.5 2.5");                            // no newline at the end
  expectPlain("0 0 1\r\n1 -0.5 2.5\r\n");                      // CRLF
  expectPlain("\n0 0 1\n \n\t\n\r\n1 -0.5 2.5\n\n");           // blank lines
  expectPlain("# a scene\n0 0 1 # fixed\n1 -.5 2.5#\n #end");  // comments
  expectPlain("\t0\t0\t1\n  1 \t -5e-1   2.5  \n");            // tabs, spaces around
  expectPlain("+0 +0.0 +1\n+1.0 -0.50 25E-1\n");               // leading +, exponents
}

TEST(ParticleFile, ReadsTheNearestDouble) {
  const Scene particles = parseParticles("0.1 1e-310 1\n1.7976931348623157e100 0.3 5e-300", "");
  EXPECT_EQ(particles.state.x()[0], 0.1);
  EXPECT_EQ(particles.state.y()[0], 1e-310);
  EXPECT_EQ(particles.state.x()[1], 1.7976931348623157e100);
  EXPECT_EQ(particles.masses[1], 5e-300);
}

TEST(ParticleFile, HasNoNegativeZero) {
  const Scene particles = parseParticles("-0 -0.0 1\n1 -1e-400 1", "");
  EXPECT_FALSE(std::signbit(particles.state.x()[0]));
  EXPECT_FALSE(std::signbit(particles.state.y()[0]));
  EXPECT_FALSE(std::signbit(particles.state.y()[1]));
}

TEST(ParticleFile, ReadsVelocities) {
  const State state = parseParticles("0 0 1 0 0 # fixed\n1 0 1 -0.25 1e-3\n", "").state;
  EXPECT_EQ(state.vx()[1], -0.25);
  EXPECT_EQ(state.vy()[1], 1e-3);
  EXPECT_TRUE(state.velocities().row(0).isZero(0.0));
  const State fixed = parseParticles("0 0 1 3 4\n1 0 1 0 -0\n", "").state;
  EXPECT_TRUE(fixed.velocities().isZero(0.0));
  EXPECT_FALSE(std::signbit(fixed.vy()[1]));
}

TEST(ParticleFile, MassOfTheFixedParticleIsFree) {
  EXPECT_EQ(parseParticles("1 2 3", "").state.size(), 1);
  for (const char* mass : {"0", "-1", "1e300"})
    EXPECT_NO_THROW(parseParticles(std::string("0 0 ") + mass + "\n1 0 1", "")) << mass;
}

class ParticleFileRefuses : public testing::TestWithParam<BadText> {};

TEST_P(ParticleFileRefuses, WithOneLineThatTellsWhere) {
  try {
    parseParticles(GetParam().text, "particle.txt");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), GetParam().message);
  }
}

std::string noNumber(const std::string& line, const std::string& word) {
  return "particle.txt:" + line + ": " + word +
         " is not a number; write a finite number such as 0.5 or -2e-3";
}

std::string wrongCount(const std::string& line, const std::string& numbers) {
  return "particle.txt:" + line + ": " + numbers +
         " in this line; a particle needs 3: x y m, or 5: x y m vx vy";
}

std::vector<BadText> wordsThatAreNoNumbers() {
  std::vector<BadText> rows;
  for (const std::string word :
       {"zero", "nan", "1e400", "1.0x", "1;", "-inf", "infinity", "0x10", "+-1", "++1", "+"})
    rows.push_back({"0 0 1\n" + word + " 0 1\n", noNumber("2", "'" + word + "'")});
  return rows;
}

INSTANTIATE_TEST_SUITE_P(BadWords, ParticleFileRefuses, testing::ValuesIn(wordsThatAreNoNumbers()));

const std::string kNoParticles = "particle.txt: no particles; write one line 'x y m' per particle";

INSTANTIATE_TEST_SUITE_P(
    BadRows, ParticleFileRefuses,
    testing::Values(
        BadText{"", kNoParticles}, BadText{"\n# nothing\n\n", kNoParticles},
        BadText{"0 0 1\n1 0\n", wrongCount("2", "2 numbers")},
        BadText{"7", wrongCount("1", "1 number")},
        BadText{"0 0 1\n\n# c\n1 0 1 0\n", wrongCount("4", "4 numbers")},
        BadText{"0 0 1\n1 0 1 0 0 0\n", wrongCount("2", "6 numbers")},
        BadText{
            "0 0 1\n\n1 0 1 0 0\n",
            "particle.txt:3: has a velocity, but the particle in line 1 has none; give vx vy for "
            "all particles or for none"},
        BadText{
            "0 0 1 0 0\n1 0 1\n",
            "particle.txt:2: has no velocity, but the particle in line 1 has one; give vx vy for "
            "all particles or for none"},
        BadText{"0 0 1 0 0\n1 0 1 0 nan\n", noNumber("2", "'nan'")},
        BadText{"0 0 1\n1,5 0 1\n",
                "particle.txt:2: '1,5' is not a number; use a decimal point, and spaces between "
                "numbers"},
        BadText{std::string("0 0 1\n1\0 0 1\n", 13), noNumber("2", "'1?'")},
        BadText{"0 0 1\r1 0 1", noNumber("1", "'1?1'")},
        BadText{"0 0 " + std::string(1000, 'm'),
                noNumber("1", "'" + std::string(40, 'm') + "...'")},
        BadText{"0 0 1\n1 0 1\v\n", noNumber("2", "'1?'")},
        BadText{"0 0 1\n1 0 0\n", "particle.txt:2: mass must be positive, got 0 kg"},
        BadText{"0 0 1\n1 0 -0\n", "particle.txt:2: mass must be positive, got 0 kg"},
        BadText{"0 0 1\n1 0 -2\n", "particle.txt:2: mass must be positive, got -2 kg"},
        BadText{"0 0 1\n1 0 1e-310\n",
                "particle.txt:2: mass must be large enough for 1/mass to be finite, got 1e-310 kg"},
        BadText{"0 0 1\n\n0 -0 1\n",
                "particle.txt:3: same position as the particle in line 1; neighbours must not "
                "coincide"},
        BadText{"0 0 1\n1e-170 0 1\n",
                "particle.txt:2: same position as the particle in line 1; neighbours must not "
                "coincide"},
        BadText{"0 0 1\n1e200 0 1\n",
                "particle.txt:2: too far from the particle in line 1; the square of their "
                "distance must be finite"}));

TEST(ParticleFile, TwoParticlesThatAreNoNeighboursMayShareAPlace) {
  EXPECT_EQ(parseParticles("0 0 1\n1 0 1\n0 0 1\n", "").state.size(), 3);
}

}  // namespace
}  // namespace spring_pendulum
