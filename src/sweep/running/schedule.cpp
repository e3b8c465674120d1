#include "sweep/running/schedule.hpp"

#include "simulation/expected_cost.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>
#include <unordered_map>

#include "sweep/running/case_runner.hpp"

namespace spring_pendulum::sweep {
namespace {

/// Expected work of a batch, s.
constexpr double kBatchWork = 0.05;
/// Expected work besides the steps: making a case, its run and its row, s.
constexpr float kWorkOfCase = 1e-5F;
constexpr std::int64_t kCasesAtOnce = 256;

/// What is known of each case before it runs.
struct Forecast {
  std::vector<float> work;         ///< s
  std::vector<std::string> scene;  ///< of cases with a reference run that can be shared
};

/// Makes a Run of each case, which checks its input.
void forecast(const Study& study, std::int64_t begin, std::int64_t end, CaseMaker& maker,
              Forecast& result) {
  for (std::int64_t i = begin; i < end; ++i) {
    const Case& made = maker.make(i);
    Scenario scenario = made.settings.scenario;
    scenario.reference = ReferenceUse::kNever;
    const auto n = static_cast<std::size_t>(i);
    try {
      const Run run(scenario, made.particles);
      result.work[n] =
          kWorkOfCase + static_cast<float>(expectedWork(scenario.method, run.chain(),
                                                        frameSteps(scenario), scenario.frames));
    } catch (const InputError& error) {
      throw InputError("case " + std::to_string(i) + ": " + error.what());
    }
    result.scene[n] = sceneOf(study, made);
  }
}

Forecast forecastAll(const Study& study, int threads) {
  const std::int64_t cases = study.cases();
  Forecast result{std::vector<float>(static_cast<std::size_t>(cases)),
                  std::vector<std::string>(static_cast<std::size_t>(cases))};
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  std::int64_t failed_at = cases;
  std::exception_ptr failure;
  const auto work = [&] {
    CaseMaker maker(study);
    for (std::int64_t begin = 0; (begin = next.fetch_add(kCasesAtOnce)) < cases;) {
      try {
        forecast(study, begin, std::min(cases, begin + kCasesAtOnce), maker, result);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        next = cases;
        if (begin < failed_at) failure = std::current_exception();
        failed_at = std::min(failed_at, begin);
      }
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
  return result;
}

/// Splits cases, sorted by their work, into batches.
void addBatches(const std::vector<std::int64_t>& cases, const std::vector<float>& work,
                Schedule& schedule) {
  double sum = kBatchWork;
  for (const std::int64_t i : cases) {
    if (sum >= kBatchWork) {
      schedule.batches.emplace_back();
      sum = 0.0;
    }
    schedule.batches.back().push_back(i);
    sum += static_cast<double>(work[static_cast<std::size_t>(i)]);
  }
}

}  // namespace

Schedule makeSchedule(const Study& study, int threads) {
  const Forecast cases = forecastAll(study, threads);
  Schedule schedule;
  std::unordered_map<std::string, std::int32_t> numbers;
  std::vector<std::vector<std::int64_t>> scenes;
  std::vector<std::int64_t> alone;
  for (std::size_t i = 0; i < cases.work.size(); ++i) {
    std::int32_t scene = -1;
    if (!cases.scene[i].empty()) {
      const auto next = static_cast<std::int32_t>(numbers.size());
      scene = numbers.emplace(cases.scene[i], next).first->second;
      if (scene == next) scenes.emplace_back();
    }
    schedule.scene_of.push_back(scene);
    (scene < 0 ? alone : scenes[static_cast<std::size_t>(scene)])
        .push_back(static_cast<std::int64_t>(i));
  }
  const auto by_work = [&](std::int64_t a, std::int64_t b) {
    return cases.work[static_cast<std::size_t>(a)] > cases.work[static_cast<std::size_t>(b)];
  };
  // A scene of one case shares nothing, so it can be run in any batch.
  for (auto& scene : scenes) {
    if (scene.size() > 1) continue;
    schedule.scene_of[static_cast<std::size_t>(scene.front())] = -1;
    alone.push_back(scene.front());
    scene.clear();
  }
  scenes.push_back(std::move(alone));
  for (auto& scene : scenes) std::stable_sort(scene.begin(), scene.end(), by_work);
  std::stable_sort(scenes.begin(), scenes.end(), [&](const auto& a, const auto& b) {
    return !a.empty() && (b.empty() || by_work(a.front(), b.front()));
  });
  for (const auto& scene : scenes) addBatches(scene, cases.work, schedule);
  return schedule;
}

}  // namespace spring_pendulum::sweep
