#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tabulates the directional albedos of GGX microfacets for kernels/scattering/albedo.h.

The single-scattering lobes of kernels/scattering are integrated over visible normals in double precision:

    loss L = 1 - (what a lossless lobe sends on), of reflection and of a dielectric of relative index eta, and
    B = what a reflection with the reflectance (1 - cos)^5 sends back: Schlick's lobe of any F0 sends F0 (1 - L) + (1 - F0) B.

Both vary on two scales, the cosine's and cosine over alpha. The tables hold functions that are smooth on either: with
z = alpha / (cos + alpha), L = z^2 h and B = (1 - L) (1 - cos - alpha k)^5; h and k over the coordinates of `Axes`. Between the
nodes the kernels interpolate linearly. The nodes are moved until L is nowhere more than TOLERANCE above the integral and B
nowhere below it, so that what is made from them does not give back more light than it gets. The hemispherical means belong
to the interpolated functions, not to the exact ones, and are rounded upwards: they divide.

    tools/fit_albedo.py      # minutes; writes the tables of kernels/scattering
"""
import os

import numpy as np

SMALLEST_ALPHA = 1e-4
SMALLEST_ASPECT = 0.1     # alpha_y / alpha_x of aniso 1
LARGEST_CONTRAST = 0.45   # of the indices, |eta - 1| / (eta + 1): beyond eta = 2.6 the tables stay as they are
TOLERANCE = 2e-4
TOLERANCE_STRETCHED = -5e-4  # too few nodes to check all the places between them
CODE_MAX = 65535
WIDTH = 124               # columns of a table's lines
KERNELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "kernels", "scattering")


def smith_lambda(slope, z):
    """Smith's Lambda of GGX from (alpha w)^2 and |w.z|."""
    z = np.abs(z)
    return 0.5 * slope / (z * (z + np.sqrt(z * z + slope)))


class Quadrature:
    """Midpoints over the random numbers of a visible normal, dense where the cap's height is extreme: what a smooth surface
    loses head-on comes from normals with a chance of alpha^2."""

    def __init__(self, heights, turns):
        v = (np.arange(heights) + 0.5) / heights
        a, b = v**6, (1 - v)**6
        weight = 6 * (v * (1 - v))**5 / (a + b)**2 / heights
        self.low, self.high = (a / (a + b))[:, None], (b / (a + b))[:, None]
        self.weight = np.repeat(weight[:, None] / turns, turns, axis=1)
        self.turn = 2 * np.pi * (np.arange(turns) + 0.5) / turns

    def normals(self, wo, ax, ay):
        """Dupuy and Benyoub (2023): a point of a cap plus the stretched direction."""
        s = np.array([wo[0] * ax, wo[1] * ay, wo[2]])
        s /= np.linalg.norm(s)
        turn = self.turn + np.arctan2(s[1], s[0])
        up, down = self.high * (1 + s[2]) + (1 - s[2]), self.low * (1 + s[2])  # 1 + z and 1 - z
        r = np.sqrt(up * down)
        x, y = (r * np.cos(turn) + s[0]) * ax, (r * np.sin(turn) + s[1]) * ay
        z = np.broadcast_to(self.high * (1 + s[2]), x.shape)
        scale = 1 / np.sqrt(x * x + y * y + z * z)
        return x * scale, y * scale, z * scale

    def albedo(self, cosine, azimuth, ax, ay, eta=None):
        """L and B of reflection, or L of a dielectric."""
        sine = np.sqrt((1 - cosine) * (1 + cosine))
        wo = (sine * np.cos(azimuth), sine * np.sin(azimuth), cosine)
        hx, hy, hz = self.normals(wo, ax, ay)
        c = np.clip(wo[0] * hx + wo[1] * hy + wo[2] * hz, 0, 1)
        seen = 1 + smith_lambda((ax * wo[0])**2 + (ay * wo[1])**2, cosine)

        def lost(x, y, z):
            hidden = smith_lambda((ax * x)**2 + (ay * y)**2, np.where(z > 0, z, 1))
            return np.where(z > 0, hidden / (seen + hidden), 1)

        reflected = lost(2 * c * hx - wo[0], 2 * c * hy - wo[1], 2 * c * hz - wo[2])
        if eta is None:
            return np.sum(self.weight * reflected), np.sum(self.weight * (1 - reflected) * (1 - c)**5)
        root = 1 - eta * eta * (1 - c * c)
        t = np.sqrt(np.maximum(root, 0))
        s, p = (eta * c - t) / (eta * c + t), (c - eta * t) / (c + eta * t)
        f = np.where(root > 0, 0.5 * (s * s + p * p), 1)
        m = eta * c - t
        refracted = lost(m * hx - eta * wo[0], m * hy - eta * wo[1], eta * wo[2] - m * hz)
        return (np.sum(self.weight * (f * reflected + (1 - f) * refracted)),)


