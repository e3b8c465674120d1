#!/usr/bin/env python3
"""Derives the polynomials in src/integration/taylor/stabilized_polynomials.hpp.

A method that sums the Taylor series of K terms with term j weighted by w_j has the stability
polynomial

    R(z) = sum_j w_j z^j / j! ,    w_0 = ... = w_p = 1 ,

and is of order p. The other weights are such that |R| <= 0.95 on the longest interval of the
negative real axis (1 next to 0): for every length that is a linear programme, and the longest is
found by bisection, as D. I. Ketcheson, A. J. Ahmadia, Commun. Appl. Math. Comput. Sci. 7 (2012)
247-271, doi:10.2140/camcos.2012.7.247, do it. Orders 4 and 8 are stable on a part of the
imaginary axis too; those between are not.

The error is estimated by sum_j e_j c_j h^j with e_0 = ... = e_{p-1} = 0 and e_p fixed; the others
make its largest value on the interval as small as can be, so that fast modes, which are of no
interest, do not show in it.

Needs numpy and scipy (python3-scipy). Takes a minute.
usage: stabilized_polynomials.py > polynomials.txt
"""
from math import factorial

import numpy as np
from numpy.polynomial import chebyshev, polynomial
from scipy.optimize import linprog

# order: the most terms, e_p. More terms have a longer interval still, but rounding errors grow
# like exp(|z|) within a step.
ORDERS = {4: (10, 0.2), 8: (14, 0.05)}
DAMPING = 0.95
POINTS = 800


def smallest_bound(lead, order, terms, limit, bound):
    """Least t with |lead(x) + x^(order+1) q(x)| <= t bound(x) on [-limit, 0], and that term."""
    x = -limit * (1 - np.cos(np.linspace(0, np.pi, POINTS))) / 2
    basis = [(x / limit) ** (order + 1) * chebyshev.chebval(2 * x / limit + 1, row)
             for row in np.eye(terms - order)]
    columns = np.array(basis).T
    limits = bound(x)[:, None]
    rows = np.vstack([np.hstack([columns, -limits]), np.hstack([-columns, -limits])])
    free = [(None, None)] * (terms - order) + [(0, None)]
    found = linprog(np.r_[np.zeros(terms - order), 1], A_ub=rows,
                    b_ub=np.r_[-lead(x), lead(x)], bounds=free, method="highs")
    return (found.x[-1], found.x[:-1]) if found.status == 0 else (np.inf, None)


def weights_of(q, order, limit):
    """From the Chebyshev coefficients of q to w_j for j > order."""
    powers = np.array([0.0])
    for c in chebyshev.cheb2poly(q)[::-1]:
        powers = polynomial.polyadd(polynomial.polymul(powers, [1, 2 / limit]), [c])
    return [c / limit ** (order + 1) * factorial(order + 1 + j)
            for j, c in enumerate(powers[:len(q)])]


def stability(order, terms):
    """The limit and the weights w_{p+1} to w_K."""
    def start(x):
        return sum(x ** j / factorial(j) for j in range(order + 1))

    def bound(x):
        return np.where(x > -0.3, 1.0, DAMPING)

    short, long = 1.0, float(terms) ** 2
    while long - short > 1e-6:
        middle = (short + long) / 2
        t, _ = smallest_bound(start, order, terms, middle, bound)
        short, long = (middle, long) if t <= 1.0 else (short, middle)
    return short, weights_of(smallest_bound(start, order, terms, short, bound)[1], order, short)


def error(order, terms, limit, first):
    """e_p to e_K."""
    _, q = smallest_bound(lambda x: x ** order / factorial(order), order, terms, limit, np.ones_like)
    return [first] + [first * w for w in weights_of(q, order, limit)]


def braces(numbers):
    return "{" + ", ".join(f"{t:.15g}" for t in numbers) + "}"


def main():
    for order, (most, first) in ORDERS.items():
        for terms in range(order + 1, most + 1):
            limit, weights = stability(order, terms)
            print(f"{{{order}, {terms}, {0.999 * limit:.4f}, {braces(weights)}, "
                  f"{braces(error(order, terms, limit, first))}}},", flush=True)


if __name__ == "__main__":
    main()
