#include "sweep/sweep_run.hpp"

#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/files/posix.hpp"
#include "io/program/program.hpp"
#include "io/program/progress.hpp"
#include "sweep/journal.hpp"
#include "sweep/table.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

namespace spring_pendulum::sweep {
namespace {

constexpr std::chrono::milliseconds kLook{1};  // for requests of other ranks

/// Runs a loop over cases on as many threads as the system grants.
/// \param next      returns the next case, or one beyond the last
/// \param work      works on a case; its argument `stop` tells whether to break off
/// \param meanwhile called all the time by this thread
/// \throws InputError or std::runtime_error for the first case that fails
template <typename Next, typename Work, typename Meanwhile>
void forEachCase(const Study& study, std::int64_t threads, const Next& next, const Work& work,
                 const Meanwhile& meanwhile) {
  std::mutex mutex;
  std::map<std::int64_t, Failure> failures;
  std::atomic<bool> failed{false};
  const auto stop = [&] { return failed || interruption() != 0; };
  const auto run = [&] {
    for (std::int64_t i = 0; !stop() && (i = next()) < study.cases();) {
      try {
        work(i, caseOf(study, i), stop);
      } catch (const std::exception& error) {
        const std::lock_guard<std::mutex> lock(mutex);
        failures.emplace(i, failureOf(error));
        failed = true;
      }
    }
  };
  std::vector<std::future<void>> workers;
  try {
    while (workers.size() < static_cast<std::size_t>(threads))
      workers.push_back(std::async(std::launch::async, run));
  } catch (const std::system_error&) {  // the system refuses more threads
    if (workers.empty()) run();
  }
  for (const std::future<void>& worker : workers)
    while (worker.wait_for(kLook) != std::future_status::ready) meanwhile();
  if (failures.empty()) return;
  const auto& [index, failure] = *failures.begin();
  const std::string message = fmt::format("case {}: {}", index, failure.message);
  if (failure.status == kBadInput) throw InputError(message);
  throw std::runtime_error(message);
}

class Sweep {
 public:
  Sweep(const Study& study, const SweepOptions& options, CaseCounter& counter)
      : study_(study),
        options_(options),
        counter_(counter),
        rows_(static_cast<std::size_t>(study.cases())) {}

  /// Finds out before the first case what would prevent the table or the picture. Returns the exit status.
  int prepare() {
    checkCases(study_, options_.threads);
    if (const int status = counter_.rank() == 0 ? tryOutputs() : kDone) return status;
    journal_.emplace(options_.output + ".journal", study_.hash,
                     options_.shards > 1 ? options_.output : "");
    readJournal();
    return kDone;
  }

  /// Runs the cases that are not done.
  void work() {
    // A shard takes every n-th case.
    const std::int64_t shards = options_.shards;
    const std::int64_t cases = (study_.cases() - options_.shard + shards) / shards;
    Progress progress(cases, "cases");
    std::atomic<std::int64_t> begun{0}, busy{0};
    const auto next = [&] {
      std::int64_t place = 0, index = 0;
      do {
        index = (place = counter_.next()) * shards + options_.shard - 1;
      } while (index < study_.cases() && !rows_[static_cast<std::size_t>(index)].empty());
      if (index < study_.cases()) ++busy;
      begun = std::min(place + 1, cases);
      return index;
    };
    const auto run = [&](std::int64_t index, const Case& a_case, const auto& stop) {
      std::optional<std::string> text = runCase(study_, a_case, stop);
      --busy;
      if (!text) return;
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!journal_->append(index, *text)) requireTable();
      rows_[static_cast<std::size_t>(index)] = std::move(*text);
    };
    const auto meanwhile = [&] {
      counter_.poll();
      if (counter_.rank() == 0 && begun > 0) progress.show(std::max<std::int64_t>(0, begun - busy));
    };
    forEachCase(study_, options_.threads, next, run, meanwhile);
  }

  /// Writes the table, or says why it is not complete, and returns the exit status.
  /// \param signal that has stopped a rank; 0: none
  int conclude(int signal) {
    // Shards that finish at the same moment conclude one after the other.
    if (!journal_->lock()) {
      requireTable();
      printOutput(fmt::format("another process has written {}\n", options_.output));
      return options_.plot ? drawPicture() : kDone;
    }
    readJournal();
    const std::int64_t missing = std::count(rows_.begin(), rows_.end(), std::string());
    const std::string done =
        fmt::format("{} of {} cases are done", study_.cases() - missing, study_.cases());
    if (missing > 0 && signal != 0) {
      printError(done + "; the same command goes on\n");
      return kSignalled + signal;
    }
    if (missing > 0 && options_.shards > 1) {
      printOutput(fmt::format("{}; the last shard writes {}\n", done, options_.output));
      return kDone;
    }
    if (missing > 0)
      throw FileError(
          fmt::format("{}; all ranks must see the same file {}", done, journal_->path()));
    return writeTable();
  }

