#include "sweep/running/sweep_run.hpp"

#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/progress.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "sweep/plot.hpp"
#include "sweep/running/case_runner.hpp"
#include "sweep/running/journal.hpp"

namespace spring_pendulum::sweep {
namespace {

constexpr std::chrono::milliseconds kLook{1};  // for requests of other ranks
constexpr std::size_t kFlushedText = 1 << 16;

int threadsOf(const SweepOptions& options, const CaseCounter& counter) {
  if (options.threads > 0) return static_cast<int>(options.threads);
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / counter.ranksOnThisMachine());
}

/// Runs work on threads, as many as the system grants, while this thread calls `meanwhile`. The first
/// failure stops the others, which ask `stops`, and is thrown here.
class Workers {
 public:
  bool stops() const { return failed_ || interruption() != 0; }

  template <typename Work, typename Meanwhile>
  void run(int threads, const Work& work, const Meanwhile& meanwhile) {
    const auto guarded = [&] {
      try {
        work();
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!failed_) failure_ = std::current_exception();
        failed_ = true;
      }
      --working_;
    };
    std::vector<std::thread> others;
    try {
      for (int i = 0; i < threads; ++i) {
        ++working_;
        others.emplace_back(guarded);
      }
    } catch (const std::system_error&) {  // the system refuses more threads
      --working_;
    }
    if (others.empty()) {
      ++working_;
      guarded();
    }
    for (; working_ > 0; std::this_thread::sleep_for(kLook)) meanwhile();
    for (std::thread& thread : others) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::atomic<int> working_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

class Sweep {
 public:
  Sweep(const Study& study, const SweepOptions& options, CaseCounter& counter)
      : study_(study),
        columns_(study),
        options_(options),
        counter_(counter),
        threads_(threadsOf(options, counter)),
        journals_(options.output + ".journal", study.hash),
        rows_(static_cast<std::size_t>(study.cases())) {
    checkCases(study, threads_);
    checkOutputs();
    journals_.start();
    readJournals();
  }

  /// Runs the cases that are not done.
  void work() {
    Progress progress(study_.cases(), "cases");
    Workers workers;
    workers.run(
        threads_,
        [&] {
          CaseMaker maker(study_);
          while (!workers.stops()) {
            // A shard takes every n-th case.
            const std::int64_t index = counter_.next() * options_.shards + options_.shard - 1;
            if (index >= study_.cases()) break;
            reached_ = index;
            workOn(index, maker, workers);
          }
        },
        [&] {
          counter_.poll();
          if (counter_.rank() == 0) progress.show(reached_);
        });
  }

  /// Takes over what other processes have finished.
  void readJournals() {
    journals_.read([this](std::int64_t index, std::string_view text) {
      if (index >= 0 && index < study_.cases()) rows_[static_cast<std::size_t>(index)] = text;
    });
  }

  std::int64_t missingCases() const {
    return std::count_if(rows_.begin(), rows_.end(), [](const auto& row) { return row.empty(); });
  }

  void writeTable() {
    OutputFile table(options_.output);
    std::string text = tableHeader(study_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      text += rowStart(study_, static_cast<std::int64_t>(i)) + rows_[i] + '\n';
      if (text.size() < kFlushedText) continue;
      table.write(text);
      text.clear();
    }
    table.write(text);
    table.finish();
    if (options_.plot) drawPlot(study_, options_.output, picturePath(options_.output));
    journals_.remove();
  }

  /// Lets shards that finish at the same moment conclude one after the other.
  /// \returns false if another one has written the table
  bool lockJournals() { return journals_.lock(); }

  const std::string& journalFolder() const { return journals_.folder(); }

 private:
  /// Finds out before the first case what would prevent the last line of the table.
  void checkOutputs() const {
    if (options_.plot) requirePlotter();
    if (options_.shards > 1 && std::filesystem::exists(options_.output)) {
      throw InputError(options_.output + ": exists; remove it to run its shards anew");
    }
    if (options_.shards > 1 || counter_.rank() > 0) return;
    const OutputFile table(options_.output);
    if (options_.plot) const OutputFile picture(picturePath(options_.output));
  }

  void workOn(std::int64_t index, CaseMaker& maker, const Workers& workers) {
    const auto i = static_cast<std::size_t>(index);
    if (!rows_[i].empty()) return;
    std::optional<std::string> text =
        runCase(columns_, maker.make(index), [&workers] { return workers.stops(); });
    if (!text) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    journals_.append(index, *text);
    rows_[i] = std::move(*text);
  }

  const Study& study_;
  WantedColumns columns_;
  const SweepOptions& options_;
  CaseCounter& counter_;
  int threads_;
  Journals journals_;
  std::vector<std::string> rows_;  ///< columns of the finished cases
  std::atomic<std::int64_t> reached_{0};
  std::mutex mutex_;
};

/// Writes the table, or says why it is not complete.
/// \param signal that has stopped a rank; 0: none
int conclude(Sweep& sweep, const Study& study, const SweepOptions& options, int signal) {
  if (!sweep.lockJournals()) {
    printOutput(fmt::format("another process has written {}\n", options.output));
    return kDone;
  }
  sweep.readJournals();
  const std::int64_t missing = sweep.missingCases();
  const std::string done =
      fmt::format("{} of {} cases are done", study.cases() - missing, study.cases());
  if (missing > 0 && signal != 0) {
    printError(done + "; the same command goes on\n");
    return kSignalled + signal;
  }
  if (missing > 0 && options.shards > 1) {
    printOutput(fmt::format("{}; the last shard writes {}\n", done, options.output));
    return kDone;
  }
  if (missing > 0) {
    throw FileError(
        fmt::format("{}; all ranks must see the same folder {}", done, sweep.journalFolder()));
  }
  sweep.writeTable();
  printOutput(fmt::format(
      "{}: {}, table {}{}\n", study.name, counted(study.cases(), "case"), options.output,
      options.plot ? fmt::format(", picture {}", picturePath(options.output)) : ""));
  return kDone;
}

}  // namespace

std::string picturePath(const std::string& output) {
  return std::filesystem::path(output).replace_extension(".png").string();
}

void checkCases(const Study& study, int threads) {
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  std::int64_t bad = study.cases();
  std::string message;
  Workers workers;
  workers.run(
      threads,
      [&] {
        CaseMaker maker(study);
        for (std::int64_t i = 0; (i = next++) < bad && !workers.stops();) {
          try {
            const Case& made = maker.make(i);
            Scenario scenario = made.settings.scenario;
            scenario.reference = ReferenceUse::kNever;
            const Run run(scenario, made.particles);
          } catch (const InputError& error) {
            const std::lock_guard<std::mutex> lock(mutex);
            if (i < bad) message = fmt::format("case {}: {}", i, error.what());
            bad = std::min(bad, i);
            next = study.cases();
          }
        }
      },
      [] {});
  if (bad < study.cases()) throw InputError(message);
}

int runSweep(const Study& study, const SweepOptions& options, CaseCounter& counter) {
  catchInterruptions();
  Sweep sweep(study, options, counter);
  if (counter.rank() == 0) counter.largest(0);  // study and outputs are in order
  sweep.work();
  const int signal = counter.largest(interruption());
  return counter.rank() == 0 ? conclude(sweep, study, options, signal) : kDone;
}

}  // namespace spring_pendulum::sweep
