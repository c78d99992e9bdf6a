# SPDX-License-Identifier: Apache-2.0
"""Scenes that sun and sky light through water and glass, or alone, for make_scenes.py."""

import math

from scene_kit import Obj, unit
from scene_rooms import chair, room, table

# The pool, metres: half its width, half its length, and how deep the water is.
POOL_X, POOL_Z, WATER = 2, 3, 1.6
TILE, WATER_CELL = 0.25, 0.1
# Waves: amplitude, and wave numbers along x and z. Each bends light to a focus at about 4 / (amplitude k^2), so that
# these draw their lines near the floor.
WAVES = ((0.016, 6.1, 3.4), (0.012, -4.3, 7.6), (0.010, 8.8, -2.2), (0.007, 2.6, -11.3), (0.006, -9.7, -7.9))


def wave(x, z):
    """Height of the water above its mean, and its normal."""
    height, slope_x, slope_z = 0.0, 0.0, 0.0
    for i, (amplitude, kx, kz) in enumerate(WAVES):
        phase = kx * x + kz * z + 1.7 * i
        height += amplitude * math.sin(phase)
        slope_x += amplitude * kx * math.cos(phase)
        slope_z += amplitude * kz * math.cos(phase)
    return height, unit((-slope_x, 1, -slope_z))


def tiles(obj, name, corner, along, up, size, towards):
    """A wall of square tiles in three colours: `along`, `up` are unit vectors, `size` how many tiles there are."""
    for material, kind in (("tile_light", 0), ("tile_mid", 1), ("tile_dark", 2)):
        obj.begin(f"{name}_{material}", material)
        for i in range(size[0]):
            for k in range(size[1]):
                if (5 * i * i + 3 * k + i * k) % 7 % 3 == kind:
                    start = tuple(c + TILE * (i * a + k * u) for c, a, u in zip(corner, along, up))
                    obj.quad(start, tuple(TILE * a for a in along), tuple(TILE * u for u in up), towards)


def water(obj):
    """The surface, with the normals of its waves; it reaches a little into the walls."""
    columns, rows = round(2 * POOL_X / WATER_CELL) + 2, round(2 * POOL_Z / WATER_CELL) + 2

    def point(i, k):
        x, z = -POOL_X + WATER_CELL * (i - 1), -POOL_Z + WATER_CELL * (k - 1)
        height, normal = wave(x, z)
        return (x, WATER + height, z), normal

    for i in range(columns):
        for k in range(rows):
            corners = [point(i, k), point(i, k + 1), point(i + 1, k + 1), point(i + 1, k)]
            obj.face([p for p, _ in corners], None, [n for _, n in corners], towards=(0, 1, 0))


def pool():
    obj = Obj("A pool under the sun, seen from within: its waves draw lines of light on the tiles")
    across, along, high = round(2 * POOL_X / TILE), round(2 * POOL_Z / TILE), round((WATER + 0.4) / TILE)
    tiles(obj, "floor", (-POOL_X, 0, -POOL_Z), (1, 0, 0), (0, 0, 1), (across, along), (0, 1, 0))
    tiles(obj, "far_wall", (-POOL_X, 0, -POOL_Z), (1, 0, 0), (0, 1, 0), (across, high), (0, 0, 1))
    tiles(obj, "near_wall", (-POOL_X, 0, POOL_Z), (1, 0, 0), (0, 1, 0), (across, high), (0, 0, -1))
    tiles(obj, "left_wall", (-POOL_X, 0, -POOL_Z), (0, 0, 1), (0, 1, 0), (along, high), (1, 0, 0))
    tiles(obj, "right_wall", (POOL_X, 0, -POOL_Z), (0, 0, 1), (0, 1, 0), (along, high), (-1, 0, 0))
    obj.begin("ball", "ball")
    obj.sphere((-0.75, 0.35, -0.6), 0.35, 3)
    obj.begin("step", "stone")
    obj.box((0.7, 0, -1.5), (1.5, 0.4, -0.7), without=("-y",))
    obj.begin("water", "water")
    water(obj)
    return obj


