# SPDX-License-Identifier: Apache-2.0
"""Reads scenes that any renderer shows alike: OBJ and MTL with matte, mirror, glass and emissive materials, and an options file
with camera, constant sky and a sun that is a point. Whatever else a file says is refused, for a scene that is only nearly the same
proves nothing."""
import dataclasses
import math
import os

# Options of clrt that do not change what is simulated.
HARMLESS = {"--spp", "--exposure", "--tonemap", "--size", "--seed", "--replicates"}
CAMERA = {"--eye", "--at", "--up", "--fov", "--focal-length", "--film-width"}
LIGHT_AND_DEPTH = {"--env", "--env-scale", "--sun", "--max-depth", "--roulette-depth"}
MATERIAL_KEYS = {"Ka", "Kd", "Ks", "Ke", "Tf", "Ni", "Ns", "d", "illum"}
# A polygon may be bent by this part of its size before two ways to cut it into triangles count as two shapes.
FLAT = 1e-4
BLACK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


class NotPlain(Exception):
    """Something that other renderers show otherwise, or that cannot be read; the message names file and line."""


@dataclasses.dataclass(frozen=True)
class Material:
    """`kind`: matte, mirror or glass; `colour`: reflectance; `emission`: radiance of the front; `ior`: of glass."""
    kind: str
    colour: tuple
    emission: tuple = BLACK
    ior: float = 1.0


@dataclasses.dataclass
class PlainScene:
    """Triangles by material. `triangles`: {(material's name, whether normals are given): [three corners of (point, normal)]}."""
    materials: dict
    triangles: dict
    options: dict  # of clrt: {name: text}

    def numbers(self, option, default=None):
        """The numbers of an option, or the default."""
        text = self.options.get(option)
        return default if text is None else _numbers(text.split(","), f"option {option}")

    @property
    def sky(self):
        """Radiance."""
        scale, = self.numbers("--env-scale", (1.0,))
        return tuple(scale * value for value in self.numbers("--env", BLACK))

    @property
    def sun(self):
        """(direction towards it, irradiance across it) or None."""
        numbers = self.numbers("--sun")
        return numbers and (numbers[:3], numbers[3:])

    @property
    def up(self):
        """Direction."""
        text = self.options.get("--up", "y")
        return {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}.get(text) or self.numbers("--up")

    def field_of_view(self, width, height):
        """Of the height of the film, degrees."""
        if "--focal-length" not in self.options:
            return self.numbers("--fov", (40.0,))[0]
        film_height = self.numbers("--film-width")[0] * height / width
        return 2 * math.degrees(math.atan(film_height / 2 / self.numbers("--focal-length")[0]))


def read_plain_scene(path):
    """The scene of an OBJ file and of what lies beside it. Raises NotPlain or OSError."""
    options = _read_options(os.path.splitext(path)[0] + ".clrt")
    lines = _lines(path)
    libraries = [words[1:] for _, words in lines if words[0] == "mtllib"]
    materials = {}
    for names in libraries:
        materials.update(_read_materials(os.path.join(os.path.dirname(path), " ".join(names))))
    scene = PlainScene(materials, _read_triangles(path, lines, materials), options)
    if not any(sum(materials[name].emission) for name, _ in scene.triangles) and not sum(scene.sky) and not scene.sun:
        raise NotPlain(f"{path}: expected a light, an emissive material, --sun or a constant --env, found none")
    return scene


def _lines(path):
    """[(where, words)] without comments and empty lines."""
    with open(path, encoding="utf-8", errors="replace") as file:
        split = [(f"{path}:{number}", line.split("#")[0].split()) for number, line in enumerate(file, 1)]
    return [(where, words) for where, words in split if words]


def _numbers(words, where, count=None):
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        values = ()
    if not values or (count and len(values) != count) or not all(map(math.isfinite, values)):
        raise NotPlain(f"{where}: expected {count or 'a list of'} numbers, found '{' '.join(words)}'")
    return values


def _read_options(path):
    """{option: text} of an options file."""
    options = {}
    for where, words in _lines(path):
        option = words[0]
        if option not in HARMLESS | CAMERA | LIGHT_AND_DEPTH:
            raise NotPlain(f"{where}: expected options of the camera, a constant --env, --sun or --max-depth, found {option}")
        if option == "--sun" and option in options:
            raise NotPlain(f"{where}: expected one --sun, found another")
        options[option] = " ".join(words[1:])
    for option in ("--eye", "--at"):
        if option not in options:
            raise NotPlain(f"{path}: expected {option}, found none: a camera that is fitted to the scene is clrt's own")
    for option, count in (("--env", 3), ("--sun", 6)):  # a seventh number of --sun, its diameter, is refused
        if option in options:
            _numbers(options[option].split(","), f"{path}: option {option}", count)
    return options


