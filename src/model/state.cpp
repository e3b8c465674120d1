#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/state.hpp>

#include <fmt/format.h>

#include <limits>
#include <new>
#include <utility>

namespace spring_pendulum {
namespace {

std::ptrdiff_t numbersOf(std::ptrdiff_t particles) {
  if (particles < 0) {
    throw InputError(fmt::format("number of particles must be at least 0, got {}", particles));
  }
  if (particles > std::numeric_limits<std::ptrdiff_t>::max() / 4) throw std::bad_alloc();
  return 4 * particles;
}

}  // namespace

State::State() : size_(0) {}
State::State(std::ptrdiff_t particles) : size_(particles), numbers_(numbersOf(particles)) {}
State::State(const State& other) = default;
State::State(State&& other) noexcept
    : size_(std::exchange(other.size_, 0)), numbers_(std::move(other.numbers_)) {}
State::~State() = default;

// NOLINTNEXTLINE(modernize-use-equals-default): the default would set size_ first
State& State::operator=(const State& other) {
  numbers_ = other.numbers_;  // first: it can throw
  size_ = other.size_;
  return *this;
}

State& State::operator=(State&& other) noexcept {
  numbers_ = std::move(other.numbers_);
  std::swap(size_, other.size_);
  return *this;
}

}  // namespace spring_pendulum
