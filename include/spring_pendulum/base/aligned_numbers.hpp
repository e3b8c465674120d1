// Memory for numbers that a program and the library pass to each other.
//
// The way Eigen aligns and frees memory depends on the compiler's vector options. A program that
// frees an Eigen matrix allocated by a library with other options crashes. All shared memory is
// therefore allocated and freed by the aligned operators new and delete; Eigen accesses it through
// Eigen::Map.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <new>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// An array of doubles aligned to a cache line. An assignment reuses the memory if the sizes agree.
class AlignedNumbers {
 public:
  static constexpr std::size_t kAlignment = 64;

  using View = Eigen::Map<Eigen::VectorXd>;
  using ConstView = Eigen::Map<const Eigen::VectorXd>;

  AlignedNumbers() = default;
  /// Allocates `size` zeros.
  /// \throws std::length_error if `size` is negative
  explicit AlignedNumbers(std::ptrdiff_t size) : numbers_(static_cast<std::size_t>(size)) {}
  /// Copies an Eigen vector or vector expression.
  template <typename Vector>
  AlignedNumbers(const Eigen::MatrixBase<Vector>& numbers)  // NOLINT(google-explicit-constructor)
      : AlignedNumbers(static_cast<std::ptrdiff_t>(numbers.size())) {
    view() = numbers;
  }

  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(numbers_.size()); }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }
  double& operator[](std::ptrdiff_t i) { return data()[i]; }
  double operator[](std::ptrdiff_t i) const { return data()[i]; }

  View view() { return {data(), static_cast<Eigen::Index>(size())}; }
  ConstView view() const { return {data(), static_cast<Eigen::Index>(size())}; }

 private:
  template <typename Number>
  struct Allocator {
    using value_type = Number;
    static Number* allocate(std::size_t size) {
      return static_cast<Number*>(
          ::operator new (size * sizeof(Number), std::align_val_t{kAlignment}));
    }
    static void deallocate(Number* numbers, std::size_t) noexcept {
      ::operator delete (numbers, std::align_val_t{kAlignment});
    }
    friend bool operator==(const Allocator&, const Allocator&) { return true; }
    friend bool operator!=(const Allocator&, const Allocator&) { return false; }
  };

  std::vector<double, Allocator<double>> numbers_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
