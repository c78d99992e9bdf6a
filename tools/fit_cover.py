#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes kernels/scattering/cover_table.h: what a rough reflection below a coat shares of the light that the coat leaves.

A coat leaves the share p(w) of light along w. Below it lies a white lobe f with the integral 1 (GGX facets by their
visible normals, and the light of more than one facet as kernels/scattering/bsdf_energy.h has it). The coupling
f(o, i) s(o) s(i) is reciprocal, and it keeps all light where s(o) integral f(o, i) s(i) = p(o): a symmetric kernel is
scaled to given row sums (Sinkhorn 1964). The limits are s = sqrt(p) of a mirror and s = p / sqrt(mean p) of what
scatters everywhere; between them s = p / sqrt(p - d). The table holds d, which is 0 for a mirror, by the roots of the
coat's alpha, of the lobe's and of the cosine. The coat has the index 1.5 (Schlick).
"""
import sys

import numpy as np

NODES = 10  # of sqrt(alpha) and of sqrt(cos)
COAT_NODES = 4  # of the root of the coat's alpha
FINE = 96  # cosines of the scaling
SAMPLES = 16384
F0 = 0.04


def fresnel(cosine):
    return F0 + (1 - F0) * (1 - cosine) ** 5


def coat_albedo(alpha, cosines):
    """What the coat reflects."""
    if alpha == 0:
        return fresnel(cosines)
    sums = []
    for cosine in cosines:
        _, weight, cos_h = facet_samples(alpha, cosine)
        sums.append((weight * fresnel(cos_h)).mean())
    return np.array(sums)


def facet_samples(alpha, cos_o):
    """Cosines of reflected directions, the weights of their samples, and cosines on the facets (Heitz 2018)."""
    k = np.arange(SAMPLES)
    u, turn = (k + 0.5) / SAMPLES, 2 * np.pi * (k * 0.6180339887498949 % 1)
    sin_o = np.sqrt(1 - cos_o**2)
    view = np.array([alpha * sin_o, 0, cos_o])
    view /= np.linalg.norm(view)
    up = np.array([-view[2], 0, view[0]])
    x, y = np.sqrt(u) * np.cos(turn), np.sqrt(u) * np.sin(turn)
    blend = 0.5 * (1 + view[2])
    y = (1 - blend) * np.sqrt(1 - x * x) + blend * y
    z = np.sqrt(np.maximum(0, 1 - x * x - y * y))
    normal = np.outer(x, [0, 1, 0]) + np.outer(y, up) + np.outer(z, view)
    half = normal * [alpha, alpha, 1]
    half[:, 2] = np.maximum(half[:, 2], 1e-9)
    half /= np.linalg.norm(half, axis=1)[:, None]
    out = np.array([sin_o, 0, cos_o])
    cos_h = half @ out
    cos_i = 2 * cos_h * half[:, 2] - cos_o
    is_above = cos_i > 1e-6
    cos_i = np.where(is_above, cos_i, 1)

    def masked(cosine):
        return 0.5 * (np.sqrt(1 + alpha**2 * (1 / cosine**2 - 1)) - 1)

    weight = np.where(is_above, (1 + masked(cos_o)) / (1 + masked(cos_o) + masked(cos_i)), 0)
    return cos_i, weight, np.clip(cos_h, 0, 1)


def lobe(alpha, cosines):
    """The lobe as a matrix: row o, column i, rows of the sum 1."""
    fine = np.zeros((len(cosines), len(cosines)))
    lost = np.zeros(len(cosines))
    for row, cosine in enumerate(cosines):
        cos_i, weight, _ = facet_samples(alpha, cosine)
        place = np.interp(cos_i, cosines, np.arange(len(cosines)))
        low = np.minimum(place.astype(int), len(cosines) - 2)
        np.add.at(fine[row], low, weight * (low + 1 - place) / SAMPLES)
        np.add.at(fine[row], low + 1, weight * (place - low) / SAMPLES)
        lost[row] = 1 - fine[row].sum()
    width = np.gradient(cosines**2) * lost
    return fine + np.outer(lost, width / width.sum())


def row_of(matrix, cosines, albedo, nodes):
    """The table's row of a lobe and a coat."""
    if matrix is None:
        return np.zeros(len(nodes))
    share = 1 - albedo
    s = np.sqrt(share)
    for _ in range(2000):
        s = np.sqrt(s * share / (matrix @ s))
    error = np.abs(s * (matrix @ s) / share - 1).max()
    print(f"rows are off by at most {error:.1e}", file=sys.stderr)
    return np.interp(nodes, cosines, share - (share / s) ** 2)


def main():
    nodes = np.linspace(0, 1, NODES) ** 2
    cosines = np.linspace(0.02, 1, FINE) ** 2
    lobes = [None if alpha == 0 else lobe(alpha, cosines) for alpha in nodes]
    print("""// SPDX-License-Identifier: Apache-2.0
// Written by tools/fit_cover.py, which says what it holds: numbers by the roots of the coat's alpha (blocks),
// of the lobe's (rows) and of the cosine.
#ifndef CLRT_SCATTERING_COVER_TABLE_H
#define CLRT_SCATTERING_COVER_TABLE_H
""")
    print(f"#define COVER_COATS {COAT_NODES}u\n#define COVER_NODES {NODES}u\n")
    print("constant float COVER_SPREAD[COVER_COATS * COVER_NODES * COVER_NODES] = {")
    for coat in np.linspace(0, 1, COAT_NODES) ** 2:
        albedo = coat_albedo(coat, cosines)
        for matrix in lobes:
            print("    " + ", ".join(f"{a:.5f}f" for a in row_of(matrix, cosines, albedo, nodes)) + ",")
    print("};\n\n#endif")


main()