def cosine_of(x, alpha):
    """The cosine at a coordinate: x^(4/3) = cos (1 + alpha) / (cos + alpha)."""
    x = x**(4 / 3)
    return np.clip(alpha * x / (1 + alpha - x), 1e-7 * alpha, 1)


def alpha_of(y):
    """Roughness at a coordinate: its fourth root is linear."""
    low = SMALLEST_ALPHA**0.25
    return (low + (1 - low) * y)**4


def eta_of(s, inside):
    """Relative index at a coordinate: the root of the contrast."""
    contrast = np.maximum(LARGEST_CONTRAST * s * s, 1e-9)
    eta = (1 + contrast) / (1 - contrast)
    return eta if inside else 1 / eta


def stretched_of(alpha, aspect, spread):
    """alpha_x, alpha_y and the azimuth: aspect and the roughness along the azimuth as coordinates."""
    root = (1 + (SMALLEST_ASPECT**0.25 - 1) * aspect)**2  # sqrt(alpha_y / alpha_x)
    ax, ay = alpha / root, alpha * root
    along = ay + spread * (ax - ay)
    share = (along * along - ay * ay) / np.maximum(ax * ax - ay * ay, 1e-30)
    return ax, ay, np.arccos(np.sqrt(np.clip(share, 0, 1)))


def corners(shape, places):
    """Indices and weights of the nodes around each place; the first axis varies slowest."""
    index, weight = np.zeros((len(places), 1), int), np.ones((len(places), 1))
    for size, v in zip(shape, np.clip(places, 0, 1).T):
        v = v * (size - 1)
        node = np.minimum(v.astype(int), size - 2)
        f = (v - node)[:, None]
        index = np.concatenate([index * size + node[:, None], index * size + node[:, None] + 1], axis=1)
        weight = np.concatenate([weight * (1 - f), weight * f], axis=1)
    return index, weight


def lower(table, shape, places, bound):
    """Moves nodes down until the interpolated function is below the bound at all places."""
    index, weight = corners(shape, places)
    step = weight / np.sum(weight * weight, axis=1, keepdims=True)
    values = table.ravel().copy()
    for _ in range(40):
        excess = np.maximum(np.sum(weight * values[index], axis=1) - bound, 0)
        change = np.zeros_like(values)
        np.maximum.at(change, index, excess[:, None] * step * 0.7)
        values -= change
    return values.reshape(shape)


def interpolate(table, places):
    index, weight = corners(table.shape, places)
    return np.sum(weight * table.ravel()[index], axis=1)


def scattered(places, dimensions, seed):
    """Places between the nodes, more of them at the first and the last nodes of the first and the last axis."""
    between = np.random.default_rng(seed).random((places, dimensions))
    between[0::8, -1] = 1  # head-on
    between[1::8, -1] **= 4
    if dimensions == 3:
        between[2::4, 0] **= 3  # indices that are nearly equal
    if dimensions == 4:  # the strongest stretch, along and across it
        between[2::4, 0] = 1
        between[3::3, 1] = np.round(between[3::3, 1])
    return between


