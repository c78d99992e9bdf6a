# SPDX-License-Identifier: Apache-2.0
"""Scenes of what a picture takes its time and its lens for."""

import math

from scene_kit import Obj

SPHERE_LEVEL = 3  # 1280 triangles


def depth_of_field():
    """A row of balls that leads away from the camera, and small lamps far behind."""
    obj = Obj("Balls in a row and small lamps behind, for a lens")
    for material, odd in (("tile_light", 0), ("tile_dark", 1)):
        obj.begin("floor_" + material, material)
        for i in range(-6, 6):
            for k in range(-14, 3):
                if (i + k) % 2 == odd:
                    obj.quad((i, 0, k), (1, 0, 0), (0, 0, 1), (0, 1, 0))
    for n, material in enumerate(("red", "ochre", "green", "blue", "violet")):
        obj.begin("ball_" + material, material)
        obj.sphere((-1.2 + 0.55 * n, 0.4, 0.9 - 1.5 * n), 0.4, SPHERE_LEVEL)
    for n in range(14):
        obj.begin(f"bulb_{n}", "bulb_warm" if n % 3 else "bulb_cool")
        across = -5.2 + 0.8 * n
        obj.sphere((across, 1.4 + 0.9 * math.sin(2.1 * n) * math.cos(0.7 * n), -11 - 0.9 * (n % 4)), 0.06, 1)
    obj.begin("softbox", "softbox")
    obj.quad((-2, 5, -3), (4, 0, 0), (0, 0, 4), (0, -1, 0))
    return obj


def motion_blur(time):
    """A ball that rolls, one that falls and one that lies still before a wheel that turns, at a time from 0 to 1."""
    obj = Obj("Balls and a wheel that move while the shutter is open, time %d" % time)
    obj.begin("floor", "floor")
    obj.quad((-5, 0, -3), (10, 0, 0), (0, 0, 8), (0, 1, 0))
    obj.begin("wall", "wall")
    obj.quad((-5, 0, -3), (10, 0, 0), (0, 6, 0), (0, 0, 1))
    obj.begin("still_ball", "green")
    obj.sphere((-1.7, 0.45, 0.6), 0.45, SPHERE_LEVEL)
    obj.begin("rolling_ball", "red")
    obj.sphere((-0.6 + 0.9 * time, 0.45, 0.9), 0.45, SPHERE_LEVEL)
    obj.begin("falling_ball", "mirror")
    obj.sphere((1.75, 1.75 - 0.6 * time, 0.2), 0.4, SPHERE_LEVEL)
    obj.begin("post", "post")
    obj.box((-0.06, 0, -1.3), (0.06, 1.6, -1.18), without=("-y",))
    obj.begin("wheel", "blade")
    blades, spread = 6, math.radians(20)
    for k in range(blades):
        angle = 2 * math.pi * k / blades + math.radians(17) * time

        def place(radius, a):
            return (radius * math.cos(a), 1.6 + radius * math.sin(a), -1.1)

        obj.face([place(0.1, angle), place(1.2, angle), place(1.2, angle + spread), place(0.1, angle + spread)],
                 towards=(0, 0, 1))
    obj.begin("light", "light")
    obj.quad((-1.5, 4.5, 0.5), (2, 0, 0), (0, 0, 2), (0, -1, 0))
    return obj
