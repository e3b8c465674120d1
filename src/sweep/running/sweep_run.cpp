#include "sweep/running/sweep_run.hpp"

#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/progress.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "sweep/plot.hpp"
#include "sweep/running/case_runner.hpp"
#include "sweep/running/journal.hpp"
#include "sweep/running/schedule.hpp"

namespace spring_pendulum::sweep {
namespace {

constexpr std::chrono::milliseconds kLook{20};  // whether the workers have finished
constexpr std::size_t kFlushedText = 1 << 16;

int threadsOf(const SweepOptions& options, const Dispatcher& dispatcher) {
  if (options.threads > 0) return static_cast<int>(options.threads);
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / dispatcher.ranksOnThisMachine());
}

class Sweep {
 public:
  Sweep(const Study& study, const SweepOptions& options, Dispatcher& dispatcher)
      : study_(study),
        columns_(study),
        options_(options),
        dispatcher_(dispatcher),
        threads_(threadsOf(options, dispatcher)),
        schedule_(makeSchedule(study, threads_)),
        references_(static_cast<std::size_t>(threads_) + 1),
        journals_(options.output + ".journal", study.hash),
        rows_(static_cast<std::size_t>(study.cases())) {
    readJournals();
    const auto all = static_cast<std::int64_t>(schedule_.batches.size());
    for (std::int64_t i = options.shard - 1; i < all; i += options.shards) {
      own_.push_back(i);
      for (const std::int64_t index : schedule_.batches[static_cast<std::size_t>(i)]) {
        if (!isDone(index)) ++open_;
      }
    }
  }

  /// Runs the cases of this process that are not done.
  void work() {
    if (open_ > 0) journals_.start();
    Progress progress(open_, "cases");
    working_ = threads_;
    std::vector<std::thread> workers;
    workers.reserve(static_cast<std::size_t>(threads_));
    for (int i = 0; i < threads_; ++i) workers.emplace_back([this] { workOnBatches(); });
    if (dispatcher_.rank() == 0) {
      std::int64_t elsewhere = 0;
      dispatcher_.serve([this] { return nextOwn(); },
                        [&](std::int64_t finished) {
                          elsewhere += finished;
                          progress.show(elsewhere + finished_);
                        });
      for (; working_ > 0; std::this_thread::sleep_for(kLook)) {
        progress.show(elsewhere + finished_);
      }
    }
    for (std::thread& worker : workers) worker.join();
    if (dispatcher_.rank() > 0) dispatcher_.leave(finished_.exchange(0));
    if (failure_) std::rethrow_exception(failure_);
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
    std::vector<std::string> plotted;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string row = rowStart(study_, static_cast<std::int64_t>(i)) + rows_[i];
      text += row + '\n';
      if (options_.plot) plotted.push_back(row);
      if (text.size() < kFlushedText) continue;
      table.write(text);
      text.clear();
    }
    table.write(text);
    table.finish();
    journals_.remove();
    if (options_.plot) drawPlot(study_, plotted, picturePath(options_.output));
  }

  /// Lets shards that finish at the same moment conclude one after the other.
  /// \returns false if another one has written the table
  bool lockJournals() { return journals_.lock(); }

  const std::string& journalFolder() const { return journals_.folder(); }

 private:
  bool isDone(std::int64_t index) const { return !rows_[static_cast<std::size_t>(index)].empty(); }

  std::int64_t nextOwn() {
    if (failed_ || interruption() != 0) return -1;
    const std::size_t next = next_++;
    return next < own_.size() ? own_[next] : -1;
  }

  void workOnBatches() {
    try {
      CaseMaker maker(study_);
      for (;;) {
        const bool asks = dispatcher_.rank() > 0 && !failed_ && interruption() == 0;
        const std::int64_t batch = asks ? dispatcher_.ask(finished_.exchange(0)) : nextOwnOnRank0();
        if (batch < 0) break;
        workOn(schedule_.batches[static_cast<std::size_t>(batch)], maker);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = std::current_exception();
      failed_ = true;
    }
    --working_;
  }

  std::int64_t nextOwnOnRank0() { return dispatcher_.rank() == 0 ? nextOwn() : -1; }

  void workOn(const std::vector<std::int64_t>& batch, CaseMaker& maker) {
    std::string lines;
    const auto stop = [this] { return failed_ || interruption() != 0; };
    for (const std::int64_t index : batch) {
      if (isDone(index)) continue;
      const Case& made = maker.make(index);
      const std::int32_t scene = schedule_.scene_of[static_cast<std::size_t>(index)];
      const auto reference = scene < 0 ? nullptr : references_.take(scene, made);
      std::optional<std::string> text = runCase(columns_, made, reference, stop);
      if (!text) break;
      journals_.addLine(index, *text, lines);
      rows_[static_cast<std::size_t>(index)] = std::move(*text);
      ++finished_;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    journals_.write(lines);
  }

  const Study& study_;
  WantedColumns columns_;
  const SweepOptions& options_;
  Dispatcher& dispatcher_;
  int threads_;
  Schedule schedule_;
  References references_;
  Journals journals_;
  std::vector<std::string> rows_;  ///< columns of the finished cases
  std::vector<std::int64_t> own_;  ///< batches of this shard
  std::int64_t open_ = 0;
  std::atomic<std::size_t> next_{0};  ///< in `own_`
  std::atomic<std::int64_t> finished_{0};
  std::atomic<int> working_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

/// Writes the table, or says why it is not complete.
int conclude(Sweep& sweep, const Study& study, const SweepOptions& options,
             const Dispatcher& dispatcher) {
  if (!sweep.lockJournals()) {
    printOutput(fmt::format("another process has written {}\n", options.output));
    return kDone;
  }
  if (dispatcher.size() > 1 || options.shards > 1) sweep.readJournals();
  const std::int64_t missing = sweep.missingCases();
  const std::string done =
      fmt::format("{} of {} cases are done", study.cases() - missing, study.cases());
  if (missing > 0 && interruption() != 0) {
    printError(done + "; the same command goes on\n");
    return kSignalled + interruption();
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
  const std::string picture = picturePath(options.output);
  printOutput(fmt::format(
      "{}: {}, table {}{}\n", study.name, counted(study.cases(), "case"), options.output,
      options.plot ? fmt::format(", pictures {0}.png and {0}.svg", picture) : ""));
  return kDone;
}

}  // namespace

std::string picturePath(const std::string& output) {
  return std::filesystem::path(output).replace_extension().string();
}

int runSweep(const Study& study, const SweepOptions& options, Dispatcher& dispatcher) {
  Sweep sweep(study, options, dispatcher);
  catchInterruptions();
  if (dispatcher.rank() == 0) dispatcher.meet();  // study and journals are in order
  sweep.work();
  return dispatcher.rank() == 0 ? conclude(sweep, study, options, dispatcher) : kDone;
}

}  // namespace spring_pendulum::sweep
