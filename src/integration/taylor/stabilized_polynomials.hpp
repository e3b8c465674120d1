// Weights that make the sum of a Taylor series stable along the negative real axis.
// benchmark/derivations/stabilized_polynomials.py derives and explains them.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

namespace spring_pendulum {

/// The weights w_j of the terms j = 0..K of a Taylor series. The stability polynomial
/// R(z) = sum_j w_j z^j / j! agrees with exp(z) to order p.
struct StabilizedPolynomial {
  static constexpr std::size_t kMaxAdded = 7;

  int order;                                    ///< p; w_j = 1 up to it
  int terms;                                    ///< K
  double real_stability_limit;                  ///< |R(z)| <= 1 for real z from minus this to 0
  std::array<double, kMaxAdded - 1> weights;    ///< w_{p+1} to w_K
  std::array<double, kMaxAdded> error_weights;  ///< e_p to e_K: the error is sum_j e_j c_j h^j

  double weight(int term) const {
    if (term <= order) return 1.0;
    return term <= terms ? weights[static_cast<std::size_t>(term - order - 1)] : 0.0;
  }
  double errorWeight(int term) const {
    const bool counts = order <= term && term <= terms;
    return counts ? error_weights[static_cast<std::size_t>(term - order)] : 0.0;
  }
};

// Rows from benchmark/derivations/stabilized_polynomials.py, with increasing number of terms. The first is
// the plain series.
inline constexpr std::initializer_list<StabilizedPolynomial> kStabilizedOrder4 = {
    {4, 4, 2.7852, {}, {0.2}},
    {4, 5, 5.9923, {0.493152252166292}, {0.2, 0.177373401546154}},
    {4,
     6,
     9.8653,
     {0.639411248417101, 0.175245207812515},
     {0.2, 0.240497754888725, 0.0852319420504092}},
    {4,
     7,
     14.4414,
     {0.705282462889709, 0.283651803357444, 0.0493980528980519},
     {0.2, 0.271652506486, 0.143731109401178, 0.0289393566109777}},
    {4,
     8,
     19.7259,
     {0.741341963892218, 0.351255105069786, 0.0958139255083686, 0.0116050907905479},
     {0.2, 0.289625752820716, 0.182479057570303, 0.0579792028857553, 0.00771276377103641}},
    {4,
     9,
     25.7188,
     {0.763501510987429, 0.395807828355887, 0.132479059528639, 0.0261698667253173,
      0.00234406057736953},
     {0.2, 0.30104292660104, 0.209013878595522, 0.081900266740447, 0.0178336769141973,
      0.00170622706667232}},
    {4,
     10,
     32.4192,
     {0.778214130351868, 0.426679376582253, 0.16060842474984, 0.0400200181221252,
      0.00601163625819031, 0.000415981078741185},
     {0.2, 0.308791982945466, 0.22788151778443, 0.100780282683244, 0.0277533221775728,
      0.00446178976767287, 0.000324271325835708}},
};
inline constexpr std::initializer_list<StabilizedPolynomial> kStabilizedOrder8 = {
    {8, 8, 4.3136, {}, {0.05}},
    {8, 9, 7.0771, {0.582830717286382}, {0.05, 0.0656386058178435}},
    {8,
     10,
     10.0886,
     {0.763662169647634, 0.276571312040492},
     {0.05, 0.0977944661008419, 0.0528437341398467}},
    {8,
     11,
     13.4129,
     {0.841993483748279, 0.456530123887697, 0.111910843424114},
     {0.05, 0.116643007979271, 0.0999388484304219, 0.0311620743832557}},
    {8,
     12,
     17.0635,
     {0.882849819842751, 0.56916904510711, 0.223635224041941, 0.0396623771974345},
     {0.05, 0.128806585262036, 0.136743414543656, 0.0702750557886924, 0.0146440141420737}},
    {8,
     13,
     21.0428,
     {0.906897358495303, 0.64271872213416, 0.31444091780511, 0.0930296815063074,
      0.0125421501036054},
     {0.05, 0.137176575594152, 0.165042959049155, 0.107910894027561, 0.0380706518764899,
      0.0057633239151392}},
    {8,
     14,
     25.3505,
     {0.922303124380424, 0.693078524406098, 0.385157715690481, 0.146093720851436,
      0.0337292833427129, 0.00358760769866937},
     {0.05, 0.143211521589954, 0.186980934586778, 0.141238643418401, 0.0646467532571622,
      0.0169015357322995, 0.00196217494654426}},
};

/// \param order 4 or 8
inline std::initializer_list<StabilizedPolynomial> stabilizedPolynomials(int order) {
  return order == 4 ? kStabilizedOrder4 : kStabilizedOrder8;
}

}  // namespace spring_pendulum
