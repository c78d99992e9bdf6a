# SPDX-License-Identifier: Apache-2.0
"""Includes go down: no file of src/ or kernels/ includes what stands above its own folder. This is where the order is
written down."""
import os
import re
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))

# Low to high: a folder knows itself and those before it. A folder that is not named belongs to the one around it.
HOST = (
    ("kernels/shared", "structs that host and kernels share"),
    ("src", "its headers: errors, exit codes, seconds, colours"),
    ("src/options", "what a user asks for, as plain structs"),
    ("src/console", "log, progress line, terminal, signals"),
    ("src/images", "OpenImageIO, loaded when it is needed"),
    ("src/codecs", "Draco and meshoptimizer, loaded when they are needed"),
    ("src/http", "cpp-httplib, loaded when it is needed"),
    ("src/output", "pictures and other files"),
    ("src/bvh", "trees over triangles"),
    ("src/device", "OpenCL: devices, programs, buffers"),
    ("src/scene", "files -> triangles, materials, textures, lights, camera"),
    ("src/paths", "the path notation"),
    ("src/effects", "what the scene calls for, and what is left out"),
    ("src/guide", "where paths have found light"),
    ("src/film", "sums, their error, film files"),
    ("src/denoise", "film and features -> a smoother picture, and its error"),
    ("src/render", "scene -> film"),
    ("src/replay", "single samples once more, value by value"),
    ("src/view", "who sees a run while it goes on: tev, the page"),
    ("src/run", "one render from start to saved picture, and its report"),
    ("src/app", "the command line: knows everybody"),
    ("src/*.cpp", "main() of each program"),
)
KERNELS = (
    ("kernels/shared", "structs that host and kernels share"),
    ("kernels/numerics", "numbers, vectors, random numbers, sampling"),
    ("kernels/trace", "values of a sample that is replayed"),
    ("kernels/geometry", "rays, triangles, trees, surfaces, textures"),
    ("kernels/scattering", "materials and their lobes"),
    ("kernels/lights", "emitters, sky, points and suns"),
    ("kernels/camera", "rays of pixels"),
    ("kernels/film", "sums of pixels"),
    ("kernels/denoise", "a picture's colours smoothed along its features"),
    ("kernels/path", "what integrators share: visibility, path notation, layers"),
    ("kernels/integrators", "the entry points"),
)

# Arrows up that are still there, from folder to folder. One that is gone must leave this list, and none may join it.
UPWARD = []

SUFFIXES = (".h", ".cpp", ".cl")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)


def source_files(top):
    """The sources below a folder, as paths from the project's folder."""
    for folder, _, names in os.walk(os.path.join(ROOT, top)):
        for name in sorted(names):
            if name.endswith(SUFFIXES):
                yield os.path.relpath(os.path.join(folder, name), ROOT)


def resolved(including, name, search):
    """The file that #include "name" means: beside the including file, else in the first folder that has it; else None."""
    for folder in (os.path.dirname(including), *search):
        path = os.path.normpath(os.path.join(folder, name))
        if os.path.isfile(os.path.join(ROOT, path)):
            return path
    return None


def includes_of(top, search):
    """(including, name, included) of every #include "name" below a folder."""
    for path in source_files(top):
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            for name in INCLUDE.findall(file.read()):
                yield path, name, resolved(path, name, search)


def place(path, order):
    """The folder of the order that a file belongs to."""
    names = [folder for folder, _ in order]
    folder, name = os.path.split(path)
    if folder == "src" and name.endswith(".cpp"):
        return "src/*.cpp"
    while folder not in names:
        folder = os.path.dirname(folder)
    return folder


def upward_arrows(edges, order):
    """Folder to folder, with the includes that make each arrow."""
    height = {folder: i for i, (folder, _) in enumerate(order)}
    found = {}
    for path, _, included in edges:
        arrow = (place(path, order), place(included, order))
        if height[arrow[0]] < height[arrow[1]]:
            found.setdefault(arrow, []).append(f"{path} includes {included}")
    return found


def first_circle(edges):
    """The files of a circle of includes, or None."""
    below = {}
    for path, _, included in edges:
        below.setdefault(path, []).append(included)
    done, way = set(), []

    def visit(path):
        if path in way:
            return way[way.index(path):] + [path]
        if path in done:
            return None
        way.append(path)
        circle = next(filter(None, map(visit, below.get(path, []))), None)
        way.pop()
        done.add(path)
        return circle

    return next(filter(None, map(visit, below)), None)


HOST_INCLUDES = list(includes_of("src", ("src", ".")))
KERNEL_INCLUDES = list(includes_of("kernels", ("kernels",)))


class IncludeArrows(unittest.TestCase):
    def test_every_include_is_found(self):
        for path, name, included in HOST_INCLUDES + KERNEL_INCLUDES:
            self.assertIsNotNone(included, f'{path}: #include "{name}"')

    def test_none_goes_up_but_those_of_the_list(self):
        found = {**upward_arrows(HOST_INCLUDES, HOST), **upward_arrows(KERNEL_INCLUDES, KERNELS)}
        for arrow, places in found.items():
            self.assertIn(arrow, UPWARD, "\n".join(["", *places]))

    def test_every_row_of_the_list_is_still_there(self):
        found = {**upward_arrows(HOST_INCLUDES, HOST), **upward_arrows(KERNEL_INCLUDES, KERNELS)}
        self.assertEqual(set(UPWARD) - found.keys(), set())

    def test_every_folder_of_the_order_exists(self):
        for folder, _ in HOST + KERNELS:
            self.assertTrue(folder == "src/*.cpp" or os.path.isdir(os.path.join(ROOT, folder)), folder)

    def test_no_files_include_each_other(self):
        self.assertIsNone(first_circle(HOST_INCLUDES))
        self.assertIsNone(first_circle(KERNEL_INCLUDES))

    def test_programs_that_are_installed_know_no_test(self):
        for path, name, included in includes_of("tools", ("tools", "src", ".", "kernels")):
            self.assertIsNotNone(included, f'{path}: #include "{name}"')


if __name__ == "__main__":
    unittest.main()
