// Complex numbers with explicit products. The bits of a std::complex product depend on how the
// standard library treats infinities and on compiler options.
#pragma once

namespace spring_pendulum {

struct Complex {
  double re;
  double im;

  constexpr Complex() : Complex(0.0) {}
  constexpr Complex(double real, double imaginary = 0.0)  // NOLINT(google-explicit-constructor)
      : re(real), im(imaginary) {}
};

inline Complex operator+(Complex a, Complex b) {
  return {a.re + b.re, a.im + b.im};
}
inline Complex operator-(Complex a, Complex b) {
  return {a.re - b.re, a.im - b.im};
}
inline Complex operator-(Complex a) {
  return {-a.re, -a.im};
}
inline Complex operator*(Complex a, Complex b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Complex operator*(double a, Complex b) {
  return {a * b.re, a * b.im};
}
inline Complex operator*(Complex a, double b) {
  return b * a;
}

inline double reciprocal(double a) {
  return 1.0 / a;
}
inline Complex reciprocal(Complex a) {
  const double scale = 1.0 / (a.re * a.re + a.im * a.im);
  return {a.re * scale, -a.im * scale};
}

}  // namespace spring_pendulum
