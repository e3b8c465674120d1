// Signals that end a run.
#include "io/program/interruption.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <unistd.h>

namespace spring_pendulum {
namespace {

TEST(Interruption, IsRecordedOnceIfSignalsComeTogether) {
  EXPECT_EXIT(
      {
        catchInterruptions();
        for (const int signal_number : {SIGHUP, SIGHUP, SIGTERM, SIGINT}) raise(signal_number);
        exit(interruption());
      },
      testing::ExitedWithCode(SIGHUP), "");
}

TEST(Interruption, EndsTheProgramTheSecondTime) {
  for (const int second : {SIGINT, SIGTERM}) {
    EXPECT_EXIT(
        {
          catchInterruptions();
          raise(SIGINT);
          usleep(600'000);
          raise(second);
          exit(0);
        },
        testing::KilledBySignal(second), "");
  }
}

TEST(Interruption, CallsTheActionOnce) {
  EXPECT_EXIT(
      {
        static int calls = 0;
        catchInterruptions([] { ++calls; });
        raise(SIGTERM);
        raise(SIGTERM);
        exit(calls == 1 ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace spring_pendulum