 private:
  /// \throws FileError unless the table has all cases, and the rows that this process knows
  void requireTable() const {
    const bool exists = std::filesystem::exists(options_.output);
    const std::string table = exists ? readTextFile(options_.output) : "";
    std::size_t at = 0;
    for (std::size_t i = 0; i < rows_.size() && at != std::string::npos; ++i) {
      const std::string start = rowStart(study_, static_cast<std::int64_t>(i));
      at = table.find('\n' + start + (rows_[i].empty() ? "," : rows_[i] + '\n'), at);
    }
    if (at == std::string::npos)
      throw FileError(fullPath(journal_->path()) + ": was removed or replaced during the run");
  }

  int tryOutputs() const {
    // Shards may start at the same moment.
    const std::string shard = options_.shards > 1 ? fmt::format(".{}", options_.shard) : "";
    static_cast<void>(OutputFile(options_.output + shard).path());
    if (!options_.plot) return kDone;
    OutputFile picture(picturePath(options_.output) + shard);
    writeRows(picture);  // not to the table, which another process may write now
    return drawPlot(study_, picture.unfinishedPath(), picturePath(options_.output), true);
  }

  /// Takes over what this and other processes have finished.
  void readJournal() {
    journal_->read([this](std::int64_t index, std::string_view text) {
      rows_.at(static_cast<std::size_t>(index)) = text;
    });
  }

  int writeTable() {
    OutputFile table(options_.output);
    writeRows(table);
    table.finish();
    std::string text = fmt::format("{}: {}, table {}", study_.name, counted(study_.cases(), "case"),
                                   options_.output);
    if (options_.plot) {
      if (const int status = drawPicture(); status != kDone) return status;
      text += ", picture " + picturePath(options_.output);
    }
    // After a kill before this, the same command draws the picture.
    std::error_code error;
    std::filesystem::remove(journal_->path(), error);
    if (error)
      throw FileError(fmt::format("{}: could not be removed: {}; the table {} is complete",
                                  fullPath(journal_->path()), error.message(), options_.output));
    printOutput(text + "\n");
    return kDone;
  }

  int drawPicture() const {
    return drawPlot(study_, options_.output, picturePath(options_.output), false);
  }

  /// Writes the header and all rows, of which some may lack the columns.
  void writeRows(OutputFile& table) const {
    table.write(tableHeader(study_));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      table.write(rowStart(study_, static_cast<std::int64_t>(i)) + rows_[i] + '\n');
  }

  const Study& study_;
  const SweepOptions& options_;
  CaseCounter& counter_;
  std::optional<Journal> journal_;
  std::vector<std::string> rows_;  ///< columns of the finished cases
  std::mutex mutex_;
};

/// Refuses ranks with different arguments, as they would leave out cases.
void compareRanks(const Study& study, const SweepOptions& options, CaseCounter& counter) {
  const std::string job = fmt::format("{} {}/{}", options.output, options.shard, options.shards);
  const int hash = static_cast<int>(hashOf(job, study.hash) >> 33);
  if (counter.largest(hash) == -counter.largest(-hash)) return;
  if (counter.rank() > 0) counter.largest(0);  // until rank 0 ends all
  throw InputError("all ranks need the same study, --output and --shard");
}

}  // namespace

std::string picturePath(const std::string& output) {
  return std::filesystem::path(output).replace_extension(".png").string();
}

void checkCases(const Study& study, std::int64_t threads) {
  std::atomic<std::int64_t> next{0};
  const auto check = [](std::int64_t, const Case& a_case, const auto&) {
    Plan plan = a_case.settings.scenario;
    plan.reference = ReferenceUse::kNever;
    const Run checked(a_case.scene(), plan);
  };
  forEachCase(
      study, threads, [&] { return next++; }, check, [] {});
}

int runSweep(const Study& study, const SweepOptions& options, CaseCounter& counter) {
  catchInterruptions();
  if (counter.rank() == 0) counter.largest(0);  // the others may read the study
  compareRanks(study, options, counter);
  if (options.shard > study.cases()) {
    if (counter.rank() == 0) printOutput(fmt::format("shard {} has no case\n", options.shard));
    return kDone;
  }
  if (counter.rank() > 0) counter.largest(0);  // so each error is reported once
  Sweep sweep(study, options, counter);
  if (const int status = sweep.prepare(); status != kDone) return counter.abort(status);
  if (counter.rank() == 0) counter.largest(0);  // the others may begin
  sweep.work();
  const int signal = counter.largest(interruption());
  return counter.rank() == 0 ? sweep.conclude(signal) : kDone;
}

}  // namespace spring_pendulum::sweep
