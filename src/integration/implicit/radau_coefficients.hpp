// Radau IIA with five stages: coefficients, from benchmark/derivations/radau_coefficients.py, and sums
// over the stages.
#pragma once

#include "integration/implicit/complex.hpp"

#include <array>
#include <cstddef>

namespace spring_pendulum::radau {

inline constexpr std::size_t kStages = 5;
using Row = std::array<double, kStages>;
using ComplexRow = std::array<Complex, kStages>;

/// c_i, and a_ij of the collocation equations Z_i = h sum_j a_ij F_j.
inline constexpr Row kNodes{0.057104196114517682193, 0.27684301363812382768, 0.58359043236891682006,
                            0.86024013565621944785, 1.0};
inline constexpr std::array<Row, kStages> kMatrix{
    {{0.072998864317903324306, -0.026735331107945571878, 0.018676929763984354412,
      -0.012879106093306439854, 0.0050428392338820152067},
     {0.15377523147918246867, 0.14621486784749350665, -0.036444568905128089527,
      0.021233063119304719422, -0.0079355799027287775326},
     {0.14006304568480987151, 0.2989671294912834794, 0.16758507013524896344,
      -0.033969101686617746572, 0.010944288744192252274},
     {0.14489430810953475754, 0.27650006876015922756, 0.32579792291042102998,
      0.12875675325490976116, -0.015708917378805328388},
     {0.14371356079122594132, 0.28135601514946206019, 0.31182652297574125408, 0.2231039010835707444,
      0.04}}};

/// An eigenvalue of the inverse matrix with its left and right eigenvectors, scaled so that their
/// product is 1. For a complex pair, the right eigenvector is doubled: its real part is then the
/// sum over the pair.
template <typename Scalar>
struct Eigenvalue {
  Scalar value;
  std::array<Scalar, kStages> left;
  std::array<Scalar, kStages> right;
};

inline constexpr Eigenvalue<double> kReal{
    6.2867047517292766452,
    {27.697693775684088409, 12.783337911304406015, 3.2084893867134298598, -0.95149041224891622127,
     0.74155049602598960335},
    {0.013576867344947943248, 0.0016179004017190874764, 0.079157853347447207645,
     0.41225608268046145198, 1.0}};

inline constexpr std::array<Eigenvalue<Complex>, 2> kPairs{
    {{{5.7009532986717894192, 3.2102656003085498884},
      {{{-16.520940106759500004, -4.3057219899376459889},
        {-8.6884767395317835097, 4.8499957047644041157},
        {-0.086064531627002780576, 0.95736431984843714243},
        {-0.049584888991271321294, 1.2093460030424700132},
        {0.26561405791915333359, -0.52373174396766870935}}},
      {{{-0.022957030510459029416, 0.028039717785750820562},
        {-0.01533766149836032577, -0.049417156853037053625},
        {0.038796927997657901822, -0.16360070740750234167},
        {0.81520234256039813324, -0.39936485577360505187},
        {2.0, 0.0}}}},
     {{3.6556943254635722582, 6.543736899360077294},
      {{{2.6720932189174557994, 1.87402990371990243},
        {2.2968077838795805022, -1.9924828681719423336},
        {-1.5181801617297121493, -0.52220782080400939647},
        {0.52533009511572943193, 0.59204928406897424362},
        {-0.13638930593214813527, -0.22495888507839018445}}},
      {{{-0.02048409563581765414, -0.095347754580591447726},
        {0.10034572903474211633, 0.18866363836322287396},
        {-0.46107906808683589344, -0.20540609076025179958},
        {0.75578780449772249909, -0.93348826066498871858},
        {2.0, 0.0}}}}}};

/// Weights e_i of the error estimate (I - q J)⁻¹ (q F(z_0) + sum_i e_i Z_i), q = h / kReal.value.
inline constexpr Row kError{-4.4189977167963817226, 0.57923485225667005447, -0.19923756095346800874,
                            0.094167483691945488975, -0.031813168885493824096};

inline double dot(const Row& a, const Row& b) {
  double sum = 0.0;
  for (std::size_t s = 0; s < kStages; ++s) sum += a[s] * b[s];
  return sum;
}

inline Complex dot(const ComplexRow& a, const Row& b) {
  Complex sum;
  for (std::size_t s = 0; s < kStages; ++s) sum = sum + b[s] * a[s];
  return sum;
}

inline double realPart(double a) {
  return a;
}
inline double realPart(Complex a) {
  return a.re;
}

/// Adds the real part of each factor times `value`.
template <typename Scalar>
void addTo(Row& row, const std::array<Scalar, kStages>& factors, Scalar value) {
  for (std::size_t s = 0; s < kStages; ++s) row[s] += realPart(factors[s] * value);
}

/// Returns the values of the Lagrange polynomials of the nodes at `time`, in step sizes.
/// \param with_start whether 0 is a node as well
inline Row lagrangeWeights(double time, bool with_start) {
  const Row& c = kNodes;
  Row weights;
  for (std::size_t i = 0; i < kStages; ++i) {
    weights[i] = with_start ? time / c[i] : 1.0;
    for (std::size_t j = 0; j < kStages; ++j)
      if (j != i) weights[i] *= (time - c[j]) / (c[i] - c[j]);
  }
  return weights;
}

}  // namespace spring_pendulum::radau