def window(obj, z, x0, x1, y0, y1):
    """A window of four panes in the plane z, with its bars."""
    bar, middle, cross = 0.05, (x0 + x1) / 2, y0 + 0.62 * (y1 - y0)
    obj.begin("window_bars", "paint")
    for x in (x0, middle - bar / 2, x1 - bar):
        obj.box((x, y0, z - bar), (x + bar, y1, z + bar))
    for y in (y0, cross, y1 - bar):
        obj.box((x0, y, z - bar), (x1, y + bar, z + bar))
    obj.begin("panes", "pane")
    for left, right in ((x0 + bar, middle - bar / 2), (middle + bar / 2, x1 - bar)):
        for low, high in ((y0 + bar, cross), (cross + bar, y1 - bar)):
            obj.quad((left, low, z), (right - left, 0, 0), (0, high - low, 0), (0, 0, 1))


def glazed_room():
    obj = Obj("A room behind glass: sun and sky come through the panes of two windows, and by nothing else")
    width, height, depth, sill, lintel = 4.4, 2.6, 3.6, 0.8, 2.25
    obj.begin("walls", "wall")
    room(obj, (0, 0, 0), (width, height, depth), without=("-y", "-z"))
    windows = ((0.5, 1.9), (2.5, 3.9))
    edges = [0] + [x for pair in windows for x in pair] + [width]
    for x0, x1 in zip(edges[::2], edges[1::2]):
        obj.box((x0, sill, -0.3), (x1, lintel, 0), without=("-y", "+y"))
    obj.box((0, 0, -0.3), (width, sill, 0), without=("-y",))
    obj.box((0, lintel, -0.3), (width, height, 0), without=("+y",))
    for x0, x1 in windows:
        window(obj, -0.15, x0, x1, sill, lintel)
    obj.begin("floor", "floor")
    obj.quad((0, 0, 0), (width, 0, 0), (0, 0, depth), (0, 1, 0))
    obj.begin("table", "wood")
    table(obj, (1.5, 0, 0.9), (2.9, 0.74, 1.7), 0.04, 0.06)
    chair(obj, 2.0, 2.05)
    obj.begin("vase", "vase")
    obj.lathe((2.5, 0.74, 1.25), [(0, 0.002), (0.07, 0.002), (0.11, 0.08), (0.12, 0.16), (0.08, 0.27), (0.05, 0.33),
                                  (0.06, 0.37), (0, 0.36)], 32)
    obj.begin("carafe", "glass")
    obj.sphere((1.95, 0.84, 1.2), 0.1, 3)
    return obj


def ambient_occlusion():
    obj = Obj("Walls, steps, an arch of boxes and a ball on a plane, to be darkened by how little sky they see")
    obj.begin("ground", "white")
    obj.quad((-12, 0, -12), (24, 0, 0), (0, 0, 24), (0, 1, 0))
    obj.begin("corner", "white")
    obj.box((-3, 0, -2.4), (0.2, 2.2, -2.2), without=("-y",))
    obj.box((-3.2, 0, -2.4), (-3, 2.2, 0.4), without=("-y",))
    obj.begin("steps", "white")
    for i in range(5):
        obj.box((-2.6, 0, -2.2 + 0.25 * i), (-1.4, 1.25 - 0.25 * i, -1.95 + 0.25 * i), without=("-y", "-z"))
    obj.begin("arch", "white")
    for x in (0.7, 1.9):
        obj.box((x, 0, -1.5), (x + 0.3, 1.3, -1.0), without=("-y",))
    obj.box((0.55, 1.3, -1.6), (2.35, 1.55, -0.9))
    obj.begin("ball", "white")
    obj.sphere((-0.4, 0.5, 0.2), 0.5, 4)
    obj.begin("small_ball", "white")
    obj.sphere((0.45, 0.25, 0.7), 0.25, 3)
    return obj
