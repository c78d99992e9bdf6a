# SPDX-License-Identifier: Apache-2.0
"""A head as a closed mesh, for make_scenes.py: a sphere whose points are moved by a sum of smooth bumps."""

import math

from scene_kit import add, cross, dot, icosphere, scale, subtract, unit

AXES = (0.74, 1.0, 0.88)  # half the width, height and depth of the skull; the face looks along +z

STEP = 0.01  # of head_normal, radians: below the narrowest bump

# Where a bump sits (a direction on the unit sphere), its widths across and along the face (radians), and how far it
# pushes. Pairs are mirrored at x = 0.
BUMPS = [
    ((0, -0.2, 1), (0.1, 0.13), 0.2),         # nose
    ((0, 0.02, 1), (0.07, 0.16), 0.13),       # bridge of the nose
    ((0.12, -0.27, 1), (0.06, 0.05), 0.06),   # wings of the nose
    ((0.25, 0.26, 1), (0.2, 0.06), 0.07),     # brows
    ((0.34, 0.1, 1), (0.14, 0.1), -0.13),     # eye sockets
    ((0.33, 0.09, 1), (0.085, 0.06), 0.09),   # eyes
    ((0.62, -0.12, 1), (0.2, 0.16), 0.07),    # cheekbones
    ((0, -0.44, 1), (0.17, 0.05), 0.08),      # upper lip
    ((0, -0.58, 1), (0.14, 0.05), 0.09),      # lower lip
    ((0, -0.51, 1), (0.22, 0.03), -0.06),    # mouth
    ((0, -0.9, 1), (0.2, 0.12), 0.15),        # chin
    ((0.7, -0.8, 0.5), (0.3, 0.25), 0.12),    # jaw
    ((1, -0.05, -0.1), (0.07, 0.17), 0.18),   # ears
    ((0, -1, -0.2), (0.3, 0.3), 0.35),        # neck
    ((0, 0.15, -1), (0.7, 0.6), 0.12),        # back of the head
]


def bump_of(direction, middle, widths, height):
    """A Gaussian of the angle from its middle, its widths along the horizontal and along the meridian."""
    middle = unit(middle)
    across = unit(cross((0, 1, 0), middle)) if abs(middle[1]) < 0.99 else (1, 0, 0)
    x, y = dot(direction, across), dot(direction, cross(middle, across))
    sine = math.hypot(x, y)
    if sine == 0:
        return height if dot(direction, middle) > 0 else 0.0
    angle = math.atan2(sine, dot(direction, middle))
    return height * math.exp(-0.5 * (angle / sine) ** 2 * ((x / widths[0]) ** 2 + (y / widths[1]) ** 2))


def head_point(direction):
    """The surface point in a direction."""
    push = 1.0
    for middle, widths, height in BUMPS:
        push += bump_of(direction, middle, widths, height)
        if middle[0]:
            push += bump_of(direction, (-middle[0],) + middle[1:], widths, height)
    return tuple(push * axis * d for axis, d in zip(AXES, direction))


def head_normal(direction):
    """The surface normal there, by central differences: finer than the mesh."""
    side = unit(cross(direction, (0, 1, 0) if abs(direction[1]) < 0.9 else (1, 0, 0)))
    up = cross(side, direction)

    def slope(tangent):
        ahead, behind = (head_point(unit(add(direction, scale(tangent, step)))) for step in (STEP, -STEP))
        return subtract(ahead, behind)

    return unit(cross(slope(up), slope(side)))


def add_head(obj, centre, size, level):
    """Adds the head; `size` is half the height of its skull."""
    directions, triangles = icosphere(level)
    points = [add(centre, scale(head_point(d), size)) for d in directions]
    normals = [head_normal(d) for d in directions]
    for triangle in triangles:
        obj.face([points[i] for i in triangle], None, [normals[i] for i in triangle])
