# SPDX-License-Identifier: Apache-2.0
"""The evaluated scene -> OBJ and MTL, everything in world coordinates, instances as copies."""
import os

import numpy as np

from . import lights, materials
from .axes import numbers, to_clrt

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
UNKNOWN = {"CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}
# How far behind an area light its dark back is, of the light's size: where other surfaces shine on both sides,
# so would it.
BACK_DISTANCE = 1e-4


class ObjWriter:
    """Writes statements; counts what faces number."""

    def __init__(self, file):
        self.file, self.vertices, self.normals, self.uvs = file, 0, 0, 0

    def rows(self, key, rows):
        self.file.write("".join(f"{key} " + " ".join(f"{x:.9g}" for x in row) + "\n" for row in rows.tolist()))

    def object(self, name):
        self.file.write(f"o {name}\n")

    def polygons(self, points, faces, material):
        """Faces without normals and coordinates on surfaces."""
        self.file.write(f"usemtl {material}\n")
        self.rows("v", to_clrt(points))
        for face in faces:
            self.file.write("f " + " ".join(str(self.vertices + 1 + i) for i in face) + "\n")
        self.vertices += len(points)

    def mesh(self, mesh, matrix, material_names):
        """A mesh of Blender; `matrix` leads to the world."""
        points = _read(mesh.vertices, "co", 3) @ np.array(matrix)[:3, :3].T + np.array(matrix)[:3, 3]
        self.rows("v", to_clrt(points))
        corners = _read(mesh.loops, "vertex_index", 1, np.int32).ravel() + 1 + self.vertices
        words = [str(v) for v in corners.tolist()]
        uv, normal = self._uvs(mesh), self._normals(mesh, matrix)
        if uv is not None or normal is not None:
            uv = [""] * len(words) if uv is None else [str(i) for i in uv.tolist()]
            normal = [""] * len(words) if normal is None else [f"/{i}" for i in normal.tolist()]
            words = [f"{v}/{t}{n}" for v, t, n in zip(words, uv, normal)]
        self._faces(mesh, words, material_names, turned=matrix.is_negative)
        self.vertices += len(points)

    def _faces(self, mesh, words, material_names, turned):
        starts = _read(mesh.polygons, "loop_start", 1, np.int32).ravel()
        totals = _read(mesh.polygons, "loop_total", 1, np.int32).ravel()
        used = _read(mesh.polygons, "material_index", 1, np.int32).ravel()
        last = None
        for start, total, index in zip(starts.tolist(), totals.tolist(), used.tolist()):
            if index != last:
                self.file.write(f"usemtl {material_names[min(index, len(material_names) - 1)]}\n")
                last = index
            face = words[start:start + total]
            self.file.write("f " + " ".join(face[::-1] if turned else face) + "\n")

    def _uvs(self, mesh):
        layer = mesh.uv_layers.active and next((u for u in mesh.uv_layers if u.active_render), None)
        if not layer:
            return None
        rows, places = np.unique(_read(layer.uv, "vector", 2), axis=0, return_inverse=True)
        self.rows("vt", rows)
        self.uvs += len(rows)
        return places.ravel() + 1 + self.uvs - len(rows)

    def _normals(self, mesh, matrix):
        """None where all faces are flat: then there is nothing to smooth."""
        if mesh.normals_domain == "FACE":
            return None
        normals = _read(mesh.corner_normals, "vector", 3) @ np.linalg.inv(np.array(matrix)[:3, :3])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        rows, places = np.unique(normals.astype(np.float32), axis=0, return_inverse=True)
        self.rows("vn", to_clrt(rows))
        self.normals += len(rows)
        return places.ravel() + 1 + self.normals - len(rows)


def _read(collection, attribute, width, kind=np.float32):
    values = np.empty(len(collection) * width, dtype=kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width).astype(np.float64 if kind == np.float32 else kind)


class SceneFiles:
    """Writes scene.obj and scene.mtl into a folder."""

    def __init__(self, folder, notes):
        self.folder, self.notes, self.path = folder, notes, os.path.join(folder, "scene.obj")
        self.material_names = {}  # of a material or None -> its name in the files
        self.emits = False

    def write(self, depsgraph):
        """Returns the options of lamps. Lamps that have a size become surfaces."""
        options, surfaces = lights.lights_of(depsgraph, self.notes)
        with open(self.path, "w", encoding="utf-8") as file:
            file.write("mtllib scene.mtl\n")
            writer = ObjWriter(file)
            for instance in depsgraph.object_instances:
                if instance.show_self and instance.object.type in GEOMETRY:
                    self._object(writer, instance)
                elif instance.object.type in UNKNOWN:
                    self.notes.append(f"{instance.object.name} ({instance.object.type.lower()}) is left out")
            for i, surface in enumerate(surfaces):
                self._lamp(writer, surface, f"lamp {i}")
        with open(os.path.join(self.folder, "scene.mtl"), "w", encoding="utf-8") as file:
            file.write(materials.HEADER)
            for material, name in self.material_names.items():
                file.write(materials.material_text(material, name, self.folder, self.notes))
            for i, surface in enumerate(surfaces):
                file.write(f"newmtl lamp {i}\nillum 1\nKd 0 0 0\nKs 0 0 0\nKe {numbers(surface.radiance, ' ')}\n")
            file.write("newmtl lamp back\nillum 1\nKd 0 0 0\nKs 0 0 0\n")
        return options + (["--two-sided-lights"] if self.emits else [])

    def _object(self, writer, instance):
        own = instance.object
        mesh = own.to_mesh()
        if mesh and len(mesh.polygons):
            slots = [slot.material for slot in own.material_slots] or [None]
            writer.object(own.name)
            writer.mesh(mesh, instance.matrix_world, [self._material(m) for m in slots])
        own.to_mesh_clear()

    def _material(self, material):
        if material:
            material = material.original
        if material not in self.material_names:
            self.material_names[material] = material.name if material else "none"
            self.emits = self.emits or materials.emits(material)
        return self.material_names[material]

    def _lamp(self, writer, surface, material):
        writer.object(surface.name)
        writer.polygons(surface.vertices, surface.faces, material)
        if self.emits and len(surface.faces) == 1:
            corners = surface.vertices[surface.faces[0]]
            size = np.linalg.norm(corners - corners[0], axis=1).max()
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            behind = corners - BACK_DISTANCE * size * normal / np.linalg.norm(normal)
            writer.polygons(behind, [list(range(len(behind)))], "lamp back")
