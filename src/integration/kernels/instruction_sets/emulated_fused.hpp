// Fused multiply-add for x86 processors that lack the instruction: the correctly rounded a b + c of
// two lanes, with about 60 additions and multiplications.
//
// The product and the sums are split exactly into a rounded value and its error. The last sum but
// one is rounded to odd; then the last sum is rounded as the exact value would be. Reference:
// S. Boldo, G. Melquiond, IEEE Trans. Comput. 57 (2008) 462-471, doi:10.1109/TC.2007.70819.
#pragma once

#include <cmath>
#include <cstring>

namespace spring_pendulum {
namespace {

using TwoLanes [[gnu::vector_size(16)]] = double;
using TwoWords [[gnu::vector_size(16)]] = long long;

/// value + error, exactly.
struct ExactPair {
  TwoLanes value, error;
};

/// D. E. Knuth, The Art of Computer Programming 2, section 4.2.2.
[[gnu::always_inline]] inline ExactPair exactSum(TwoLanes a, TwoLanes b) {
  const TwoLanes sum = a + b;
  const TwoLanes of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// T. J. Dekker, Numer. Math. 18 (1971) 224-242, doi:10.1007/BF01397083.
[[gnu::always_inline]] inline ExactPair exactProduct(TwoLanes a, TwoLanes b) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const TwoLanes scaled_a = kSplitter * a;
  const TwoLanes scaled_b = kSplitter * b;
  const TwoLanes high_a = scaled_a - (scaled_a - a);
  const TwoLanes high_b = scaled_b - (scaled_b - b);
  const TwoLanes low_a = a - high_a;
  const TwoLanes low_b = b - high_b;
  const TwoLanes product = a * b;
  return {product, ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b};
}

/// Returns a + b if that is exact, otherwise the adjacent double whose last bit is 1.
[[gnu::always_inline]] inline TwoLanes sumRoundedToOdd(TwoLanes a, TwoLanes b) {
  const ExactPair sum = exactSum(a, b);
  TwoWords bits;
  std::memcpy(&bits, &sum.value, sizeof(bits));
  const TwoWords change = (sum.error != 0.0) & ((bits & 1) - 1);  // -1 or 0
  const TwoWords outwards = (sum.error > 0.0) == (sum.value > 0.0);
  bits += outwards ? -change : change;
  TwoLanes odd;
  std::memcpy(&odd, &bits, sizeof(odd));
  return odd;
}

[[gnu::always_inline]] inline TwoLanes magnitude(TwoLanes a) {
  return a < 0.0 ? -a : a;
}

/// Whether no operation overflows and the error of the product does not underflow.
[[gnu::always_inline]] inline bool isOrdinary(TwoLanes a, TwoLanes b, TwoLanes c) {
  const TwoWords bounded =
      (magnitude(a) < 0x1p500) & (magnitude(b) < 0x1p500) & (magnitude(c) < 0x1p1000);
  const TwoWords no_underflow = (magnitude(a * b) > 0x1p-900) | (a == 0.0) | (b == 0.0);
  const TwoWords ordinary = bounded & no_underflow;
  return (ordinary[0] & ordinary[1]) != 0;
}

[[gnu::noinline]] TwoLanes emulatedFused(TwoLanes a, TwoLanes b, TwoLanes c) {
  if (!isOrdinary(a, b, c)) return TwoLanes{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1])};
  const ExactPair product = exactProduct(a, b);
  const ExactPair low = exactSum(c, product.error);
  const ExactPair high = exactSum(product.value, low.value);
  const TwoLanes result = high.value + sumRoundedToOdd(low.error, high.error);
  return product.value == 0.0 ? product.value + c : result;  // keeps the sign of zero
}

}  // namespace
}  // namespace spring_pendulum
