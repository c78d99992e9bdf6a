# SPDX-License-Identifier: Apache-2.0
"""Shapes with checked winding, and writers for OBJ and PNG, for make_scenes.py and make_mesh.py."""

import math
import struct
import zlib

CREASE_DEGREES = 40  # a profile that turns by more than this keeps a sharp edge


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scale(a, 1 / math.sqrt(dot(a, a)))


def polygon_normal(points):
    """Unit normal of the front side: the side from which the corners run counter-clockwise (Newell's method)."""
    total = (0.0, 0.0, 0.0)
    for a, b in zip(points, points[1:] + points[:1]):
        total = add(total, cross(a, b))
    return unit(total)


def icosphere(level):
    """Unit sphere of 20 * 4^level triangles: (points, triangles), wound counter-clockwise from outside."""
    g = (1 + math.sqrt(5)) / 2
    points = [unit(p) for p in
              [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
               (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
                 (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
                 (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit(add(points[a], points[b])))
            return middles[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return points, triangles


def profile_normals(profile):
    """Normals (radial, up) at both ends of every segment of a profile; averaged where the profile bends gently."""
    flat = []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, y1 - y0)
        flat.append(((y1 - y0) / length, (r0 - r1) / length))

    def between(i, j):
        if not 0 <= j < len(flat) or dot(flat[i], flat[j]) < math.cos(math.radians(CREASE_DEGREES)):
            return flat[i]
        return unit(add(flat[i], flat[j]))

    return [(between(i, i - 1), between(i, i + 1)) for i in range(len(flat))]


class Obj:
    """An OBJ file in the making. Equal positions, texture coordinates and normals are written once."""

    def __init__(self, title):
        self.title = title
        self.tables = {"v": {}, "vt": {}, "vn": {}}
        self.body = []
        self.used_material = None

    def begin(self, name, material):
        """Starts an object; the faces that follow belong to it."""
        self.body.append("o " + name)
        if material != self.used_material:
            self.body.append("usemtl " + material)
            self.used_material = material

    def index(self, kind, values):
        text = " ".join(f"{round(x, 5) + 0.0:.6g}" for x in values)
        table = self.tables[kind]
        return table.setdefault(text, len(table) + 1)

    def face(self, points, uvs=None, normals=None, towards=None):
        """Adds a polygon; its front must look along `towards` and along its own normals."""
        front = polygon_normal(points)
        for direction in ([towards] if towards else []) + (normals or []):
            assert dot(front, direction) > 0, f"{self.title}: {self.body[-1]}: a face is wound the wrong way"
        corners = []
        for i, point in enumerate(points):
            corner = str(self.index("v", point))
            if uvs or normals:
                corner += "/" + (str(self.index("vt", uvs[i])) if uvs else "")
            if normals:
                corner += "/" + str(self.index("vn", normals[i]))
            corners.append(corner)
        assert len(set(corners)) == len(corners), f"{self.title}: {self.body[-1]}: a face has a repeated corner"
        self.body.append("f " + " ".join(corners))

    def quad(self, corner, edge_u, edge_v, towards, repeat=None):
        """A parallelogram with its front along `towards`; `repeat` (times in u, in v) gives it texture coordinates."""
        points = [corner, add(corner, edge_u), add(add(corner, edge_u), edge_v), add(corner, edge_v)]
        u, v = repeat or (0, 0)
        uvs = [(0, 0), (u, 0), (u, v), (0, v)]
        if dot(cross(edge_u, edge_v), towards) < 0:
            points.reverse()
            uvs.reverse()
        self.face(points, uvs if repeat else None, None, towards)

    def box(self, low, high, without=()):
        """A box seen from outside; `without` names faces to leave out, such as "-y" where it stands on the floor."""
        for axis in range(3):
            size = subtract(high, low)
            u, v = [tuple(size[k] if k == other else 0 for k in range(3)) for other in range(3) if other != axis]
            for sign, name in ((-1, "-"), (1, "+")):
                if name + "xyz"[axis] in without:
                    continue
                corner = tuple(high[k] if k == axis and sign > 0 else low[k] for k in range(3))
                self.quad(corner, u, v, tuple(sign if k == axis else 0 for k in range(3)))

    def sphere(self, centre, radius, level, smooth=True, inward=False):
        """An icosphere; `smooth` gives vertex normals, `inward` turns the front inside."""
        points, triangles = icosphere(level)
        for triangle in triangles:
            directions = [points[i] for i in triangle]
            if inward:
                directions = [scale(d, -1) for d in directions]
            corners = [add(centre, scale(d, -radius if inward else radius)) for d in directions]
            if inward:
                corners.reverse()
                directions.reverse()
            self.face(corners, None, directions if smooth else None, directions[0])

    def lathe(self, axis_foot, profile, segments):
        """A profile of (radius, height) turned about a vertical axis; its front is to the right of the way it runs,
        so that a profile that runs upwards shows its outside."""
        def place(r, y, angle):
            return add(axis_foot, (r * math.cos(angle), y, -r * math.sin(angle)))

        for k in range(segments):
            a0, a1 = (2 * math.pi * (k + i) / segments for i in (0, 1))
            for (p, q), (np, nq) in zip(zip(profile, profile[1:]), profile_normals(profile)):
                corners = [(p, np, a0), (p, np, a1), (q, nq, a1), (q, nq, a0)]
                if p[0] == 0:
                    corners.pop(0)
                if q[0] == 0:
                    corners.pop(2 if p[0] != 0 else 1)
                self.face([place(*at, a) for at, _, a in corners], None,
                          [(n[0] * math.cos(a), n[1], -n[0] * math.sin(a)) for _, n, a in corners])

    def text(self, material_file):
        lines = ["# " + self.title, "mtllib " + material_file]
        for kind, table in self.tables.items():
            lines += [kind + " " + values for values in table]
        return "\n".join(lines + self.body) + "\n"


def png(rows):
    """An 8-bit PNG of rows of pixels, top row first; a pixel is a tuple of 1 (grey), 3 (RGB) or 4 (RGBA) integers."""
    channels = len(rows[0][0])
    colour_type = {1: 0, 3: 2, 4: 6}[channels]
    raw = b""
    for row in rows:
        values = bytes(v for pixel in row for v in pixel)
        # Filter 1: each byte as its difference from the pixel to the left; it compresses better.
        raw += b"\1" + bytes((values[i] - (values[i - channels] if i >= channels else 0)) & 255
                             for i in range(len(values)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def png_pixels(data):
    """What a file written by png() says, without the freedom that compression has: (header, uncompressed rows)."""
    size = struct.unpack(">I", data[33:37])[0]
    return data[:33], zlib.decompress(data[41:41 + size])
