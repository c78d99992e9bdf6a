# SPDX-License-Identifier: Apache-2.0
"""Lamps -> options of clrt, or shining surfaces where they have a size and Cycles would show them. A surface of area
A and power P has the radiance P / (pi A), a point P / (4 pi) watts a steradian; a sun's strength is its irradiance."""
import math
from dataclasses import dataclass

import numpy as np

from .axes import numbers, point

DISC_CORNERS = 64
SPHERE_RINGS = 16


@dataclass
class Surface:
    """A shining mesh in Blender's world; each face shines to where its corners go round anticlockwise."""
    name: str
    vertices: np.ndarray
    faces: list
    radiance: tuple


def _colour(light):
    """Watts by colour."""
    colour = np.array(light.color[:])
    if light.use_temperature:
        colour = colour * np.array(light.temperature_color[:])
    return colour * light.energy * 2.0**light.exposure


def _area_of(vertices, faces):
    total = 0.0
    for face in faces:
        corners = vertices[face]
        total += 0.5 * np.linalg.norm(sum(np.cross(a - corners[0], b - corners[0])
                                          for a, b in zip(corners[1:], corners[2:])))
    return total


def _sphere(radius):
    """Vertices and faces of a sphere."""
    columns = 2 * SPHERE_RINGS
    vertices, faces = [], []
    for i in range(SPHERE_RINGS + 1):
        angle = math.pi * i / SPHERE_RINGS
        for j in range(columns):
            turn = 2 * math.pi * j / columns
            vertices.append((radius * math.sin(angle) * math.cos(turn), radius * math.sin(angle) * math.sin(turn),
                             radius * math.cos(angle)))
    for i in range(SPHERE_RINGS):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            below, last = [a, a + columns, b + columns], i == SPHERE_RINGS - 1
            faces.append(below if i == 0 else [a, a + columns, b] if last else below + [b])
    return np.array(vertices), faces


def _flat(light):
    """Corners of an area light in its own plane, anticlockwise as seen from where it shines, which is -z."""
    x = light.size / 2
    y = light.size_y / 2 if light.shape in ("RECTANGLE", "ELLIPSE") else x
    if light.shape in ("SQUARE", "RECTANGLE"):
        corners = [(-x, -y), (-x, y), (x, y), (x, -y)]
    else:
        turns = [-2 * math.pi * i / DISC_CORNERS for i in range(DISC_CORNERS)]
        corners = [(x * math.cos(turn), y * math.sin(turn)) for turn in turns]
    return np.array([(*corner, 0.0) for corner in corners]), [list(range(len(corners)))]


def _placed(vertices, matrix):
    matrix = np.array(matrix)
    return vertices @ matrix[:3, :3].T + matrix[:3, 3]


def _surface(name, light, vertices, faces):
    radiance = _colour(light) / (math.pi * _area_of(vertices, faces))
    return Surface(name, vertices, faces, tuple(radiance))


def _lamp(lamp, matrix, options, surfaces, notes):
    light = lamp.data
    if light.type == "SUN":
        towards = matrix.to_3x3().col[2].normalized()
        options += ["--sun", f"{point(towards)},{numbers(_colour(light))},{math.degrees(light.angle):.9g}"]
    elif light.type == "AREA":
        vertices, faces = _flat(light)
        surfaces.append(_surface(lamp.name, light, _placed(vertices, matrix), faces))
        if light.spread < math.pi - 1e-4:
            notes.append(f"{lamp.name} shines to all sides of its front")
    elif light.type == "SPOT":
        outer = math.degrees(light.spot_size / 2)
        inner = outer * (1 - light.spot_blend)  # as Blender's glTF exporter has it
        forward = -matrix.to_3x3().col[2].normalized()
        options += ["--spot", ",".join((point(matrix.translation), point(forward),
                                        numbers(_colour(light) / (4 * math.pi)), numbers((outer, inner))))]
        if light.shadow_soft_size > 0:
            notes.append(f"{lamp.name} has hard shadows")
    else:
        # Most lamps are hidden from the camera, which no surface of ours can be; those are points, with hard shadows.
        if light.shadow_soft_size > 0 and lamp.visible_camera:
            vertices, faces = _sphere(light.shadow_soft_size)
            surfaces.append(_surface(lamp.name, light, vertices + np.array(matrix.translation), faces))
        else:
            intensity = _colour(light) / (4 * math.pi)
            options += ["--point", f"{point(matrix.translation)},{numbers(intensity)}"]


def lights_of(depsgraph, notes):
    """Options and surfaces of all lamps."""
    options, surfaces = [], []
    for instance in depsgraph.object_instances:
        if instance.object.type == "LIGHT":
            _lamp(instance.object, instance.matrix_world, options, surfaces, notes)
    return options, surfaces
