#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Derives the coefficients of kernels/numerics/real_functions.h.

Remez exchange in decimal arithmetic. Coefficients are rounded to the kernels' type one by one, from the lowest power, and
those left are fitted again, so that they make up for the roundings. Prints the C text and the largest relative error of
the function that the polynomial serves, roundings of its evaluation not included.

    tools/fit_functions.py            # all polynomials, a few seconds
    tools/fit_functions.py exp_float
"""
import decimal
import math
import struct
import sys
from decimal import Decimal

decimal.getcontext().prec = 50
ONE = Decimal(1)


def round_to_float(value):
    """The nearest float or, through Python's own type, double."""
    return Decimal(struct.unpack("f", struct.pack("f", float(value)))[0])


def round_to_double(value):
    return Decimal(float(value))


def atan(x):
    """Arc tangent by halving the angle three times, then its series."""
    for _ in range(3):
        x = x / (ONE + (ONE + x * x).sqrt())
    term, total, k = x, x, 1
    while abs(term) > Decimal("1e-52"):
        term *= -x * x
        k += 2
        total += term / k
    return 8 * total


def exp_target(r):
    """(exp(r) - 1 - r) / r^2."""
    if abs(r) < Decimal("1e-12"):
        return Decimal("0.5") + r / 6
    return (r.exp() - 1 - r) / (r * r)


def log_target(z):
    """(ln((1 + s) / (1 - s)) - 2 s) / (s z) with z = s^2."""
    s = z.sqrt()
    if s < Decimal("1e-8"):
        return Decimal(2) / 3 + 2 * z / 5
    return (((1 + s) / (1 - s)).ln() - 2 * s) / (s * z)


def pow_target(z):
    """(atanh(s) / s - 1 - z / 3) / z^2 with z = s^2."""
    s = z.sqrt()
    if s < Decimal("1e-8"):
        return ONE / 5 + z / 7
    return ((((1 + s) / (1 - s)).ln() / 2) / s - 1 - z / 3) / (z * z)


def atan_target(z):
    """(atan(a) - a) / (a z) with z = a^2."""
    a = z.sqrt()
    if a < Decimal("1e-8"):
        return -ONE / 3 + z / 5
    return (atan(a) - a) / (a * z)


# Name: function, interval, number of coefficients, rounding, weight of an error (over the served function's value).
Z_LOG = (3 - 2 * Decimal(2).sqrt()) ** 2
R_EXP = Decimal(2).ln() / 2 * Decimal("1.0001")
EXP_WEIGHT = lambda r: r * r / r.exp()
LOG_WEIGHT = lambda z: z / 2
POW_WEIGHT = lambda z: z * z
ATAN_WEIGHT = lambda z: z if z == 0 else z * z.sqrt() / atan(z.sqrt())
FITS = {
    "exp_float": (exp_target, -R_EXP, R_EXP, 5, round_to_float, EXP_WEIGHT),
    "exp_double": (exp_target, -R_EXP, R_EXP, 10, round_to_double, EXP_WEIGHT),
    "log_float": (log_target, Decimal(0), Z_LOG, 4, round_to_float, LOG_WEIGHT),
    "log_double": (log_target, Decimal(0), Z_LOG, 8, round_to_double, LOG_WEIGHT),
    "pow_float": (pow_target, Decimal(0), Z_LOG, 4, round_to_float, POW_WEIGHT),
    "pow_double": (pow_target, Decimal(0), Z_LOG, 9, round_to_double, POW_WEIGHT),
    "atan_float": (atan_target, Decimal(0), ONE, 9, round_to_float, ATAN_WEIGHT),
    "atan_double": (atan_target, Decimal(0), ONE, 20, round_to_double, ATAN_WEIGHT),
}


def solve(matrix, right):
    """Gaussian elimination with pivots."""
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    size = len(rows)
    for i in range(size):
        pivot = max(range(i, size), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, size):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    solution = [Decimal(0)] * size
    for i in reversed(range(size)):
        known = sum(rows[i][k] * solution[k] for k in range(i + 1, size))
        solution[i] = (rows[i][size] - known) / rows[i][i]
    return solution


def polynomial(coefficients, x):
    value = Decimal(0)
    for c in reversed(coefficients):
        value = value * x + c
    return value


def extrema(samples, errors, count):
    """The places of the largest errors of alternating sign."""
    runs = []
    for place, error in enumerate(errors):
        if error == 0:
            continue
        if runs and (errors[runs[-1]] > 0) == (error > 0):
            if abs(error) > abs(errors[runs[-1]]):
                runs[-1] = place
        else:
            runs.append(place)
    while len(runs) > count:
        runs.pop(0 if abs(errors[runs[0]]) < abs(errors[runs[-1]]) else -1)
    return [samples[place] for place in runs]


def remez(samples, targets, weights, fixed, count):
    """The polynomial of `count` coefficients that continues the fixed ones, with the smallest weighted error."""
    first, free = len(fixed), count - len(fixed)
    table = dict(zip(samples, zip(targets, weights)))
    usable = [x for x in samples if table[x][1] != 0 and x != 0]
    places = [usable[i * (len(usable) - 1) // free] for i in range(free + 1)]
    coefficients = list(fixed)
    for _ in range(12):
        rows, right = [], []
        for i, x in enumerate(places):
            target, weight = table[x]
            rows.append([x ** (first + k) for k in range(free)] + [(-1) ** i / weight])
            right.append(target - polynomial(fixed, x))
        coefficients = list(fixed) + solve(rows, right)[:free]
        errors = [(polynomial(coefficients, x) - t) * w for x, t, w in zip(samples, targets, weights)]
        found = extrema(samples, errors, free + 1)
        if len(found) < free + 1 or found == places:
            break
        places = found
    return coefficients


def cosine(i, steps):
    """cos(pi i / steps); a double is near enough for a place."""
    return Decimal(math.cos(math.pi * i / steps))


def fit(name):
    function, low, high, count, rounded, weight = FITS[name]
    # Chebyshev's places, dense towards the ends.
    steps = 24 * count
    samples = [(low + high) / 2 - (high - low) / 2 * cosine(i, steps) for i in range(steps + 1)]
    targets = [function(x) for x in samples]
    weights = [weight(x) for x in samples]
    fixed = []
    while len(fixed) < count:
        fixed.append(rounded(remez(samples, targets, weights, fixed, count)[len(fixed)]))
    worst = max(abs((polynomial(fixed, x) - t) * w) for x, t, w in zip(samples, targets, weights))
    print(f"{name}: largest relative error {float(worst):.2g}, 2^{float(worst.ln() / Decimal(2).ln()):.1f}")
    for power, c in enumerate(fixed):
        digits = f"{float(c):.9g}f" if rounded is round_to_float else f"{float(c):.17g}"
        print(f"    c{power} = {digits}")


if __name__ == "__main__":
    for wanted in sys.argv[1:] or FITS:
        fit(wanted)
