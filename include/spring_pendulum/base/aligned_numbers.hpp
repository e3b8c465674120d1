// Memory for numbers that a program and the library pass to each other.
//
// The way Eigen aligns and frees memory depends on the compiler's vector options. A program that
// frees an Eigen matrix allocated by a library with other options crashes. This library therefore
// allocates and frees all shared memory itself; Eigen accesses it through Eigen::Map.
#pragma once

#include <Eigen/Core>

#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// An array of doubles aligned to a cache line.
class AlignedNumbers {
 public:
  static constexpr std::size_t kAlignment = 64;

  using View = Eigen::Map<Eigen::VectorXd>;
  using ConstView = Eigen::Map<const Eigen::VectorXd>;

  AlignedNumbers() noexcept;
  /// Allocates `size` zeros.
  /// \throws InputError if `size` is negative
  explicit AlignedNumbers(std::ptrdiff_t size);
  /// Copies an Eigen vector or vector expression.
  template <typename Vector>
  AlignedNumbers(const Eigen::MatrixBase<Vector>& numbers)  // NOLINT(google-explicit-constructor)
      : AlignedNumbers(static_cast<std::ptrdiff_t>(numbers.size())) {
    view() = numbers;
  }

  AlignedNumbers(const AlignedNumbers& other);
  AlignedNumbers(AlignedNumbers&& other) noexcept;
  /// Reuses the memory if the sizes agree.
  AlignedNumbers& operator=(const AlignedNumbers& other);
  AlignedNumbers& operator=(AlignedNumbers&& other) noexcept;
  ~AlignedNumbers();

  std::ptrdiff_t size() const { return size_; }
  double* data() { return data_; }
  const double* data() const { return data_; }
  double& operator[](std::ptrdiff_t i) { return data_[i]; }
  double operator[](std::ptrdiff_t i) const { return data_[i]; }

  View view() { return {data_, static_cast<Eigen::Index>(size_)}; }
  ConstView view() const { return {data_, static_cast<Eigen::Index>(size_)}; }

 private:
  double* data_;
  std::ptrdiff_t size_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