def _read_materials(path):
    """{name: Material} of a library."""
    found, name = {}, None
    for where, words in _lines(path):
        if words[0] == "newmtl":
            name = " ".join(words[1:])
            found[name] = (where, {})
        elif words[0] not in MATERIAL_KEYS:
            raise NotPlain(f"{where}: expected one of {', '.join(sorted(MATERIAL_KEYS))}, found {words[0]}")
        elif name is None:
            raise NotPlain(f"{where}: expected newmtl first, found {words[0]}")
        else:
            count = 3 if words[0] in ("Ka", "Kd", "Ks", "Ke", "Tf") else 1
            found[name][1][words[0]] = _numbers(words[1:], where, count)
    return {name: _material(where, said) for name, (where, said) in found.items()}


def _material(where, said):
    """The Material of what a library says."""
    diffuse, specular, emission = (said.get(key, BLACK) for key in ("Kd", "Ks", "Ke"))
    illum = int(said.get("illum", (1,))[0])
    if said.get("d", (1,)) != (1,):
        raise NotPlain(f"{where}: expected an opaque material, found d {said['d'][0]:g}")
    if illum == 7 and specular == WHITE and said.get("Tf") == WHITE and diffuse == BLACK and "Ni" in said:
        return Material("glass", WHITE, emission, said["Ni"][0])
    if illum == 3 and diffuse == BLACK and "Ns" not in said:
        return Material("mirror", specular, emission)
    if illum in (0, 1, 2) and specular == BLACK and "Kd" in said:
        return Material("matte", diffuse, emission)
    raise NotPlain(f"{where}: expected a matte material (Kd, no Ks), a mirror (Ks, illum 3) or clear glass (Ks and Tf 1 1 1, Ni, "
                   "illum 7), found something else")


def _read_triangles(path, lines, materials):
    """{(material, with normals): triangles}."""
    points, normals, triangles, used = [], [], {}, None
    for where, words in lines:
        if words[0] == "v":
            points.append(_numbers(words[1:], where, 3))
        elif words[0] == "vn":
            normals.append(_numbers(words[1:], where, 3))
        elif words[0] == "usemtl":
            used = " ".join(words[1:])
            if used not in materials:
                raise NotPlain(f"{where}: expected a material of the library, found {used}")
        elif words[0] == "f":
            if used is None:
                raise NotPlain(f"{where}: expected usemtl before the first face, found none")
            corners = [_corner(word, points, normals, where) for word in words[1:]]
            smooth = all(normal is not None for _, normal in corners)
            triangles.setdefault((used, smooth), []).extend(_fan(corners, where))
        elif words[0] == "s" and words[1:] not in (["off"], ["0"]):
            raise NotPlain(f"{where}: expected no smoothing group, found {' '.join(words)}")
        elif words[0] not in ("vt", "o", "g", "s", "mtllib"):
            raise NotPlain(f"{where}: expected vertices and faces, found {words[0]}")
    if not triangles:
        raise NotPlain(f"{path}: expected faces, found none")
    return triangles


def _corner(word, points, normals, where):
    """(point, normal or None) of `7`, `7/1`, `7//3` or `7/1/3`, counted from 1 or, negative, from the end."""
    def at(table, text):
        index = int(text)
        return table[index - 1 if index > 0 else len(table) + index]

    parts = word.split("/")
    try:
        return at(points, parts[0]), at(normals, parts[2]) if len(parts) > 2 and parts[2] else None
    except (ValueError, IndexError) as error:
        raise NotPlain(f"{where}: expected the number of a vertex above, found {word}") from error


def _fan(corners, where):
    """Triangles of a convex polygon, quads cut along the shorter diagonal as in clrt; larger ones must be flat, or ways to cut
    them differ."""
    if len(corners) == 4 and _distance(corners[1], corners[3]) < _distance(corners[0], corners[2]):
        corners = corners[1:] + corners[:1]
    origin = corners[0][0]
    edges = [tuple(b - a for a, b in zip(origin, point)) for point, _ in corners[1:]]
    crosses = [cross(u, v) for u, v in zip(edges, edges[1:])]
    total = tuple(map(sum, zip(*crosses)))
    length, size = math.hypot(*total), max((math.hypot(*edge) for edge in edges), default=0)
    bent = len(corners) > 4 and any(abs(_dot(edge, total)) > FLAT * size * length for edge in edges)
    crossed = len(corners) > 3 and length == 0
    if not crosses or bent or crossed or any(_dot(cross, total) < 0 for cross in crosses):
        raise NotPlain(f"{where}: expected a convex polygon, flat where it has more than four corners, found another")
    return [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]


def _distance(a, b):
    return math.dist(a[0], b[0])


def cross(a, b):
    """The cross product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    """The vector of length 1; a zero vector raises ZeroDivisionError."""
    length = math.hypot(*a)
    return tuple(part / length for part in a)


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))
