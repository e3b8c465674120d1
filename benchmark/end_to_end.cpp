// The complete run of the exercise, 500 frames of 11 particles, divided into integrating,
// formatting numbers and writing files, compared with a typical student solution: one object per
// particle and one std::ofstream per frame.
#include "io/formats/frame_writer.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "interleaved.hpp"
#include "options.hpp"
#include "peer.hpp"
#include "result_file.hpp"
#include "scenes.hpp"

namespace spring_pendulum::benchmark {
namespace {

const Scenario kDefaults;

/// Makes both runs. Each can stop after integrating or formatting.
class Runs {
 public:
  explicit Runs(std::filesystem::path folder)
      : folder_(std::move(folder)),
        problem_(horizontalChain(11)),
        chain_(Eigen::VectorXd::Ones(11), kDefaults.constants),
        student_(make("object per particle")) {}

  void emptyFolder() const {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  template <typename Output>
  void own(const Output& output) const {
    const auto integrator = makeIntegrator("Runge-Kutta-4", chain_);
    State state(chain_.size());
    std::copy(problem_.start.begin(), problem_.start.end(), state.values().data());
    for (std::int64_t frame = 0; frame < kDefaults.frames; ++frame) {
      if (frame > 0) integrator->advance(state, kDefaults.time_step, kDefaults.steps_per_frame);
      output(frame, state);
    }
  }

  void ownIntegrating() const {
    own([](std::int64_t, const State&) {});
  }

  void ownFormatting() const {
    std::string text;
    own([&](std::int64_t, const State& state) {
      text.clear();
      for (Eigen::Index i = 0; i < state.size(); ++i) {
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{} {}\n"), state.x()[i],
                       state.y()[i]);
      }
    });
  }

  void ownWriting() const {
    FrameWriter writer(folder_.string());
    own([&](std::int64_t frame, const State& state) { writer.write(frame, state); });
    writer.finish();
  }

  template <typename Output>
  void students(const Output& output) const {
    student_->reset();
    for (std::int64_t frame = 0; frame < kDefaults.frames; ++frame) {
      if (frame > 0) student_->advance();
      output(frame, student_->state());
    }
  }

  static void print(std::ostream& stream, const std::vector<double>& z) {
    const std::size_t n = z.size() / 4;
    stream << std::setprecision(std::numeric_limits<double>::max_digits10);
    for (std::size_t i = 0; i < n; ++i) stream << z[i] << " " << z[n + i] << std::endl;
  }

  void studentsIntegrating() const {
    students([](std::int64_t, const std::vector<double>&) {});
  }

  void studentsFormatting() const {
    students([](std::int64_t, const std::vector<double>& z) {
      std::ostringstream text;
      print(text, z);
    });
  }

  void studentsWriting() const {
    students([&](std::int64_t frame, const std::vector<double>& z) {
      std::ostringstream name;
      name << "frame_" << std::setw(4) << std::setfill('0') << frame << ".txt";
      std::ofstream file(folder_ / name.str());
      print(file, z);
    });
  }

  /// Exercise3 as a process, from start to end.
  void program() const {
    const std::string command =
        fmt::format("'{}' Runge-Kutta-4 --particles '{}' --output '{}' > /dev/null", EXERCISE3,
                    PARTICLE_FILE, folder_.string());
    if (std::system(command.c_str()) != 0) throw std::runtime_error("Exercise3 failed");
  }

  /// Largest difference of the last frames of the two runs, m.
  double difference() const {
    std::vector<double> ours;
    std::vector<double> theirs;
    own([&](std::int64_t, const State& state) {
      ours.assign(state.values().data(), state.values().data() + state.values().size());
    });
    students([&](std::int64_t, const std::vector<double>& z) { theirs = z; });
    return positionError(ours, theirs);
  }

 private:
  std::unique_ptr<Peer> make(const std::string& name) const {
    Run run;
    run.time_step = kDefaults.time_step;
    run.steps = kDefaults.steps_per_frame;
    for (const PeerRow& row : allPeers()) {
      if (row.name == name) return row.make(problem_, run);
    }
    throw std::logic_error("no peer " + name);
  }

  std::filesystem::path folder_;
  Problem problem_;
  Chain chain_;
  std::unique_ptr<Peer> student_;
};

/// Rounding errors after fifty seconds of weakly chaotic motion.
constexpr double kAgreement = 1e-6;  // m

}  // namespace

int run(const Options& options) {
  const Runs runs(std::filesystem::path(options.output) / "end_to_end_frames");
  const double difference = runs.difference();
  if (!(difference <= kAgreement)) {
    std::fprintf(stderr, "the runs differ by %g m after 50 s\n", difference);
    return 1;
  }
  const auto clean = [&] { runs.emptyFolder(); };
  const std::vector<Work> pieces{
      {"integrating", {}, [&] { runs.ownIntegrating(); }},
      {"and formatting", {}, [&] { runs.ownFormatting(); }},
      {"and writing", clean, [&] { runs.ownWriting(); }},
      {"student: integrating", {}, [&] { runs.studentsIntegrating(); }},
      {"student: and formatting", {}, [&] { runs.studentsFormatting(); }},
      {"student: and writing", clean, [&] { runs.studentsWriting(); }},
      {"Exercise3 from start to end", clean, [&] { runs.program(); }}};
  const std::vector<Timing> timings = timeInTurns(pieces, options.smoke ? 3 : 15, Time::kElapsed);
  clean();
  std::filesystem::remove_all(std::filesystem::path(options.output) / "end_to_end_frames");

  ResultFile file(
      options.output + "/end_to_end.csv",
      {"The exercise: Runge-Kutta-4, 11 particles, 500 frames of 10 steps, all written.",
       "Runs that stop after integrating, that also format every frame, and that also",
       "write it; the differences are what formatting and writing cost. Where files go",
       "decides what writing costs: here the folder of this result.",
       fmt::format("The two runs differ by {:.2g} m after 50 s.", difference)},
      "run,median_ms,least_ms");
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    file.add(fmt::format("{},{:.4g},{:.4g}", quoted(pieces[i].name), 1e3 * timings[i].median,
                         1e3 * timings[i].least));
  }
  return 0;
}

}  // namespace spring_pendulum::benchmark
