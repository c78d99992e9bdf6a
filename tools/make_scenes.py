#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the geometry and the textures of the scenes in scenes/: NAME/NAME.obj, of what moves NAME/end/NAME.obj, and
NAME/*.png. Materials, options and
README of a scene are written by hand.

    tools/make_scenes.py            writes them
    tools/make_scenes.py --check    exits 1 if scenes/ does not hold what would be written

Right-handed, +Y up; lengths in metres except in the Cornell box, which keeps its millimetres. All faces have their
front where light arrives or leaves; scene_kit.py checks that.
"""

import math
import pathlib
import sys

import scene_textures as textures
from scene_effects import drink_and_gem, gloss_translucency, soft_shadows
from scene_exposure import depth_of_field, motion_blur
from scene_head import add_head
from scene_kit import Obj, add, png, png_pixels, polygon_normal, scale, subtract, unit
from scene_rooms import door_ajar, hall_of_lamps, night_screen, town_at_night
from scene_sky import ambient_occlusion, glazed_room, pool

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
SPHERE_LEVEL = 4  # 5120 triangles with vertex normals: the outline errs by less than 0.1 % of the radius


def files(name, obj, pictures=None):
    """The generated files of one scene: path below scenes/ -> content."""
    made = {f"{name}/{name}.obj": obj.text(name + ".mtl").encode()}
    for stem, rows in (pictures or {}).items():
        made[f"{name}/{stem}.png"] = png(rows)
    return made


def checkered_floor(obj, low, high, tile):
    """A floor of square tiles in the plane y = 0, in materials tile_light and tile_dark."""
    for material, odd in (("tile_light", 0), ("tile_dark", 1)):
        obj.begin("floor_" + material, material)
        for i in range(round((high[0] - low[0]) / tile)):
            for k in range(round((high[1] - low[1]) / tile)):
                if (i + k) % 2 == odd:
                    obj.quad((low[0] + i * tile, 0, low[1] + k * tile), (tile, 0, 0), (0, 0, tile), (0, 1, 0))


def cornell_box():
    obj = Obj("Cornell box, measured data of the Cornell University Program of Computer Graphics, in mm")
    obj.begin("floor", "white")
    obj.face([(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)], towards=(0, 1, 0))
    obj.begin("ceiling", "white")
    obj.face([(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)], towards=(0, -1, 0))
    obj.begin("back_wall", "white")
    obj.face([(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)], towards=(0, 0, -1))
    obj.begin("right_wall", "green")
    obj.face([(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)], towards=(1, 0, 0))
    obj.begin("left_wall", "red")
    obj.face([(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)], towards=(-1, 0, 0))
    obj.begin("light", "light")
    obj.quad((213, 548.3, 227), (130, 0, 0), (0, 0, 105), (0, -1, 0))
    for name, height, foot in (("short_block", 165, [(130, 65), (82, 225), (240, 272), (290, 114)]),
                               ("tall_block", 330, [(423, 247), (265, 296), (314, 456), (472, 406)])):
        obj.begin(name, "white")
        obj.face([(x, height, z) for x, z in foot], towards=(0, 1, 0))
        middle = (sum(x for x, _ in foot) / 4, sum(z for _, z in foot) / 4)
        for (x0, z0), (x1, z1) in zip(foot, foot[1:] + foot[:1]):
            outwards = ((x0 + x1) / 2 - middle[0], 0, (z0 + z1) / 2 - middle[1])
            obj.face([(x0, height, z0), (x0, 0, z0), (x1, 0, z1), (x1, height, z1)], towards=outwards)
    return files("cornell_box", obj)


def spheres_over_plane():
    obj = Obj("Mirror, glass and matte sphere over a checkered plane")
    checkered_floor(obj, (-8, -8), (8, 8), 1)
    for name, centre in (("mirror", (-2.1, 1, -0.6)), ("glass", (0.1, 1, 0.6)), ("matte", (2.3, 1, -0.6))):
        obj.begin(name + "_sphere", name)
        obj.sphere(centre, 1, SPHERE_LEVEL)
    obj.begin("light", "light")
    obj.quad((-1.5, 6, -0.5), (2, 0, 0), (0, 0, 2), (0, -1, 0))
    return files("spheres_over_plane", obj)


def mirror_glass_depth10():
    obj = Obj("Mirror sphere and glass sphere between two facing mirrors")
    width, height, back, front = 3.0, 4.0, -3.0, 5.0
    checkered_floor(obj, (-width, back), (width, front), 1)
    lean = math.tan(math.radians(1.5)) * height  # the far mirror leans back: the row of images bends upwards
    depth = front - back + lean
    obj.begin("left_wall", "warm")
    obj.quad((-width, 0, back - lean), (0, height, 0), (0, 0, depth), (1, 0, 0))
    obj.begin("right_wall", "cool")
    obj.quad((width, 0, back - lean), (0, height, 0), (0, 0, depth), (-1, 0, 0))
    obj.begin("ceiling", "tile_light")
    obj.quad((-width, height, back - lean), (2 * width, 0, 0), (0, 0, depth), (0, -1, 0))
    obj.begin("mirrors", "mirror")
    obj.quad((-width, 0, back), (2 * width, 0, 0), (0, height, -lean), (0, 0, 1))
    obj.quad((-width, 0, front), (2 * width, 0, 0), (0, height, 0), (0, 0, -1))
    obj.begin("mirror_sphere", "mirror")
    obj.sphere((-1.2, 1, -0.9), 1, SPHERE_LEVEL)
    obj.begin("glass_sphere", "glass")
    obj.sphere((1.1, 0.9, 0.2), 0.9, SPHERE_LEVEL)
    obj.begin("mirror_core", "mirror")
    obj.sphere((1.1, 0.9, 0.2), 0.3, SPHERE_LEVEL - 1)
    obj.begin("light", "light")
    obj.quad((-1, height - 0.01, 0), (2, 0, 0), (0, 0, 1), (0, -1, 0))
    return files("mirror_glass_depth10", obj)


def colour_bleeding():
    obj = Obj("White things between a red and a blue wall")
    obj.begin("white_walls", "white")
    obj.quad((-2, 0, -2), (4, 0, 0), (0, 0, 4), (0, 1, 0))
    obj.quad((-2, 3, -2), (4, 0, 0), (0, 0, 4), (0, -1, 0))
    obj.quad((-2, 0, -2), (4, 0, 0), (0, 3, 0), (0, 0, 1))
    obj.begin("red_wall", "red")
    obj.quad((-2, 0, -2), (0, 0, 4), (0, 3, 0), (1, 0, 0))
    obj.begin("blue_wall", "blue")
    obj.quad((2, 0, -2), (0, 0, 4), (0, 3, 0), (-1, 0, 0))
    obj.begin("sphere", "white")
    obj.sphere((-0.9, 0.7, 0), 0.7, SPHERE_LEVEL)
    obj.begin("box", "white")
    obj.box((0.4, 0, -0.7), (1.5, 1.3, 0.4), without=("-y",))
    obj.begin("light", "light")
    obj.quad((-0.5, 2.99, -0.5), (1, 0, 0), (0, 0, 1), (0, -1, 0))
    return files("colour_bleeding", obj)


def caustic():
    obj = Obj("A glass sphere and a metal ring gather light on a floor")
    obj.begin("floor", "floor")
    obj.quad((-25, 0, -40), (50, 0, 0), (0, 0, 50), (0, 1, 0))
    obj.begin("glass_sphere", "glass")
    obj.sphere((-1.15, 0.8, 0.1), 0.8, SPHERE_LEVEL)
    obj.begin("ring", "gold")
    outer, inner, rim = 1.0, 0.94, 0.5
    obj.lathe((1.2, 0, 0), [(outer, 0), (outer, rim), (inner, rim), (inner, 0)], 96)
    centre, towards = (-3.2, 3.6, 1.8), unit((3.2, -3.6, -1.8))
    side = unit((towards[2], 0, -towards[0]))
    up = polygon_normal([(0, 0, 0), towards, side])
    half = 0.4
    corner = subtract(subtract(centre, scale(side, half)), scale(up, half))
    obj.begin("light", "light")
    obj.quad(corner, scale(side, 2 * half), scale(up, 2 * half), towards)
    return files("caustic", obj)


def furnace():
    obj = Obj("A closed space that emits 0.5 and reflects 0.5")
    obj.begin("furnace", "furnace")
    obj.sphere((0, 0, 0), 5, 2, smooth=False, inward=True)
    obj.begin("sphere", "furnace")
    obj.sphere((-1, 0, 0), 0.8, 2, smooth=False)
    obj.begin("box", "furnace")
    obj.box((0.4, -0.6, -0.6), (1.6, 0.6, 0.6))
    obj.begin("mirror_sphere", "mirror")
    obj.sphere((0.2, 1.4, -0.4), 0.6, 3, smooth=False)
    return files("furnace", obj)


def glossy_plates():
    obj = Obj("Four metal plates of rising roughness under four lights of rising size")
    add_plates(obj)
    return files("glossy_plates", obj)


def plates_far_lamp():
    obj = Obj("The glossy plates, and far from them a lamp with nearly all the power, over a floor of its own")
    add_plates(obj)
    x, z = 30, 40  # behind the camera and to the side, beyond the edge of the plates' floor
    obj.begin("far_floor", "floor")
    obj.quad((x - 12, -0.6, z - 12), (24, 0, 0), (0, 0, 24), (0, 1, 0))
    obj.begin("far_lamp", "far_light")
    obj.quad((x - 1, 1, z - 1), (2, 0, 0), (0, 0, 2), (0, -1, 0))
    return files("plates_far_lamp", obj)


def add_plates(obj):
    """Veach and Guibas' plates, which show lights of rising size."""
    eye, lights_middle = (0, 2.2, 9.0), (0, 4.2, -2.6)
    obj.begin("floor", "floor")
    obj.quad((-9, -0.6, -5), (18, 0, 0), (0, 0, 12), (0, 1, 0))
    obj.begin("wall", "floor")
    obj.quad((-9, -0.6, -5), (18, 0, 0), (0, 12, 0), (0, 0, 1))
    for i, centre in enumerate([(0, 1.35, -1.6), (0, 0.65, -0.3), (0, 0.1, 1.1), (0, -0.25, 2.5)]):
        normal = unit(add(unit(subtract(eye, centre)), unit(subtract(lights_middle, centre))))
        across = (0, -normal[2], normal[1])  # perpendicular to the normal and to x, pointing away from the lights
        corner = subtract(subtract(centre, (2.6, 0, 0)), scale(across, 0.5))
        obj.begin(f"plate_{i}", f"plate_{i}")
        obj.quad(corner, (5.2, 0, 0), across, normal)
    for i, (x, radius) in enumerate([(-2.4, 0.05), (-0.9, 0.15), (0.7, 0.4), (2.4, 0.75)]):
        obj.begin(f"light_{i}", f"light_{i}")
        obj.sphere(add(lights_middle, (x, 0, 0)), radius, 2, smooth=False)


def leaves(obj, foot, count):
    """Arching leaves about a foot point: three quads each, bent outwards, with a texture along their length."""
    for k in range(count):
        turn = k * math.radians(137.5)
        length, rise = 0.55 + 0.12 * ((k * 7) % 5), math.radians(80 - 3.2 * k)
        outwards, side = (math.cos(turn), 0, -math.sin(turn)), (math.sin(turn), 0, math.cos(turn))
        ribs, point = [], foot
        for i in range(4):
            half = scale(side, 0.09)
            ribs.append((subtract(point, half), add(point, half)))
            lift = rise - math.radians(22) * i
            step = length / 3
            point = add(point, add(scale(outwards, step * math.cos(lift)), (0, step * math.sin(lift), 0)))
        for i in range(3):
            (a, b), (d, c) = ribs[i], ribs[i + 1]
            corners, v0, v1 = [a, b, c, d], i / 3, (i + 1) / 3
            upper = polygon_normal(corners)
            obj.face(corners, [(0, v0), (1, v0), (1, v1), (0, v1)], towards=upper)


def textured_interior():
    obj = Obj("A small room with a window, its surfaces textured")
    width, height, depth, sill, lintel, near, far, wall = 5.0, 2.7, 4.5, 0.85, 2.3, 1.1, 3.1, 0.25
    obj.begin("floor", "wood")
    obj.quad((0, 0, depth), (width, 0, 0), (0, 0, -depth), (0, 1, 0), repeat=(width, depth))
    obj.begin("ceiling", "plaster")
    obj.quad((0, height, 0), (width, 0, 0), (0, 0, depth), (0, -1, 0), repeat=(width, depth))
    obj.begin("back_wall", "brick")
    obj.quad((0, 0, 0), (width, 0, 0), (0, height, 0), (0, 0, 1), repeat=(width, height))
    obj.begin("walls_behind_camera", "white_paint")
    obj.quad((width, 0, 0), (0, 0, depth), (0, height, 0), (-1, 0, 0))
    obj.quad((0, 0, depth), (width, 0, 0), (0, height, 0), (0, 0, -1))
    obj.begin("window_wall", "wallpaper")
    for z0, z1, y0, y1 in ((0, near, 0, height), (far, depth, 0, height), (near, far, 0, sill),
                           (near, far, lintel, height)):
        obj.quad((0, y0, z0), (0, 0, z1 - z0), (0, y1 - y0, 0), (1, 0, 0), repeat=(z1 - z0, y1 - y0))

    obj.begin("window_reveal", "white_paint")
    obj.quad((-wall, sill, near), (wall, 0, 0), (0, 0, far - near), (0, 1, 0))
    obj.quad((-wall, lintel, near), (wall, 0, 0), (0, 0, far - near), (0, -1, 0))
    obj.quad((-wall, sill, near), (wall, 0, 0), (0, lintel - sill, 0), (0, 0, 1))
    obj.quad((-wall, sill, far), (wall, 0, 0), (0, lintel - sill, 0), (0, 0, -1))
    obj.begin("window_bars", "white_paint")
    for z in (near + 0.03, (near + far) / 2, far - 0.03):
        obj.box((-0.16, sill, z - 0.03), (-0.1, lintel, z + 0.03))
    for y in (sill + 0.03, sill + 0.95, lintel - 0.03):
        obj.box((-0.155, y - 0.03, near), (-0.105, y + 0.03, far))

    obj.begin("skirting", "white_paint")
    obj.box((0, 0, 0), (width, 0.1, 0.02), without=("-y", "-z", "-x", "+x"))
    obj.box((width - 0.02, 0, 0.02), (width, 0.1, depth), without=("-y", "+x", "-z", "+z"))
    obj.begin("picture_frame", "dark_wood")
    obj.box((2.05, 1.2, 0), (3.35, 2.05, 0.04), without=("-z",))
    obj.begin("picture", "painting")
    obj.quad((2.12, 1.27, 0.042), (1.16, 0, 0), (0, 0.71, 0), (0, 0, 1), repeat=(1, 1))
    obj.begin("rug_edge", "dark_wood")
    obj.box((1.2, 0, 1.25), (3.3, 0.012, 2.95), without=("-y", "+y"))
    obj.begin("rug", "rug")
    obj.quad((1.2, 0.012, 2.95), (2.1, 0, 0), (0, 0, -1.7), (0, 1, 0), repeat=(1, 1))

    obj.begin("table", "dark_wood")
    obj.box((3.0, 0.68, 0.35), (4.6, 0.74, 1.15))
    for x in (3.05, 4.47):
        for z in (0.4, 1.02):
            obj.box((x, 0, z), (x + 0.08, 0.68, z + 0.08), without=("-y", "+y"))
    obj.begin("vase", "ceramic")
    obj.lathe((3.4, 0.74, 0.75), [(0, 0.002), (0.07, 0.002), (0.115, 0.06), (0.13, 0.12), (0.115, 0.19), (0.07, 0.26),
                                  (0.045, 0.3), (0.045, 0.34), (0.06, 0.37), (0.052, 0.37), (0.038, 0.34),
                                  (0.038, 0.3), (0, 0.28)], 48)
    obj.begin("bowl", "brass")
    obj.lathe((4.1, 0.74, 0.75), [(0, 0.004), (0.06, 0.004), (0.12, 0.03), (0.165, 0.07), (0.19, 0.13), (0.182, 0.13),
                                  (0.157, 0.075), (0.114, 0.038), (0.055, 0.014), (0, 0.014)], 48)
    obj.begin("glass_ball", "glass")
    obj.sphere((4.1, 0.86, 0.75), 0.105, 3)

    obj.begin("pot", "terracotta")
    obj.lathe((0.75, 0, 0.75), [(0, 0.002), (0.15, 0.002), (0.21, 0.34), (0.23, 0.34), (0.23, 0.4), (0.2, 0.4),
                                (0.19, 0.33), (0, 0.33)], 32)
    obj.begin("plant", "leaf")
    leaves(obj, (0.75, 0.3, 0.75), 22)
    return files("textured_interior", obj, {
        "wood": textures.wood_floor(), "brick": textures.brick(), "brick_normal": textures.brick_normal(),
        "plaster_bump": textures.plaster_bump(), "wallpaper": textures.wallpaper(), "rug": textures.rug(),
        "painting": textures.painting(), "leaf": textures.leaf(),
    })


def every_effect():
    obj = Obj("Six things on a terrace: every effect in one picture")
    obj.begin("terrace", "brick")
    obj.quad((-3, 0, 2.5), (6, 0, 0), (0, 0, -5), (0, 1, 0), repeat=(6, 5))
    obj.begin("wall", "plaster")
    obj.quad((-3, 0, -2.5), (6, 0, 0), (0, 1.6, 0), (0, 0, 1), repeat=(6, 1.6))
    obj.begin("mirror_sphere", "mirror")
    obj.sphere((-1.5, 0.6, -1.2), 0.6, SPHERE_LEVEL - 1)
    obj.begin("glass_sphere", "glass")
    obj.sphere((-0.2, 0.45, 0.7), 0.45, SPHERE_LEVEL - 1)
    obj.begin("frosted_sphere", "frosted")
    obj.sphere((0.95, 0.4, 0.3), 0.4, SPHERE_LEVEL - 1)
    obj.begin("bowl", "brass")
    obj.lathe((-1.3, 0, 0.6), [(0, 0.004), (0.15, 0.004), (0.3, 0.08), (0.42, 0.18), (0.48, 0.34), (0.46, 0.34),
                               (0.39, 0.19), (0.28, 0.1), (0.14, 0.03), (0, 0.03)], 48)
    obj.begin("plant", "leaf")
    leaves(obj, (1.6, 0, -1.2), 18)
    obj.begin("lamp", "lamp")
    obj.quad((0.2, 1.9, -1), (0.6, 0, 0), (0, 0, 0.6), (0, -1, 0))
    return files("every_effect", obj, {
        "brick": textures.brick(), "brick_normal": textures.brick_normal(), "plaster_bump": textures.plaster_bump(),
        "leaf": textures.leaf(), "sky": textures.sky(),
    })


def still_life():
    obj = Obj("A head, balls and a lamp on tiles; the materials are written as Blender's exporter writes them")
    obj.begin("tiles", "tiles")
    obj.quad((-5, 0, 4.5), (10, 0, 0), (0, 0, -7), (0, 1, 0), repeat=(10, 7))
    obj.begin("wall", "wall")
    obj.quad((-5, 0, -2.5), (10, 0, 0), (0, 6, 0), (0, 0, 1))
    obj.begin("head", "clay")
    add_head(obj, (0, 1.5, -0.6), 0.9, SPHERE_LEVEL)
    obj.begin("plinth", "wall")
    obj.lathe((0, 0, -0.75), [(0.62, 0), (0.62, 0.28), (0.4, 0.34), (0.36, 0.62), (0, 0.62)], 48)
    for name, centre, radius in (("gold", (-1.75, 0.55, 0.2), 0.55), ("glass", (-0.72, 0.45, 1.1), 0.45),
                                 ("plastic", (0.42, 0.4, 1.25), 0.4), ("coated", (1.4, 0.5, 0.7), 0.5),
                                 ("frosted", (-1.75, 0.28, 1.45), 0.28), ("coated_metal", (1.25, 0.26, 1.65), 0.26)):
        obj.begin(name + "_ball", name)
        obj.sphere(centre, radius, SPHERE_LEVEL - (0 if name in ("gold", "glass") else 1))
    obj.begin("lamp_stand", "steel")
    obj.lathe((2.35, 0, -0.5), [(0.4, 0), (0.4, 0.05), (0.04, 0.09), (0.04, 1.75)], 48)
    obj.begin("lamp_bulb", "bulb")
    obj.sphere((2.35, 1.9, -0.5), 0.2, 2)
    obj.begin("lamp_shade", "shade")
    obj.lathe((2.35, 0, -0.5), [(0.62, 1.5), (0.38, 2.35)], 48)
    obj.begin("softbox", "softbox")
    obj.quad((-3.2, 4.6, 1.2), (2.2, 0.7, 0), (0, 0, 2.2), (0.3, -1, 0))
    return files("still_life", obj, {"brick": textures.brick(), "brick_normal": textures.brick_normal()})


def all_files():
    made = {}
    for scene in (cornell_box, spheres_over_plane, mirror_glass_depth10, colour_bleeding, caustic, furnace,
                  glossy_plates, textured_interior, every_effect, still_life, plates_far_lamp):
        made.update(scene())
    for scene in (door_ajar, hall_of_lamps, soft_shadows, gloss_translucency, drink_and_gem, depth_of_field, pool, glazed_room,
                  ambient_occlusion):
        made.update(files(scene.__name__, scene()))
    made.update(files("night_screen", night_screen(), {"town": town_at_night()}))
    made.update(files("motion_blur", motion_blur(0)))
    made["motion_blur/end/motion_blur.obj"] = motion_blur(1).text("../motion_blur.mtl").encode()
    return made


def differs(path, data):
    """Whether a file is missing or holds something else; PNGs are compared by their pixels."""
    if not path.is_file():
        return True
    found = path.read_bytes()
    return found != data and not (path.suffix == ".png" and png_pixels(found) == png_pixels(data))


def main(arguments):
    if arguments not in ([], ["--check"]):
        sys.exit("make_scenes.py: expected no argument or --check, found: " + " ".join(arguments))
    made = all_files()
    if arguments:
        stale = [name for name, data in made.items() if differs(SCENES / name, data)]
        if stale:
            sys.exit("make_scenes.py: scenes/ is not what this program writes; run it again for: " + ", ".join(stale))
        return
    for name, data in made.items():
        path = SCENES / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    print(f"{len(made)} files, {sum(map(len, made.values())) / 1e6:.2f} MB in {SCENES}")


if __name__ == "__main__":
    main(sys.argv[1:])
