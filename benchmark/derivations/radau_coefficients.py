#!/usr/bin/env python3
"""Derives the coefficients in src/integration/implicit/radau_coefficients.hpp.

Radau IIA with s = 5 stages (order 9) is collocation at the zeros of P_s - P_{s-1} on [0, 1]. The
inverse of its matrix A has one real eigenvalue and two complex pairs. With left and right
eigenvectors l and r (l r = 1), the change of the stages is the sum of r (l residual) / eigenvalue
over the eigenvalues; a pair gives twice the real part, which is put into r here.

The embedded formula has the weight 1/real eigenvalue for the slope at the start and integrates
polynomials of degree s - 1 exactly; its difference to the method is

    error = h / real eigenvalue * f_0 + sum_i e_i Z_i .

E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, sections
IV.5 and IV.8; the same, J. Comput. Appl. Math. 111 (1999) 93-111 (order 9).

Needs mpmath (python3-mpmath). usage: radau_coefficients.py
"""
from mpmath import mp, mpf, matrix, polyroots, taylor, legendre, eig, nstr, re, im, inverse, chop

mp.dps = 60
STAGES = 5


def shifted_legendre(n):
    """Coefficients of P_n(2x - 1), highest power first."""
    return taylor(lambda x: legendre(n, 2 * x - 1), 0, n)[::-1]


def nodes():
    high, low = shifted_legendre(STAGES), shifted_legendre(STAGES - 1)
    roots = polyroots([a - b for a, b in zip(high, [mpf(0)] + low)], maxsteps=500, extraprec=500)
    return sorted(re(root) for root in roots)


def collocation_matrix(c):
    """a_ij with sum_j a_ij c_j^(k-1) = c_i^k / k."""
    powers = matrix(STAGES, STAGES)
    integrals = matrix(STAGES, STAGES)
    for i in range(STAGES):
        for k in range(STAGES):
            powers[i, k] = c[i] ** k
            integrals[i, k] = c[i] ** (k + 1) / (k + 1)
    return integrals * inverse(powers), powers


def row(values):
    return '{' + ', '.join(nstr(value, 20) for value in values) + '}'


def complex_row(values):
    return '{{' + ', '.join('{%s, %s}' % (nstr(re(v), 20), nstr(im(v), 20)) for v in values) + '}}'


c = nodes()
a, powers = collocation_matrix(c)
values, left, right = eig(inverse(a), left=True, right=True)
print('nodes', row(c))
for i in range(STAGES):
    print('a', row(a[i, j] for j in range(STAGES)))
for k in sorted(range(STAGES), key=lambda k: (abs(im(values[k])), im(values[k]))):
    if im(values[k]) < -mpf(10) ** -30:
        continue
    l, r = left[k, :], right[:, k]
    product = sum(l[i] * r[i] for i in range(STAGES))
    scale = r[STAGES - 1]  # the end of the step counts 1
    r = [r[i] / scale for i in range(STAGES)]
    l = [l[i] * scale / product for i in range(STAGES)]
    if abs(im(values[k])) < mpf(10) ** -30:
        real = re(values[k])
        print('real', nstr(real, 20), row(map(re, l)), row(map(re, r)))
    else:
        print('pair', nstr(re(values[k]), 20), nstr(im(values[k]), 20), complex_row(l),
              complex_row([2 * x for x in r]))
unit = matrix(STAGES, 1)
unit[0] = -1 / real
difference = inverse(powers.T) * unit  # weights of the embedded formula less those of the method
e = difference.T * inverse(a)
print('error', row(e[i] for i in range(STAGES)))
