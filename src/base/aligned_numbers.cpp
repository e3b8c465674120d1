#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr std::ptrdiff_t kMostNumbers =
    std::numeric_limits<std::ptrdiff_t>::max() / static_cast<std::ptrdiff_t>(sizeof(double));

double* allocated(std::ptrdiff_t size) {
  if (size < 0) throw InputError(fmt::format("array size must be at least 0, got {}", size));
  if (size == 0) return nullptr;
  if (size > kMostNumbers) throw std::bad_alloc();
  return new (
      std::align_val_t{AlignedNumbers::kAlignment}) double[static_cast<std::size_t>(size)]();
}

}  // namespace

AlignedNumbers::AlignedNumbers() noexcept : data_(nullptr), size_(0) {}

AlignedNumbers::AlignedNumbers(std::ptrdiff_t size) : data_(allocated(size)), size_(size) {}

AlignedNumbers::AlignedNumbers(const AlignedNumbers& other) : AlignedNumbers(other.size_) {
  std::copy_n(other.data_, size_, data_);
}

AlignedNumbers::AlignedNumbers(AlignedNumbers&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

AlignedNumbers& AlignedNumbers::operator=(const AlignedNumbers& other) {
  if (this == &other) return *this;
  if (size_ != other.size_) *this = AlignedNumbers(other.size_);
  std::copy_n(other.data_, size_, data_);
  return *this;
}

AlignedNumbers& AlignedNumbers::operator=(AlignedNumbers&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

AlignedNumbers::~AlignedNumbers() {
  ::operator delete[](data_, std::align_val_t{kAlignment});
}

}  // namespace spring_pendulum
