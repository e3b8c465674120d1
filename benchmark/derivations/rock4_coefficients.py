#!/usr/bin/env python3
"""Derives the coefficients of the stabilised methods in src/integration/rock4_coefficients.cpp.

The construction is that of A. Abdulle, SIAM J. Sci. Comput. 23 (2002) 2041-2054,
doi:10.1137/S1064827500379549. A method of s stages has the stability polynomial

    R(x) = w(x) P(x) / (w(a) P(a)) ,    x = a + z/d ,

where w has two pairs of complex zeros and P, of degree s - 4, is orthogonal to all lower ones on
[-1, 1] for the weight w(x)^2 / sqrt(1 - x^2), so that R swings between nearly equal bounds there.
The zeros and a are such that R agrees with exp(z) to order 4 and |R| stays below 0.95 on [-1, 1].
P is run by its three-term recurrence, w by four more stages whose coefficients make all eight
conditions of order 4 hold for the whole method. What these leave free makes the terms of order 5
small. The error estimate is the only combination of the last five slopes that vanishes to order
3, scaled so that its four terms of order 4 have the norm 0.01.

Needs numpy, scipy and mpmath (python3-scipy, python3-mpmath). Takes a minute.
usage: rock4_coefficients.py > coefficients.txt
"""
import mpmath as mp
import numpy as np
from scipy.optimize import least_squares

STAGES = [5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20, 23, 26, 30]
DAMPING = 0.95
mp.mp.dps = 40


def weight(zeros, x):
    (re1, im1), (re2, im2) = zeros
    return ((x - re1) ** 2 + im1**2) * ((x - re2) ** 2 + im2**2)


def orthogonal_recurrence(zeros, degree, nodes, cos, pi):
    """Rows (alpha, beta) of p_j = (x - alpha) p_{j-1} - beta p_{j-2}, by Gauss-Chebyshev sums."""
    x = [cos((2 * k + 1) * pi / (2 * nodes)) for k in range(nodes)]
    w = [weight(zeros, t) ** 2 for t in x]
    before, last, norm, rows = [0 * t for t in x], [0 * t + 1 for t in x], None, []
    for _ in range(degree):
        square = sum(v * p * p for v, p in zip(w, last))
        alpha = sum(v * t * p * p for v, t, p in zip(w, x, last)) / square
        beta = square / norm if norm else 0 * square
        before, last, norm = (
            last, [(t - alpha) * p - beta * q for t, p, q in zip(x, last, before)], square)
        rows.append((alpha, beta))
    return rows


def taylor(zeros, rows, a):
    """Coefficients of w P around a, to order 4."""
    def times(u, v):
        return np.convolve(u, v)[:5]

    def minus(c):
        return np.array([a - c, 1.0, 0.0, 0.0, 0.0])

    before, last = np.zeros(5), np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    for alpha, beta in rows:
        before, last = 2 * last, 2 * (times(minus(alpha), last) - beta * before)
    for re, im in zeros:
        factor = times(minus(re), minus(re))
        factor[0] += im**2
        last = times(last, factor)
    return last


def largest_on_interval(zeros, rows, points):
    x = np.cos(np.linspace(0.0, np.pi, points))
    before, last = 0 * x, 0 * x + 1
    for alpha, beta in rows:
        before, last = 2 * last, 2 * ((x - alpha) * last - beta * before)
    return np.abs(weight(zeros, x) * last).max()


def solve_polynomial(stages, re1, start):
    """Zeros of w and a; re1 is free (it hardly matters) and kept."""
    def unpack(v):
        zeros = ((re1, v[0]), (v[1], v[2]))
        rows = orthogonal_recurrence(zeros, stages - 4, 4 * stages + 40, np.cos, np.pi)
        t = taylor(zeros, rows, v[3])
        return zeros, rows, t / t[0], t[0]

    def residual(v):
        zeros, rows, t, scale = unpack(v)
        bound = largest_on_interval(zeros, rows, 60 * stages + 1) / abs(scale)
        return [2 * t[2] / t[1] ** 2 - 1, 6 * t[3] / t[1] ** 3 - 1, 24 * t[4] / t[1] ** 4 - 1,
                10 * (bound - DAMPING)]

    v = least_squares(residual, start, xtol=1e-15, ftol=1e-15, gtol=1e-15).x
    zeros, _, t, _ = unpack(v)
    return zeros, v[3], t[1]


def recurrence(zeros, degree, a, d):
    """Rows (mu, kappa) of K_j = K_{j-1} + kappa (K_{j-2} - K_{j-1}) + mu h F(K_{j-1})."""
    zeros = [(mp.mpf(re), mp.mpf(im)) for re, im in zeros]
    a, before, last, result = mp.mpf(a), mp.mpf(0), mp.mpf(1), []
    for alpha, beta in orthogonal_recurrence(zeros, degree, 2 * degree + 30, mp.cos, mp.pi):
        new = (a - alpha) * last - beta * before
        result.append((last / new / d, -beta * before / new))
        before, last = last, new
    return result


