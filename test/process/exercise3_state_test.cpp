// Runs that save their state and runs that go on from it.
#include <spring_pendulum/integration/method_table.hpp>

#include <csignal>
#include <sstream>
#include <utility>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

class Exercise3State : public Exercise3Test {
 protected:
  Exercise3State() : Exercise3Test(chainOf(50, "0.1")) {}

  /// Runs 6 of 12 frames and saves their state.
  void save(const std::string& method, const std::string& more = "") const {
    ASSERT_EQ(runWith(method + " -o parts --frames 6 --save-state state.txt " + more).errors, "");
  }
  Result resume(const std::string& method, const std::string& more = "") const {
    return runWith(method + " state.txt -o parts --frames 12 --resume " + more);
  }

  /// Expects the line of an error and that no frame is touched.
  void expectRefused(const std::string& text, const std::string& message) const {
    folder_.write("state.txt", text);
    const Result result = resume("Runge-Kutta-4");
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.errors, HasSubstr(message));
    expectOneLine(result.errors);
    EXPECT_EQ(list("parts").size(), 6u);
  }
};

/// Frame, time and energies of each row. The dissipated energy counts from the start of a run.
std::string energiesIn(const std::string& csv) {
  std::istringstream rows(csv);
  std::string result;
  for (std::string row; std::getline(rows, row);) {
    std::size_t end = 0;
    for (int column = 0; column < 6; ++column) end = row.find(',', end) + 1;
    result += row.substr(0, end) + '\n';
  }
  return result;
}

TEST_F(Exercise3State, OutputsOfTwoFixedStepRunsAreThoseOfOne) {
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    for (const std::string damping : {"0", "1"}) {
      const std::string options = " --time-step 0.001 --damping " + damping;
      EXPECT_EQ(runWith(method.name + options + " -o whole --frames 12 --energy whole/e.csv " +
                        "--save-state whole/state")
                    .status,
                0);
      save(method.name, options + " --energy parts/e.csv");
      EXPECT_EQ(
          resume(method.name, options + " --energy parts/e.csv --save-state parts/state").status,
          0);
      ASSERT_EQ(list("parts"), list("whole"));
      ASSERT_EQ(list("parts").size(), 14U);
      for (const std::string& name : list("whole")) {
        const std::string expected = read("whole/" + name), text = read("parts/" + name);
        EXPECT_TRUE(name == "e.csv" ? energiesIn(text) == energiesIn(expected) : text == expected)
            << method.name << ' ' << name << '\n'
            << text;
      }
    }
  }
}

TEST_F(Exercise3State, AdviceAndBalanceAreForTheFramesThatAreLeft) {
  std::string said;
  for (const int frame : {10, 1000000}) {
    folder_.write("state.txt", "# state of 2 particles at frame " + std::to_string(frame) +
                                   ", t = " + std::to_string(frame / 10) +
                                   " s\n0 0 1 0 0\n1 0 1 0 0\n");
    const std::string frames =
        " state.txt --resume --no-frames --frames " + std::to_string(frame + 20);
    const Result stiff = runWith("Euler --stiffness 2000" + frames);
    EXPECT_EQ(stiff.status, 3);
    EXPECT_THAT(runWith("Backward-Euler --damping 1" + frames).output,
                Not(HasSubstr("not checked")));
    const std::string advice = stiff.errors.substr(stiff.errors.find("largest stable step"));
    EXPECT_EQ(std::exchange(said, advice), frame == 10 ? "" : advice);
  }
}

TEST_F(Exercise3State, NeighboursMayBeInOnePlace) {
  folder_.write("state.txt",
                "# state of 3 particles at frame 5, t = 0.5 s\n"
                "0 0 1 0 0\n1 0 1 0 0\n1 3e-163 1 1 0\n");
  EXPECT_EQ(resume("Runge-Kutta-4").errors, "");
}

TEST_F(Exercise3State, ErrorControlledRunsGoOnWithinTheTolerance) {
  ASSERT_EQ(runWith("Auto -o whole --frames 12").errors, "");
  save("Auto");
  ASSERT_EQ(resume("Auto").errors, "");
  std::istringstream whole(read("whole/frame_0011.txt"));
  std::istringstream parts(read("parts/frame_0011.txt"));
  double a = 0.0, b = 0.0;
  while (whole >> a && parts >> b) EXPECT_NEAR(a, b, 1e-6);  // 2e-8
}

