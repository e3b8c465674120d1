// A Rosenbrock (linearly implicit Runge-Kutta) method is its tableau. In the form that needs no
// product with the Jacobian J, Hairer and Wanner (below), eq. (IV.7.25), for z' = F(z):
//
//     (I/(hγ) - J) u_i = F(z_n + sum_{j<i} a_ij u_j) + sum_{j<i} (c_ij/h) u_j
//     z_{n+1} = z_n + sum_i m_i u_i                  error = sum_i e_i u_i
//
// One matrix, hence one factorisation a step, serves all stages. J enters the order conditions: it
// has to be the exact Jacobian at z_n.
//
// Reference: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer
// 1996, section IV.7.
#pragma once

#include <array>
#include <cstddef>

namespace spring_pendulum {

struct RosenbrockTableau {
  static constexpr std::size_t kMaxStages = 8;
  using Row = std::array<double, kMaxStages>;

  std::size_t stages = 0;
  int order = 0;
  int embedded_order = 0;
  double gamma = 0.0;
  std::array<Row, kMaxStages> a{};
  std::array<Row, kMaxStages> c{};
  Row m{};
  Row e{};
  /// Dense output: z(θ) = (1-θ) z_n + θ z_{n+1} + θ(1-θ) (k_1 + θ k_2 + θ² k_3), with
  /// k_l = sum_i d_li u_i.
  std::array<Row, 3> d{};
};

/// Rodas5P: order 5 with an error estimate of order 4, 8 stages, L-stable, stiffly accurate, made
/// so that the order does not fall on stiff problems; dense output of order 4.
///
/// G. Steinebach, BIT Numer. Math. 63 (2023) 27, doi:10.1007/s10543-023-00967-x.
inline constexpr RosenbrockTableau kRodas5PTableau{
    8,
    5,
    4,
    0.21193756319429014,
    {{{},
      {3.0},
      {2.849394379747939, 0.45842242204463923},
      {-6.954028509809101, 2.489845061869568, -10.358996098473584},
      {2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641},
      {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
       0.030198172008377946},
      {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
       0.030198172008377946, 1.0},
      {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
       0.030198172008377946, 1.0, 1.0}}},
    {{{},
      {-14.155112264123755},
      {-17.97296035885952, -2.859693295451294},
      {147.12150275711716, -1.41221402718213, 71.68940251302358},
      {165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306},
      {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
       -0.6610691825249471},
      {30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783,
       -19.097331116725623, -28.087943162872662},
      {37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047,
       -40.06618937091002, -54.66780262877968, -9.48861652309627}}},
    {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
     0.030198172008377946, 1.0, 1.0, 1.0},
    {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0},
    {{{25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
       0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493},
      {-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
       20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372},
      {11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643,
       -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722}}}};

}  // namespace spring_pendulum
