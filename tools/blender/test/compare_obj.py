#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a scene by Cycles, and by clrt from the OBJ that Blender exports of it, with the keys of physically based materials
and without, and compares the mean colour of every material.

    compare_obj.py FOLDER [SAMPLES [WIDTH HEIGHT]]

Needs Python 3.11 with the packages bpy and numpy, and clrt in the variable CLRT or the search path. Leaves the pictures and the
OBJ files in the folder. Exit code 1 if a colour differs by more than it may."""
import math
import os
import subprocess
import sys

here = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [here, os.path.dirname(here)]

import bpy  # noqa: E402 (needs the path above)
import numpy as np  # noqa: E402

import clrt_render  # noqa: E402
import rendering  # noqa: E402
import scenes  # noqa: E402

LARGEST_DIFFERENCE = 0.03
# Where both mean different things by the same inputs.
KNOWN_DIFFERENCES = {
    "velvet": 0.2,  # sheen: Cycles' fibres (LTC) against a Charlie distribution
    "coated": 0.1,  # how much of the base a coat leaves
}
# What only the keys of physically based materials can say.
NEED_KEYS = ("glass", "frosted", "coated", "velvet")
FEWEST_PIXELS = 30


def numbers(*values):
    return ",".join(f"{value:.9g}" for value in values)


def flags(scene):
    """The camera, the sun and the sky, which no OBJ holds."""
    camera = scene.camera
    place, ahead, up = camera.location, camera.matrix_world.to_3x3().col[2] * -1, camera.matrix_world.to_3x3().col[1]
    sun = bpy.data.objects["sun"]
    sky = scene.world.node_tree.nodes["Background"].inputs
    radiance = [sky["Strength"].default_value * value for value in sky["Color"].default_value[:3]]
    height = camera.data.sensor_width * scene.render.resolution_y / scene.render.resolution_x
    return ["--eye", numbers(*place), "--at", numbers(*(place + ahead)), "--up", numbers(*up),
            "--fov", f"{math.degrees(2 * math.atan(height / 2 / camera.data.lens)):.9g}",
            "--sun", numbers(*sun.matrix_world.to_3x3().col[2], *[sun.data.energy] * 3, math.degrees(sun.data.angle)),
            "--env", numbers(*radiance), "-r", f"{scene.render.resolution_x}x{scene.render.resolution_y}"]


def save_pictures(folder):
    """An OBJ names files."""
    for image in bpy.data.images:
        if image.source == "GENERATED":
            image.filepath_raw, image.file_format = os.path.join(folder, image.name + ".png"), "PNG"
            image.save()


def export(folder, name, with_keys):
    path = os.path.join(folder, name + ".obj")
    bpy.ops.wm.obj_export(filepath=path, export_pbr_extensions=with_keys, path_mode="COPY", forward_axis="Y", up_axis="Z",
                          export_smooth_groups=False)
    return path


def colours_of(path):
    """(height, width, 3) from the top."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], image.channels)
    return values[::-1, :, :3]


def compare(ours, theirs, mattes, with_keys):
    is_well = True
    for name, matte in sorted(mattes.items()):
        inside = matte > 0.999
        if inside.sum() < FEWEST_PIXELS:
            continue
        a, b = ours[inside].mean(axis=0), theirs[inside].mean(axis=0)
        limit = KNOWN_DIFFERENCES.get(name, LARGEST_DIFFERENCE)
        is_lost = not with_keys and name in NEED_KEYS
        well = is_lost or np.abs(a / b - 1).max() < limit
        is_well = is_well and well
        print(f"  {name:14s} clrt {a.round(4)}, Cycles {b.round(4)}, ratio {(a / b).round(4)}"
              f"{'  not in the file' if is_lost else '' if well else '  DIFFERS'}")
    return is_well


def main():
    folder = sys.argv[1]
    samples = int(sys.argv[2]) if len(sys.argv) > 2 else 512
    width, height = [int(x) for x in sys.argv[3:5]] or (320, 200)
    os.makedirs(folder, exist_ok=True)
    clrt_render.register()
    scene = scenes.obj_balls(width, height)
    save_pictures(folder)
    path = os.path.join(folder, "cycles.exr")
    passes = rendering.render(scene, "CYCLES", path, samples)
    mattes = rendering.coverage(passes, "CryptoMaterial", rendering.matte_names(path, "CryptoMaterial"))
    theirs = np.dstack([passes["Combined." + c] for c in "RGB"]).astype(float)
    is_well = True
    for name, with_keys in (("pbr", True), ("plain", False)):
        obj = export(folder, name, with_keys)
        picture = os.path.join(folder, name + ".exr")
        subprocess.run([os.environ.get("CLRT", "clrt"), obj, *flags(scene), "-s", str(samples), "-q", "--aov", "none", "-o",
                        picture], check=True)
        print(f"{name}: mean colour by material, pixels wholly inside:")
        is_well = compare(colours_of(picture), theirs, mattes, with_keys) and is_well
    sys.exit(0 if is_well else 1)


if __name__ == "__main__":
    main()
