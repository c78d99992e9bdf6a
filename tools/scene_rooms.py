# SPDX-License-Identifier: Apache-2.0
"""Scenes whose light is hard to find, for make_scenes.py: rooms and halls, and the furniture in them."""

import math
import random

from scene_kit import Obj, add, scale

# The lamps of the hall: how many there are in a row across and along it, and the side of each, metres.
LAMPS_ACROSS, LAMPS_ALONG, LAMP_SIDE = 10, 100, 0.06
# Materials of lamps: each shines twice as bright as the one before, and there are half as many of it.
LAMP_LEVELS = 8


def room(obj, low, high, without=()):
    """The inside of a box: floor "-y", ceiling "+y" and walls; `without` names those that are left out."""
    for axis in range(3):
        u, v = [tuple(high[k] - low[k] if k == other else 0 for k in range(3)) for other in range(3) if other != axis]
        for sign, name in ((1, "-"), (-1, "+")):
            if name + "xyz"[axis] not in without:
                corner = tuple(high[k] if k == axis and sign < 0 else low[k] for k in range(3))
                obj.quad(corner, u, v, tuple(sign if k == axis else 0 for k in range(3)))


def table(obj, low, high, thickness, leg):
    """A slab on four legs that stands at the height low[1]."""
    (x0, foot, z0), (x1, top, z1) = low, high
    obj.box((x0, top - thickness, z0), (x1, top, z1))
    for x in (x0 + 0.03, x1 - 0.03 - leg):
        for z in (z0 + 0.03, z1 - 0.03 - leg):
            obj.box((x, foot, z), (x + leg, top - thickness, z + leg), without=("-y", "+y"))


def chair(obj, x, z):
    """A chair about the point x, z; its back is on the side of +z."""
    half = 0.21
    table(obj, (x - half, 0, z - half), (x + half, 0.45, z + half), 0.03, 0.04)
    obj.box((x - half, 0.45, z + half - 0.03), (x + half, 0.9, z + half), without=("-y",))


def turned_box(obj, foot, along, across, size):
    """A box of (length along, height, thickness across) at a foot point; `along`, `across`: horizontal unit vectors."""
    u, v, w = scale(along, size[0]), (0, size[1], 0), scale(across, size[2])
    for start, end, edge_1, edge_2, outwards in ((foot, add(foot, w), u, v, across), (foot, add(foot, u), w, v, along),
                                                 (foot, add(foot, v), u, w, (0, 1, 0))):
        obj.quad(start, edge_1, edge_2, scale(outwards, -1))
        obj.quad(end, edge_1, edge_2, outwards)


def wall_with_door(obj, x0, x1, height, depth, door):
    """A wall between two rooms, from z = 0 to depth; `door`: (from z, to z, height) of its opening."""
    near, far, lintel = door
    obj.box((x0, 0, 0), (x1, lintel, near), without=("-y", "+y", "-z"))
    obj.box((x0, 0, far), (x1, lintel, depth), without=("-y", "+y", "+z"))
    obj.box((x0, lintel, 0), (x1, height, depth), without=("+y", "-z", "+z"))


def door_ajar():
    obj = Obj("Two rooms; the lamp is in the other one, and the door between them is ajar")
    height, depth, opening = 2.6, 4, (1.2, 2.1, 2.05)
    obj.begin("walls", "wall")
    room(obj, (0, 0, 0), (5, height, depth), without=("-y", "-x"))
    room(obj, (-4.1, 0, 0), (-0.1, height, depth), without=("-y", "+x"))
    wall_with_door(obj, -0.1, 0, height, depth, opening)
    obj.begin("floor", "floor")
    obj.quad((-4.1, 0, 0), (9.1, 0, 0), (0, 0, depth), (0, 1, 0))
    obj.begin("door", "door")
    angle = math.radians(16)
    turned_box(obj, (0, 0.01, opening[1]), (math.sin(angle), 0, -math.cos(angle)), (math.cos(angle), 0, math.sin(angle)),
               (0.89, 2.03, 0.04))
    obj.begin("table", "wood")
    table(obj, (1.7, 0, 0.7), (3.1, 0.72, 1.5), 0.04, 0.06)
    chair(obj, 2.0, 1.85)
    chair(obj, 2.8, 1.85)
    obj.begin("pot", "red")
    obj.lathe((1.95, 0.72, 1.1), [(0, 0.002), (0.06, 0.002), (0.11, 0.05), (0.12, 0.1), (0.09, 0.17), (0.06, 0.2), (0.06, 0.22),
                                  (0, 0.22)], 32)
    obj.begin("mirror_ball", "mirror")
    obj.sphere((2.4, 0.84, 1.15), 0.12, 3)
    obj.begin("glass_ball", "glass")
    obj.sphere((2.8, 0.82, 1.05), 0.1, 3)
    obj.begin("cupboard", "wood")
    obj.box((3.4, 0, 0), (4.3, 1.8, 0.4), without=("-y", "-z"))
    obj.begin("picture", "blue")
    obj.box((1.9, 1.3, 0), (2.9, 1.95, 0.03), without=("-z",))
    obj.begin("shelf_in_the_other_room", "red")
    obj.box((-4.1, 0, 1.0), (-3.7, 1.9, 2.4), without=("-y", "-x"))
    obj.begin("lamp", "lamp")
    obj.quad((-2.6, height - 0.02, 3.2), (0.5, 0, 0), (0, 0, 0.5), (0, -1, 0))
    return obj


