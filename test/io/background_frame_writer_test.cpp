#include "io/formats/background_frame_writer.hpp"

#include "io/files/frame_folder.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

constexpr int kFrames = 6;

State frame(Eigen::Index size, int index) {
  State state(size);
  state.x().setLinSpaced(0.1 * index, 1.0);
  state.y().setConstant(index / 3.0);
  return state;
}

class BackgroundWriter : public testing::TestWithParam<Eigen::Index> {};

// The frames that its thread writes are in order, complete, and equal those of FrameWriter.
TEST_P(BackgroundWriter, WritesWhatTheFrameWriterWrites) {
  const TemporaryFolder folder;
  FrameWriter plain(folder.path("plain"), kFrames);
  BackgroundFrameWriter background(folder.path("background"), kFrames);
  State state;
  for (int i = 0; i < kFrames; ++i) {
    state = frame(GetParam(), i);
    plain.write(i, state);
    background.write(i, state);
    state.values().setZero();  // the writer has copied the state
  }
  plain.finish();
  background.finish();
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(readFile(folder.path("background/" + frameName(i))),
              readFile(folder.path("plain/" + frameName(i))));
  }
  EXPECT_GT(background.secondsWriting(), 0.0);
}

// Frame 2 can't be renamed to its name, as a folder is in its way.
TEST_P(BackgroundWriter, FailedFrameIsNamedAndNothingIsWrittenAfterIt) {
  const TemporaryFolder folder;
  BackgroundFrameWriter writer(folder.path(), kFrames);
  std::filesystem::create_directory(folder.path(frameName(2)));
  std::string message;
  try {
    for (int i = 0; i < kFrames; ++i) writer.write(i, frame(GetParam(), i));
    writer.finish();
  } catch (const FileError& error) {
    message = error.what();
  }
  EXPECT_THAT(message, testing::HasSubstr(folder.path(frameName(2))));
  EXPECT_TRUE(std::filesystem::exists(folder.path(frameName(1))));
  EXPECT_FALSE(std::filesystem::exists(folder.path(frameName(3))));
}

TEST_P(BackgroundWriter, FailureOfTheLastFrameIsToldByFinish) {
  const TemporaryFolder folder;
  BackgroundFrameWriter writer(folder.path(), 1);
  std::filesystem::create_directory(folder.path(frameName(0)));
  const auto write_and_finish = [&] {
    writer.write(0, frame(GetParam(), 0));
    writer.finish();
  };
  EXPECT_THROW(write_and_finish(), FileError);
}

TEST_P(BackgroundWriter, FrameHandedOverIsWrittenThoughTheRunIsGivenUp) {
  const TemporaryFolder folder;
  { BackgroundFrameWriter(folder.path(), 1).write(0, frame(GetParam(), 0)); }
  EXPECT_TRUE(std::filesystem::exists(folder.path(frameName(0))));
}

INSTANTIATE_TEST_SUITE_P(SmallAndLarge, BackgroundWriter,
                         testing::Values(3, 2 * BackgroundFrameWriter::kLargeFrame));

}  // namespace
}  // namespace spring_pendulum
