#include <spring_pendulum/model/rates.hpp>

#include <algorithm>

namespace spring_pendulum {

double fastestDampingRate(const Chain& chain) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 1 < chain.size(); ++i) {
    largest = std::max(largest, chain.inverseMasses()[i] + chain.inverseMasses()[i + 1]);
  }
  return 2.0 * chain.spring().damping * largest;
}

}  // namespace spring_pendulum