def hall_of_lamps():
    obj = Obj("A long hall with pillars under a thousand small lamps of very different power")
    length, width, height = 60.0, 9.0, 5.0
    pillars = [(x, 3 + 4.15 * k) for k in range(14) for x in (2.2, 6.8)]
    obj.begin("walls", "wall")
    room(obj, (0, 0, 0), (width, height, length), without=("-y",))
    obj.begin("floor", "floor")
    obj.quad((0, 0, 0), (width, 0, 0), (0, 0, length), (0, 1, 0))
    obj.begin("pillars", "stone")
    for x, z in pillars:
        obj.lathe((x, 0, z), [(0.32, 0), (0.32, 0.25), (0.24, 0.32), (0.24, height - 0.3), (0.34, height - 0.2), (0.34, height)], 12)
    for k in range(6):
        z = 5 + 8.3 * k
        obj.begin(f"plinth_{k}", "red")
        obj.box((4.1, 0, z), (4.9, 0.8, z + 0.8), without=("-y",))
        obj.begin(f"ball_{k}", "mirror")
        obj.sphere((4.5, 1.2, z + 0.4), 0.4, 2)
    add_lamps(obj, length, width, height, pillars)
    return obj


def add_lamps(obj, length, width, height, pillars):
    """One lamp in each cell of a grid below the ceiling, none inside a pillar; each is an object of its own."""
    draw = random.Random(1).random
    for k in range(LAMPS_ACROSS * LAMPS_ALONG):
        row, column = divmod(k, LAMPS_ACROSS)
        x, z = (column + 0.2 + 0.6 * draw()) * width / LAMPS_ACROSS, (row + 0.2 + 0.6 * draw()) * length / LAMPS_ALONG
        y, level = height - 0.02 - 0.5 * draw(), min(LAMP_LEVELS - 1, int(-math.log2(1 - draw())))
        if any(math.hypot(x - px, z - pz) < 0.42 for px, pz in pillars):
            x = width / 2
        obj.begin(f"lamp_{k:03}", f"lamp_{level}")
        obj.quad((x - LAMP_SIDE / 2, y, z - LAMP_SIDE / 2), (LAMP_SIDE, 0, 0), (0, 0, LAMP_SIDE), (0, -1, 0))


SCREEN_COLUMNS, SCREEN_ROWS, SCREEN_WINDOWS = 128, 72, 24


def night_screen():
    obj = Obj("A dark room and a television that shows a town at night")
    width, height, depth = 4.4, 2.5, 4.2
    obj.begin("walls", "wall")
    room(obj, (0, 0, 0), (width, height, depth), without=("-y",))
    obj.begin("floor", "floor")
    obj.quad((0, 0, 0), (width, 0, 0), (0, 0, depth), (0, 1, 0))
    obj.begin("cabinet", "wood")
    obj.box((1.2, 0, 0.02), (3.2, 0.5, 0.5), without=("-y",))
    obj.begin("frame", "black")
    obj.box((1.36, 0.58, 0.1), (3.04, 1.56, 0.14))
    obj.begin("screen", "screen")
    obj.quad((1.4, 0.62, 0.142), (1.6, 0, 0), (0, 0.9, 0), (0, 0, 1), repeat=(1, 1))
    obj.begin("table", "wood")
    table(obj, (1.5, 0, 1.5), (2.9, 0.42, 2.1), 0.03, 0.05)
    obj.begin("ball", "white")
    obj.sphere((1.9, 0.54, 1.8), 0.12, 3)
    obj.begin("pot", "red")
    obj.lathe((2.5, 0.42, 1.75), [(0, 0.002), (0.06, 0.002), (0.11, 0.05), (0.12, 0.1), (0.09, 0.17), (0.06, 0.2), (0.06, 0.22),
                                  (0, 0.22)], 32)
    return obj


def town_at_night():
    """Pixels of the screen: windows of 2 x 2, 1 % of the picture and 94 % of its light, over a sky that is nearly black."""
    draw = random.Random(3)
    rows = [[(2, 2, 3)] * SCREEN_COLUMNS for _ in range(SCREEN_ROWS)]
    places = set()
    while len(places) < SCREEN_WINDOWS:
        places.add((4 * draw.randrange(1, SCREEN_COLUMNS // 4 - 1), 4 * draw.randrange(SCREEN_ROWS // 12, SCREEN_ROWS // 4 - 1)))
    for x, y in sorted(places):
        for k in range(4):
            rows[y + k // 2][x + k % 2] = draw.choice([(255, 226, 168), (255, 240, 214), (222, 236, 255)])
    return rows