def tableau(rows, finish):
    """The whole method: rows of A for the stages, the new state and the slope after it."""
    n = len(rows)
    a = np.array([[finish[0] * 0] * (n + 5) for _ in range(n + 5)], dtype=object)
    inner = [a[0, :].copy()]
    for j, (mu, kappa) in enumerate(rows):
        new = inner[j] + kappa * (inner[max(j - 1, 0)] - inner[j])
        new[j] += mu
        inner.append(new)
    for j in range(n):
        a[j, :] = inner[j]
    for i in range(5):
        a[n + i, :] = inner[n]
    a21, a31, a32, a41, a42, a43 = finish[:6]
    a[n + 1, n] += a21
    a[n + 2, n:n + 2] += np.array([a31, a32], dtype=object)
    a[n + 3, n:n + 3] += np.array([a41, a42, a43], dtype=object)
    a[n + 4, n:n + 4] += np.array(finish[6:], dtype=object)
    return a


def elementary_weights(a):
    """Vectors phi(t) and densities of the 8 trees up to order 4, then the 9 of order 5."""
    one = np.array([a[0, 0] * 0 + 1] * len(a))
    c = a.dot(one)
    ac, ac2 = a.dot(c), a.dot(c * c)
    aac = a.dot(ac)
    low = [(one, 1), (c, 2), (c * c, 3), (ac, 6), (c**3, 4), (c * ac, 8), (ac2, 12), (aac, 24)]
    high = [(c**4, 5), (c * c * ac, 10), (c * ac2, 15), (c * aac, 30), (ac * ac, 20),
            (a.dot(c**3), 20), (a.dot(c * ac), 40), (a.dot(ac2), 60), (a.dot(aac), 120)]
    return low, high


SYMMETRY_LOW = [1, 1, 2, 1, 6, 1, 2, 1]
SYMMETRY_HIGH = [24, 2, 2, 1, 2, 6, 1, 2, 1]


def order_residuals(a):
    low, high = elementary_weights(a[:-1, :-1])
    b = a[-1, :-1]
    exact = [b.dot(phi) - b[0] * 0 - (b[0] * 0 + 1) / g for phi, g in low]
    return exact, [(b.dot(p) - (b[0] * 0 + 1) / g) / s for (p, g), s in zip(high, SYMMETRY_HIGH)]


def solve_finish(rows, start):
    """The ten coefficients of the last four stages: fit in doubles, then Newton in 40 digits."""
    coarse = [(float(mu), float(kappa)) for mu, kappa in rows]

    def residual(v):
        low, high = order_residuals(tableau(coarse, list(v)))
        return np.array([1e4 * t for t in low] + [30 * t for t in high] + [1e-2 * t for t in v],
                        dtype=float)

    v = [mp.mpf(float(t)) for t in
         least_squares(residual, start, xtol=1e-14, ftol=1e-14, max_nfev=400).x]
    for _ in range(6):
        value = mp.matrix(order_residuals(tableau(rows, v))[0])
        slope = mp.matrix(8, 10)
        for k in range(10):
            moved = [t + (mp.mpf(10) ** -18 if i == k else 0) for i, t in enumerate(v)]
            change = (mp.matrix(order_residuals(tableau(rows, moved))[0]) - value) * mp.mpf(10)**18
            for i in range(8):
                slope[i, k] = change[i]
        step = slope.T * mp.lu_solve(slope * slope.T, value)
        v = [t - step[i] for i, t in enumerate(v)]
    return v


def error_weights(rows, finish):
    low, _ = elementary_weights(tableau(rows, finish))
    n = len(rows)
    matrix = mp.matrix(4, 4)
    right = mp.matrix(4, 1)
    for i in range(4):
        for j in range(4):
            matrix[i, j] = low[i][0][n + j]
        right[i] = -low[i][0][n + 4]
    e = list(mp.lu_solve(matrix, right)) + [mp.mpf(1)]
    terms = [sum(e[j] * low[i][0][n + j] for j in range(5)) / SYMMETRY_LOW[i] for i in range(4, 8)]
    return [t * mp.mpf("0.01") / mp.sqrt(sum(q * q for q in terms)) for t in e]


def braces(numbers):
    return "{" + ", ".join(mp.nstr(t, 18) for t in numbers) + "}"


def main():
    re1, start, before = 0.7754, np.array([0.486, 1.5757, 1.2773, 1.675]), STAGES[0]
    finish = np.array([-0.126, 1.264, -0.85, 0.036, 0.048, 0.561, 0.61, -0.327, 0.152, 0.388])
    for stages in STAGES:
        q = (before / stages) ** 2  # the polynomials near x = 1 look alike when scaled so
        re1 = 1 - (1 - re1) * q
        start = np.array([start[0] * q, 1 - (1 - start[1]) * q, start[2] * q,
                          1 + (start[3] - 1) * q])
        zeros, a, d = solve_polynomial(stages, re1, start)
        start, before = np.array([zeros[0][1], zeros[1][0], zeros[1][1], a]), stages
        rows = recurrence(zeros, stages - 4, a, mp.mpf(d))
        coefficients = solve_finish(rows, finish)
        finish = np.array([float(t) for t in coefficients])
        print(f"{{{stages}, {(1 + a) * d:.4f},\n{{{', '.join(braces(r) for r in rows)}}},\n"
              f"{braces(coefficients)},\n{braces(error_weights(rows, coefficients))}}},", flush=True)


if __name__ == "__main__":
    main()
