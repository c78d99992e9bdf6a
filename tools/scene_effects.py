# SPDX-License-Identifier: Apache-2.0
"""Scenes that show what several rays make soft, for make_scenes.py: shadows, reflections and what lies behind glass."""

from scene_kit import Obj

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
