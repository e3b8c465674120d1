// animate_pendulum.plt animates any folder of frames at the true speed.
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

constexpr const char* kData = PROJECT_DIR "/data";
constexpr const char* kScript = PROJECT_DIR "/data/animate_pendulum.plt";

/// For each picture of a GIF, how long it is shown, in hundredths of a second: the bytes 4 and 5 of
/// its graphic control extension, 21 F9 04 (GIF89a specification, section 23).
std::vector<int> delaysOf(const std::string& gif) {
  std::vector<int> delays;
  const std::string start("\x21\xF9\x04", 3);
  for (std::size_t at = gif.find(start); at != std::string::npos; at = gif.find(start, at + 1)) {
    if (at + 7 >= gif.size() || gif[at + 7] != 0) continue;  // not one: it ends with a 0
    delays.push_back(static_cast<unsigned char>(gif[at + 4]) +
                     256 * static_cast<unsigned char>(gif[at + 5]));
  }
  return delays;
}

class Animation : public Exercise3Test {
 protected:
  void makeFrames(int frames) const {
    ASSERT_EQ(runWith("Euler --frames " + std::to_string(frames)).status, 0);
  }

  /// Loads the script of a path after other commands.
  Result load(const std::string& path = kScript, const std::string& commands = "") const {
    return run({{"env", "LC_ALL=de_DE.UTF-8", "gnuplot", "-e", commands + "load \"" + path + "\""},
                folder_.path()});
  }

  std::vector<int> delays() const { return delaysOf(read("pendulum.gif")); }
};

TEST_F(Animation, LoadsByBothSpellingsFromTheFolderOrElsewhere) {
  makeFrames(3);
  const std::vector<std::string> spellings{"animate_pendulum.plt", "animate pendulum.plt"};
  std::vector<std::string> paths = spellings;
  for (const std::string& name : spellings) {
    paths.push_back(std::string(kData) + "/" + name);
    std::filesystem::copy_file(paths.back(), folder_.path(name));
  }
  for (const std::string& path : paths) {
    const Result result = load(path);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(delays(), std::vector<int>(3, 10)) << path;  // 0.1 s
    std::filesystem::remove(folder_.path("pendulum.gif"));
  }
}

TEST_F(Animation, RunsAtTheTrueSpeed) {
  makeFrames(12);
  const auto delays_at = [&](const std::string& interval) {
    const Result result = load(kScript, "frame_interval = " + interval + "; ");
    EXPECT_EQ(result.status, 0) << result.errors;
    return delays();
  };
  EXPECT_EQ(delays_at("1.5"), std::vector<int>(12, 150));
  EXPECT_EQ(delays_at("0.02"), std::vector<int>(12, 2));
  EXPECT_EQ(delays_at("0.01"), std::vector<int>(6, 2));       // every second one
  EXPECT_EQ(delays_at("1.0 / 30"), std::vector<int>(4, 10));  // every third one
}

TEST_F(Animation, TakesAnyScene) {
  for (const char* particles : {"1e-9 0 1\n", "3 4 1\n3 3 1\n", "-1e6 0 1\n-1e6 1 1\n"}) {
    folder_.write("particle.txt", particles);
    makeFrames(2);
    folder_.write("frame_notes.txt", "no frame\n");
    const Result result = load();
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(delays().size(), 2U) << particles;
  }
}

/// Width and height in pixels: bytes 6 to 9 of the header.
std::pair<int, int> sizeOf(const std::string& gif) {
  const auto number = [&gif](std::size_t at) {
    return static_cast<unsigned char>(gif[at]) + 256 * static_cast<unsigned char>(gif[at + 1]);
  };
  return {number(6), number(8)};
}

TEST_F(Animation, ShowsTheMotionBeforeADivergence) {
  // A chain that swings in a box of 1 m by 0.5 m and then explodes: cropped to the box.
  for (int n = 0; n < 8; ++n) {
    const std::string far = n < 6 ? "0.5" : "1e9";
    folder_.write(fmt::format("frame_{:04}.txt", n), "0 0\r\n1 " + far + "\r\n");
  }
  const Result result = load();
  EXPECT_EQ(result.status, 0) << result.errors;
  const auto [width, height] = sizeOf(read("pendulum.gif"));
  EXPECT_EQ(width, 480 + 70);
  EXPECT_EQ(height, 240 + 75);
}

TEST_F(Animation, IsWholeOrLeavesTheEarlierOne) {
  makeFrames(5);
  std::filesystem::remove(folder_.path("frame_0000.txt"));
  EXPECT_TRUE(load().status == 0 && delays().size() == 4U);
  const std::string earlier = read("pendulum.gif");
  const std::string limited =
      fmt::format("trap '' XFSZ; ulimit -f 5; gnuplot -e 'load \"{}\"'", kScript);
  Result result = run({{"bash", "-c", limited}, folder_.path()});
  EXPECT_TRUE(result.status != 0 && read("pendulum.gif") == earlier);
  EXPECT_THAT(result.errors, HasSubstr("could not be written"));
  std::filesystem::remove(folder_.path("frame_0002.txt"));
  EXPECT_THAT(load().errors, HasSubstr("are missing"));
}

TEST_F(Animation, TellsWhenThereAreNoFrames) {
  const Result result = load();
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.errors, HasSubstr("run gnuplot in the folder of the frames"));
  EXPECT_THAT(list(), testing::ElementsAre("particle.txt"));
}

}  // namespace
}  // namespace spring_pendulum