class Table:
    """h, and k for reflection, over a grid; `point` gives (cosine, azimuth, alpha_x, alpha_y, eta) of a place."""

    def __init__(self, name, shape, point, quadrature, places, seed, tolerance=TOLERANCE):
        self.name, self.shape, self.point, self.quadrature = name, shape, point, quadrature
        grid = np.stack(np.meshgrid(*[np.linspace(0, 1, n) for n in shape], indexing="ij"), axis=-1).reshape(-1, len(shape))
        self.h, self.k = self.smooth(*self.integrate(grid))
        self.h = self.h.reshape(shape)
        between = scattered(places, len(shape), seed)
        truth = self.integrate(between)
        z2 = self.squared(truth[0])
        self.h = np.maximum(self.coded(lower(self.h, shape, between, (truth[1][:, 0] + tolerance) / z2), "h"), 0)
        if self.k is None:
            return
        # Head-on B vanishes and says nothing about k: go on as before.
        self.k = self.k.reshape(shape)
        self.k[..., -1] = 2 * self.k[..., -2] - self.k[..., -3]
        (cosine, alpha), loss = truth[0], z2 * interpolate(self.h, between)
        least = np.maximum(truth[1][:, 1] - tolerance, 1e-30) / (1 - loss)
        self.k = self.coded(lower(self.k, shape, between, (1 - least**0.2 - cosine) / alpha), "k")

    @staticmethod
    def squared(place):
        return (place[1] / (place[0] + place[1]))**2

    def integrate(self, places):
        points = [self.point(*place) for place in places]
        values = np.array([self.quadrature.albedo(*point) for point in points])
        points = np.array([(p[0], np.sqrt(p[2] * p[3])) for p in points])
        return points.T, values

    def smooth(self, place, values):
        h = values[:, 0] / self.squared(place)
        if values.shape[1] == 1:
            return h, None
        return h, (1 - (values[:, 1] / (1 - values[:, 0]))**0.2 - place[0]) / place[1]

    def coded(self, values, which):
        """Rounded down to codes of 16 bits; keeps them, their first value and their step."""
        low = 0.0 if which == "h" else float(np.floor(values.min() * 8) / 8)
        step = float(2.0**np.ceil(np.log2((values.max() - low) / CODE_MAX)))
        codes = np.floor(np.maximum(values - low, 0) / step).astype(int)
        setattr(self, "code_" + which, (codes, low, step))
        return low + step * codes

    def mean(self, front, alpha, turns=1):
        """Hemispherical means of the interpolated L and B; `front` gives the coordinates but the cosine's of an azimuth."""
        # Between nodes by Gauss over the logarithm of cos + alpha.
        nodes, weights = np.polynomial.legendre.leggauss(12)
        edges = np.log(cosine_of(np.linspace(0, 1, self.shape[-1]), alpha) + alpha)
        width = np.diff(edges)[:, None]
        sum_ = np.exp(edges[:-1, None] + width * (nodes + 1) / 2)
        cosine = np.maximum(sum_ - alpha, 0).ravel()
        weight = (width * weights / 2 * sum_).ravel() * 2 * cosine
        x = (cosine * (1 + alpha) / (cosine + alpha))**0.75
        total = np.zeros(2)
        for turn in (np.arange(turns) + 0.5) / turns * np.pi / 2:
            places = np.column_stack([np.tile(front(turn), (len(x), 1)), x])
            loss = (alpha / (cosine + alpha))**2 * interpolate(self.h, places)
            total[0] += np.sum(weight * loss) / turns
            if self.k is not None:
                seen = np.clip(cosine + alpha * interpolate(self.k, places), 0, 1)
                total[1] += np.sum(weight * (1 - loss) * (1 - seen)**5) / turns
        return total / [alpha * alpha, 1]


def means(table, shape, place, places, seed, turns=1):
    """Means over alpha and what else the table depends on: those of L, over alpha^2, at least what they stand for; those of
    B at most."""
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, n) for n in shape], indexing="ij"), axis=-1).reshape(-1, len(shape))
    between = np.random.default_rng(seed).random((places, len(shape)))
    exact, checked = (np.array([table.mean(*place(p), turns) for p in q]) for q in (grid, between))
    loss = -lower(-exact[:, 0], shape, between, -checked[:, 0])
    return loss.reshape(shape), lower(exact[:, 1], shape, between, checked[:, 1]).reshape(shape)


def rows(codes, width=WIDTH):
    """Numbers in lines of at most `width` columns."""
    lines, line = [], "   "
    for code in codes:
        if len(line) + len(code) + 2 > width:
            lines.append(line)
            line = "   "
        line += " " + code + ","
    return "\n".join(lines + [line])


def code_text(table, which):
    codes, low, step = getattr(table, "code_" + which)
    name = "ALBEDO_%s_%s" % (table.name, which.upper())
    return "#define %s_LOW REAL(%r)\n#define %s_STEP REAL(%r)\nconstant ushort %s[] = {\n%s};\n" % (
        name, low, name, step, name, rows(["%d" % code for code in codes.ravel()]))