TEST_F(Exercise3State, SavesEveryDigitWithTheFrameAndItsTime) {
  save("Runge-Kutta-4", "--energy first.csv");
  const std::string state = read("state.txt");
  EXPECT_EQ(state.substr(0, state.find('\n')), "# state of 50 particles at frame 5, t = 0.5 s");
  EXPECT_EQ(resume("Runge-Kutta-4", "--energy second.csv --save-state again.txt").status, 0);
  EXPECT_THAT(read("first.csv"), HasSubstr("\n5,0.5,"));
  EXPECT_THAT(read("second.csv"), HasSubstr("\n5,0.5,"));
  EXPECT_THAT(read("second.csv"), HasSubstr("\n11,1.1,"));
  // A run that starts where it ends writes the state that it reads.
  runWith("Runge-Kutta-4 again.txt --resume --frames 12 --no-frames --save-state copy.txt");
  EXPECT_EQ(read("copy.txt"), read("again.txt"));
  folder_.write("second.csv", "frame;time [s];kinetic [J]\n5;0.5;1\n");  // from a spreadsheet
  EXPECT_EQ(resume("Runge-Kutta-4", "--energy second.csv").status, 2);
}

TEST_F(Exercise3State, ASignalSavesTheLastFrame) {
  Process process(
      command("Runge-Kutta-4 -o parts --frames 1000000 --steps-per-frame 1000 --time-step 1e-4 "
              "--save-state state.txt"));
  process.waitForFile(path("parts/frame_0002.txt"));
  process.sendSignal(SIGINT);
  EXPECT_EQ(process.wait().status, 128 + SIGINT);
  const std::string frame = std::to_string(std::stoi(list("parts").back().substr(6)));
  EXPECT_THAT(read("state.txt"), testing::HasSubstr(" at frame " + frame + ","));
}

TEST_F(Exercise3State, RefusesStatesThatDoNotFit) {
  save("Runge-Kutta-4");
  const std::string state = read("state.txt");
  const std::string head = "state.txt:1: must be '# state of N particles at frame N, t = X s'";
  expectRefused(chainOf(50), head);
  expectRefused("\n" + state, head);
  expectRefused("# state of 50 particles at frame -5, t = 0.5 s\n", head);
  expectRefused("# state of 50 particles at frame 5, t = nan s\n", head);
  expectRefused("# state of 50 particles at frame 9223372036854775807, t = 0.5 s\n",
                "frames: must be more than 9223372036854775807");
  expectRefused("# state of 50 particles at frame 12, t = 1.2 s\n", "frames: must be more than 12");
  expectRefused(
      "# state of 50 particles at frame 5, t = 0.25 s\n" + state,
      "state.txt:1: the state is at t = 0.25 s, but frame 5 of this run is at 0.5 s; give "
      "the time_step and steps_per_frame of the run that saved it");
  const std::string incomplete =
      "state.txt: is not a complete state file; it must have 50 particles, each with a line "
      "'x y m vx vy', got ";
  expectRefused(state.substr(0, state.size() - 1), incomplete + "50, the last line without end");
  expectRefused(state.substr(0, state.rfind('\n', state.size() / 2) + 1), incomplete);
  expectRefused("# state of 50 particles at frame 5, t = 0.5 s\n" + chainOf(50),
                incomplete + "50 without velocities");
}

// A hand can move it, and the state can be saved meanwhile.
TEST_F(Exercise3State, TheFirstParticleOfAStateIsFixed) {
  save("Runge-Kutta-4");
  std::string state = read("state.txt");
  state.replace(state.find("\n0 0 0.1 0 0\n"), 13, "\n0 0 0.1 3 4\n");
  folder_.write("state.txt", state);
  EXPECT_EQ(resume("Runge-Kutta-4", "--save-state after.txt").errors, "");
  EXPECT_THAT(read("after.txt"), HasSubstr("\n0 0 0.1 0 0\n"));
}

TEST_F(Exercise3State, AStateIsAnOrdinaryParticleFileToo) {
  save("Runge-Kutta-4");
  EXPECT_EQ(runWith("Runge-Kutta-4 state.txt -o again --frames 2").status, 0);
  EXPECT_EQ(read("again/frame_0000.txt"), read("parts/frame_0005.txt"));
}

}  // namespace
}  // namespace spring_pendulum
