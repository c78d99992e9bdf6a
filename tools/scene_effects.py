# SPDX-License-Identifier: Apache-2.0
"""Scenes of single effects for make_scenes.py: what several rays make soft, shadows, reflections and what lies behind glass; and
what glass does that bends colours apart or holds something."""

import math

from scene_kit import Obj, polygon_normal, scale

# Posts between lamp and floor, metres: how far they stand apart, and their heights. A lamp of side s at the height H makes
# the penumbra at the end of the shadow of a post of height h s h / (H - h) long.
POST_STEP, POST_HEIGHTS = 0.9, (0.3, 0.6, 1.0, 1.5)
LAMP_HEIGHT = 2.4


def soft_shadows():
    obj = Obj("Posts of four heights under a large lamp and a small one")
    obj.begin("floor", "floor")
    obj.quad((-6, 0, -6), (12, 0, 0), (0, 0, 12), (0, 1, 0))
    obj.begin("wall", "wall")
    obj.quad((-6, 0, -2.5), (12, 0, 0), (0, 6, 0), (0, 0, 1))
    obj.begin("posts", "post")
    for i, height in enumerate(POST_HEIGHTS):
        x = POST_STEP * (i - (len(POST_HEIGHTS) - 1) / 2)
        obj.box((x - 0.1, 0, -0.4), (x + 0.1, height, -0.2), without=("-y",))
    obj.begin("ball", "ball")
    obj.sphere((0.2, 0.35, 0.75), 0.35, 4)
    obj.begin("large_lamp", "large_lamp")
    obj.quad((-3.8, LAMP_HEIGHT, 0.6), (1, 0, 0), (0, 0, 1), (0, -1, 0))
    obj.begin("small_lamp", "small_lamp")
    obj.quad((3.2, LAMP_HEIGHT, 1.0), (0.2, 0, 0), (0, 0, 0.2), (0, -1, 0))
    return obj


def gloss_translucency():
    obj = Obj("Floors of rising roughness, and rods behind a frosted pane at growing distances")
    for i in range(4):
        obj.begin(f"floor_{i}", f"gloss_{i}")
        obj.quad((-3 + 1.5 * i, 0, -2), (1.5, 0, 0), (0, 0, 4), (0, 1, 0))
    for material, odd in (("tile_light", 0), ("tile_dark", 1)):
        obj.begin("wall_" + material, material)
        for i in range(24):
            for k in range(10):
                if (i + k) % 2 == odd:
                    obj.quad((-3 + 0.25 * i, 0.25 * k, -2), (0.25, 0, 0), (0, 0.25, 0), (0, 0, 1))
    obj.begin("rods", "rod")
    for i in range(4):
        x, z = -0.9 + 0.6 * i, 0.2 - 0.55 * i
        obj.box((x - 0.06, 0, z - 0.06), (x + 0.06, 1.1, z + 0.06), without=("-y",))
    obj.begin("pane", "frosted")
    obj.box((-1.3, 0.45, 0.45), (1.3, 1.5, 0.47))
    obj.begin("lamp", "lamp")
    obj.quad((-1.2, 3, -0.2), (2.4, 0, 0), (0, 0, 1.6), (0, -1, 0))
    obj.begin("side_lamp", "side_lamp")
    obj.sphere((-1.75, 0.3, -1.3), 0.18, 2)
    return obj


def gem(obj, centre, radius, sides):
    """A stone cut flat: table, crown, and a point below. Every second ring is turned by half a side."""
    def ring(share, height, turn):
        angles = [2 * math.pi * (k + turn) / sides for k in range(sides)]
        return [(centre[0] + radius * share * math.cos(a), centre[1] + radius * height,
                 centre[2] - radius * share * math.sin(a)) for a in angles]

    table, girdle = ring(0.55, 0.35, 0.5), ring(1, 0, 0)
    point = (centre[0], centre[1] - 0.8 * radius, centre[2])
    faces = [table]
    for k in range(sides):
        after = (k + 1) % sides
        faces += [[girdle[k], girdle[after], table[k]], [table[k], girdle[after], table[after]],
                  [girdle[after], girdle[k], point]]
    for face in faces:
        normal = polygon_normal(face)
        middle = [sum(corner[i] - centre[i] for corner in face) for i in range(3)]
        outwards = scale(normal, 1 if sum(a * b for a, b in zip(normal, middle)) > 0 else -1)
        obj.face(face if outwards == scale(normal, 1) else face[::-1], towards=outwards)


def drink_and_gem():
    obj = Obj("A drink in a glass, which reaches into its wall, with ice in it, beside a cut stone")
    obj.begin("floor", "floor")
    obj.quad((-5, 0, -4), (10, 0, 0), (0, 0, 8), (0, 1, 0))
    obj.begin("wall", "wall")
    obj.quad((-5, 0, -4), (10, 0, 0), (0, 5, 0), (0, 0, 1))
    obj.begin("glass", "glass")
    obj.lathe((-0.55, 0.01, 0), [(0, 0), (0.5, 0), (0.5, 1.3), (0.45, 1.3), (0.45, 0.12), (0, 0.12)], 96)
    obj.begin("drink", "drink")
    obj.lathe((-0.55, 0.01, 0), [(0, 0.08), (0.475, 0.08), (0.475, 0.9), (0, 0.9)], 96)
    obj.begin("ice", "ice")
    obj.box((-0.75, 0.68, -0.2), (-0.45, 0.98, 0.1))
    obj.begin("straw", "straw")
    obj.lathe((-0.35, 0.14, 0.1), [(0, 0), (0.035, 0), (0.035, 1.7), (0, 1.7)], 24)
    obj.begin("gem", "gem")
    gem(obj, (0.75, 0.42, 0.3), 0.5, 8)
    obj.begin("lamp", "lamp")
    obj.quad((1.5, 3.2, -0.6), (0.5, 0, 0), (0, 0, 0.5), (0, -1, 0))
    return obj
