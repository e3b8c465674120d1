// Signals that end a run.
#include "io/program/program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <unistd.h>

namespace spring_pendulum {
namespace {

TEST(Interruption, IsRecordedOnceIfSignalsComeTogether) {
  EXPECT_EXIT(
      {
        static int calls = 0;
        catchInterruptions([] { ++calls; });
        for (const int signal_number : {SIGHUP, SIGHUP, SIGTERM, SIGINT}) raise(signal_number);
        exit(calls == 1 ? interruption() : 99);
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

}  // namespace
}  // namespace spring_pendulum