def mean_text(name, values):
    return "constant float ALBEDO_%s[] = {\n%s};\n" % (name, rows(["%.6ef" % v for v in values.ravel()]))


def write(name, summary, text):
    guard = "CLRT_SCATTERING_ALBEDO_%s_TABLE_H" % name.upper()
    with open(os.path.join(KERNELS, "albedo_%s_table.h" % name), "w") as out:
        out.write("// SPDX-License-Identifier: Apache-2.0\n// %s; see albedo.h. Generated by tools/fit_albedo.py.\n"
                  "#ifndef %s\n#define %s\n\n%s\n#endif\n" % (summary, guard, guard, text))


def sizes(prefix, **counts):
    return "".join("#define ALBEDO_%s_%s %du\n" % (prefix, name, count) for name, count in counts.items())


MEAN_ALPHAS = 32


def reflection(quadrature):
    def point(y, x):
        return cosine_of(x, alpha_of(y)), 0, alpha_of(y), alpha_of(y)

    table = Table("REFLECTION", (32, 32), point, quadrature, 8000, 1)
    loss, schlick = means(table, (MEAN_ALPHAS,), lambda p: (lambda turn: p, alpha_of(p[0])), 200, 2)
    return (sizes("REFLECTION", ALPHAS=32, COSINES=32) + "\n" + code_text(table, "h") + "\n" + code_text(table, "k") + "\n" +
            mean_text("REFLECTION_MEAN_LOSS", loss) + mean_text("REFLECTION_MEAN_B", schlick))


def dielectric(quadrature, inside):
    def point(s, y, x):
        return cosine_of(x, alpha_of(y)), 0, alpha_of(y), alpha_of(y), eta_of(s, inside)

    name = "INSIDE" if inside else "OUTSIDE"
    table = Table(name, (9, 16, 16), point, quadrature, 32000, 3)
    loss, _ = means(table, (9, MEAN_ALPHAS), lambda p: (lambda turn: p, alpha_of(p[1])), 1500, 4)
    return code_text(table, "h") + mean_text(name + "_MEAN_LOSS", loss)


def stretched_means(table):
    """Along the narrow alpha the interpolated functions change within few degrees: many azimuths."""
    def place(p):
        alpha = alpha_of(p[1])
        ax, ay, _ = stretched_of(alpha, p[0], 0)

        def front(turn):
            along = np.hypot(ax * np.cos(turn), ay * np.sin(turn))
            return np.array([p[0], (along - ay) / (ax - ay) if ax > ay else 0, p[1]])

        return front, alpha

    return means(table, (5, MEAN_ALPHAS), place, 300, 6, 96)


def stretched(quadrature):
    def point(aspect, spread, y, x):
        ax, ay, azimuth = stretched_of(alpha_of(y), aspect, spread)
        return cosine_of(x, alpha_of(y)), azimuth, ax, ay

    table = Table("STRETCHED", (5, 5, 10, 16), point, quadrature, 44000, 5, TOLERANCE_STRETCHED)
    loss, schlick = stretched_means(table)
    return (sizes("STRETCHED", ASPECTS=5, SPREADS=5, ALPHAS=10, COSINES=16) + "\n" + code_text(table, "h") +
            code_text(table, "k") + mean_text("STRETCHED_MEAN_LOSS", loss) + mean_text("STRETCHED_MEAN_B", schlick))


def main():
    coordinates = ("#define ALBEDO_SMALLEST_ALPHA REAL(%g)\n#define ALBEDO_MEAN_ALPHAS %du\n\n" % (SMALLEST_ALPHA, MEAN_ALPHAS))
    contrast = "#define ALBEDO_LARGEST_CONTRAST REAL(%g)\n" % LARGEST_CONTRAST
    aspect = "#define ALBEDO_SMALLEST_ASPECT REAL(%g)\n" % SMALLEST_ASPECT
    write("reflection", "Directional albedos of GGX reflection", coordinates + reflection(Quadrature(320, 128)))
    sides = [dielectric(Quadrature(96, 64), inside) for inside in (False, True)]
    write("dielectric", "Directional albedos of rough dielectrics", contrast +
          sizes("DIELECTRIC", CONTRASTS=9, ALPHAS=16, COSINES=16) + "\n" + "\n".join(sides))
    write("stretched", "Directional albedos of stretched GGX reflection", aspect + stretched(Quadrature(96, 96)))


if __name__ == "__main__":
    main()
