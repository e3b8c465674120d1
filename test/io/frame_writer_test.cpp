// Frame files: their names and numbers, and what happens when one cannot be written.
#include "io/formats/frame_writer.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

TEST(FrameWriter, NamesGrowAboveFourDigits) {
  EXPECT_EQ(frameName(0), "frame_0000.txt");
  EXPECT_EQ(frameName(42), "frame_0042.txt");
  EXPECT_EQ(frameName(9999), "frame_9999.txt");
  EXPECT_EQ(frameName(10000), "frame_10000.txt");
}

std::string textOfFrame(const State& state) {
  const TemporaryFolder folder;
  FrameWriter writer(folder.path());
  writer.write(0, state);
  writer.finish();
  return readFile(folder.path("frame_0000.txt"));
}

TEST(FrameWriter, WritesTheFewestDigits) {
  State state(4);
  state.x() << 0.0, 0.1, -1.0 / 3.0, 1e-7;
  state.y() << -2.0, 123456.75, 5e-324, -1.7976931348623157e308;
  EXPECT_EQ(textOfFrame(state),
            "0 -2\n0.1 123456.75\n-0.3333333333333333 5e-324\n1e-07 -1.7976931348623157e+308\n");
}

/// Frames of a few particles are written at once, large ones in a thread.
class FrameWriterThread : public testing::TestWithParam<Eigen::Index> {
 protected:
  static constexpr int kFrames = 6;

  static State frame(int index) {
    State state(GetParam());
    state.x().setLinSpaced(0.1 * index, 1.0);
    state.y().setConstant(index / 3.0);
    return state;
  }

  TemporaryFolder folder_;
};

TEST_P(FrameWriterThread, WritesFramesInOrder) {
  FrameWriter writer(folder_.path());
  for (int i = 0; i < kFrames; ++i) {
    State state = frame(i);
    writer.write(i, state);
    state.values().setZero();  // the writer has copied the state
  }
  writer.finish();
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(readFile(folder_.path(frameName(i))), textOfFrame(frame(i)));
  }
  EXPECT_GT(writer.seconds(), 0.0);
}

// A frame can't be renamed to its name, as a folder is in its way.
TEST_P(FrameWriterThread, FailedFrameIsNamedAndNothingIsWrittenAfterIt) {
  for (const int failed : {2, kFrames - 1}) {
    const TemporaryFolder folder;
    FrameWriter writer(folder.path());
    std::filesystem::create_directory(folder.path(frameName(failed)));
    std::string message;
    try {
      for (int i = 0; i < kFrames; ++i) writer.write(i, frame(i));
      writer.finish();
    } catch (const FileError& error) {
      message = error.what();
    }
    EXPECT_THAT(message, testing::HasSubstr(folder.path(frameName(failed))));
    EXPECT_TRUE(std::filesystem::exists(folder.path(frameName(failed - 1))));
    EXPECT_FALSE(std::filesystem::exists(folder.path(frameName(failed + 1))));
  }
}

INSTANTIATE_TEST_SUITE_P(SmallAndLarge, FrameWriterThread, testing::Values(3, 2000));

}  // namespace
}  // namespace spring_pendulum
