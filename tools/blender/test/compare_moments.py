#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exports a scene that moves from Blender as one glTF file, and as an OBJ a frame with every vertex where Blender has it; renders
both by clrt and compares: a skin, a shape key and an object that turns.

    compare_moments.py FOLDER

Needs Python 3.11 with the packages bpy and numpy, and clrt in the variable CLRT or the search path. Leaves files and pictures in
the folder. Exit code 1 if anything, or its shadow, is elsewhere."""
import math
import os
import subprocess
import sys

import bpy
import numpy as np

FRAMES, RATE = (0, 10, 30, 48), 24
WIDTH, HEIGHT = 240, 180
# How many pixels may be lit in one picture and not in the other; a frame too late has over a hundred. Shades are not compared:
# under a skin normals bend with it, in an OBJ they are those of the bent faces, which tells where the lit side ends.
MOST_PIXELS = 20
VIEW = ["--eye", "5,4,9", "--at", "0,1.5,0", "--up", "y", "--fov", "40", "--sun", "0.5,1,0.7,3,3,3", "--material", "clay",
        "-i", "raycast", "--spp", "16", "--size", f"{WIDTH}x{HEIGHT}", "--quiet", "--no-sidecar"]


def key(thing, path, values):
    """Key frames of a property: {frame: value}."""
    for frame, value in values.items():
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)


def add_bent_tube():
    """A tube under a skeleton of two bones, of which the upper one bends while both are carried away."""
    bpy.ops.mesh.primitive_cylinder_add(radius=0.4, depth=4, vertices=24, location=(0, 0, 2))
    tube = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=6)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.armature_add()
    armature = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    lower = armature.data.edit_bones[0]
    lower.tail = (0, 0, 2)
    upper = armature.data.edit_bones.new("upper")
    upper.head, upper.tail, upper.parent, upper.use_connect = (0, 0, 2), (0, 0, 4), lower, True
    bpy.ops.object.mode_set(mode="OBJECT")
    tube.select_set(True)
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    bone = armature.pose.bones["upper"]
    bone.rotation_mode = "QUATERNION"
    key(bone, "rotation_quaternion", {frame: (math.cos(angle / 2), math.sin(angle / 2), 0, 0)
                                      for frame, angle in ((0, 0), (24, 1.2), (48, -0.7))})
    key(armature, "location", {0: (0, 0, 0), 48: (1, 0, 0)})


def add_growing_cube():
    """A cube that turns, and whose top rises by a shape key."""
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-2.5, 0, 0.5))
    cube = bpy.context.object
    cube.shape_key_add(name="Basis")
    tall = cube.shape_key_add(name="tall")
    for point in tall.data:
        point.co.z += 1.5 if point.co.z > 0 else 0
    key(tall, "value", {0: 0, 48: 1})
    key(cube, "rotation_euler", {0: (0, 0, 0), 48: (0, 0, 2.5)})


def picture(path, *options):
    """The pixels of a scene."""
    output = os.path.splitext(path)[0] + "".join(options).replace("--animation-time", "_at_") + ".pfm"
    subprocess.run([os.environ.get("CLRT", "clrt"), path, *VIEW, *options, "-o", output], check=True)
    with open(output, "rb") as file:
        for _ in range(3):
            file.readline()
        return np.frombuffer(file.read(), "<f4").reshape(HEIGHT, WIDTH, 3)


def main(folder):
    os.makedirs(folder, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = RATE
    add_bent_tube()
    add_growing_cube()
    bpy.ops.mesh.primitive_plane_add(size=12)
    whole = os.path.join(folder, "moving.glb")
    bpy.ops.export_scene.gltf(filepath=whole, export_format="GLB", export_animations=True)
    is_well = True
    for frame in FRAMES:
        scene.frame_set(frame)
        still = os.path.join(folder, f"frame_{frame}.obj")
        bpy.ops.wm.obj_export(filepath=still)
        expected, found = picture(still), picture(whole, "--animation-time", str(frame / RATE))
        apart = (found > 0).any(-1) != (expected > 0).any(-1)
        is_well = is_well and apart.sum() <= MOST_PIXELS
        lit = (expected > 0).any(-1).sum()
        print(f"frame {frame}: {lit} of {apart.size} pixels are lit, {apart.sum()} otherwise")
    return 0 if is_well else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
