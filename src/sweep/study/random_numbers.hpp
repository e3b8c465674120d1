// Random numbers that are a function of their place: no number depends on how many were drawn before.
//
// Philox4x32-10 of J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy
// as 1, 2, 3", Proc. SC11 (2011), encrypts a counter. Logarithm and exponential are our own, because
// those of C libraries differ in the last bit.
#pragma once

#include <array>
#include <cstdint>

namespace spring_pendulum::sweep {

/// Returns Philox4x32-10 of a counter.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key);

/// Returns ln x for finite x > 0 to within 1e-15 (relative or absolute), the same bits everywhere.
double portableLog(double x);
/// Returns e^x for |x| <= 700 to within a relative 1e-13, the same bits everywhere.
double portableExp(double x);

/// The random numbers of one quantity of one particle.
class RandomNumbers {
 public:
  /// \param quantity tells apart the quantities of a particle
  RandomNumbers(std::uint64_t seed, std::uint64_t sample, std::uint32_t particle,
                std::uint32_t quantity);

  /// Returns a number uniform in (0, 1) with 52 random bits.
  double uniform();
  /// Returns a normal number with mean 0 and variance 1, by the polar method of G. Marsaglia.
  double normal();

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<double, 2> numbers_{};
  int left_ = 0;  ///< numbers not yet returned
};

}  // namespace spring_pendulum::sweep
