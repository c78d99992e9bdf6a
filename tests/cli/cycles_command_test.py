# SPDX-License-Identifier: Apache-2.0
"""The command clrt-cycles with stand-ins for Blender and clrt, and with Cycles itself where Python has it:
cycles_command_test.py PATH/clrt. What it has in common with clrt-mitsuba is tested there."""
import importlib.util
import json
import math
import os
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
TOOLS, SUPPORT = os.path.join(ROOT, "tools"), os.path.join(ROOT, "tests", "support")
FAKE_CLRT, FAKE_BPY = os.path.join(SUPPORT, "fake_clrt.py"), os.path.join(SUPPORT, "fake_bpy")
CORNELL_BOX = os.path.join(ROOT, "scenes", "cornell_box", "cornell_box.obj")
CLRT = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")
ABSENT = 'raise ImportError("No module named \'bpy\'", name="bpy")\n'
sys.path.insert(0, TOOLS)

from clrt_tools import cycles_scene  # noqa: E402 (needs the path above)
from clrt_tools.plain_scene import read_plain_scene  # noqa: E402

# A mirror, glass with normals of its own and a lamp, under a sun and a sky.
SCENE = """mtllib s.mtl
v 0 0 0
v 1 0 0
v 0 1 0
vn 0 0 1
usemtl mirror
f 1 2 3
usemtl glass
f 1//1 2//1 3//1
usemtl lamp
f 1 2 3
"""
MATERIALS = """newmtl mirror
Kd 0 0 0
Ks 0.9 0.9 0.9
illum 3
newmtl glass
Kd 0 0 0
Ks 1 1 1
Tf 1 1 1
Ni 1.5
illum 7
newmtl lamp
Kd 0 0 0
Ke 3 2 1
"""
OPTIONS = "--eye 0,0,5\n--at 0,0,0\n--sun 0,1,0,4,2,1\n--env 1,2,3\n--max-depth 4\n"


class CyclesCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def series(self, *arguments, packages=FAKE_BPY, clrt=FAKE_CLRT, spp="4,16", **settings):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-cycles"), CORNELL_BOX, "--clrt", clrt, "-r", "40x30",
                               "--spp", spp, "-o", "series", *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, check=False, env={**os.environ, "FAKE_CLRT_SAMPLES": "1e9", "PYTHONPATH": packages,
                                                             "PYTHONDONTWRITEBYTECODE": "1", **settings})
        self.assertNotIn("Traceback", done.stderr)
        return done

    def test_makes_a_series(self):
        done = self.series("--repeats", "2", FAKE_BPY_LOG="log")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"^4 pictures in series; mean over that of clrt's: [+-]\d\.\d\d % \+- \d\.\d\d %\n$")
        with open(os.path.join(self.folder, "series", "series.json"), encoding="utf-8") as file:
            said = json.load(file)
        self.assertEqual(said["name"], "Cycles 4.5.0")
        self.assertEqual({(p["file"], p["spp"], p["seed"]) for p in said["pictures"]},
                         {(f"spp{spp}_seed{seed}.exr", spp, seed) for spp in (4, 16) for seed in (1, 2)})
        for picture in said["pictures"]:
            self.assertTrue(os.path.isfile(os.path.join(self.folder, "series", picture["file"])))
        with open(os.path.join(self.folder, "log"), encoding="utf-8") as file:
            self.assertEqual(set(file.read().split("\n")) - {""}, {f"{spp} spp, guiding False, tree True" for spp in (1, 4, 16)})

    def test_its_options_reach_cycles_and_the_legend(self):
        done = self.series("--repeats", "2", "--guiding", "--no-light-tree", FAKE_BPY_LOG="log")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(self.folder, "series", "series.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["name"], "Cycles 4.5.0, guiding, no light tree")
        with open(os.path.join(self.folder, "log"), encoding="utf-8") as file:
            self.assertIn("16 spp, guiding True, tree False\n", file.read())

    def test_says_what_is_missing_or_differs(self):
        with open(os.path.join(self.folder, "bpy.py"), "w", encoding="utf-8") as file:
            file.write(ABSENT)
        done = self.series(packages=self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^clrt-cycles: error: expected the Python package bpy, found none in .*; pip install bpy numpy,")
        done = self.series("--repeats", "2", FAKE_BPY_BRIGHTNESS="0.55")
        self.assertEqual((done.returncode, "the two do not render the same scene" in done.stderr), (1, True), done.stderr)

    @unittest.skipUnless(importlib.util.find_spec("bpy"), "needs the Python package bpy")
    def test_cycles_itself_shows_the_same_scene(self):
        done = self.series("--repeats", "4", "-d", DEVICE, packages="", clrt=CLRT, spp="16")
        self.assertEqual(done.returncode, 0, done.stderr)


class CyclesScene(unittest.TestCase):
    """What Blender is told."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for name, text in (("s.obj", SCENE), ("s.mtl", MATERIALS), ("s.clrt", OPTIONS)):
            with open(os.path.join(folder.name, name), "w", encoding="utf-8") as file:
                file.write(text)
        sys.path.insert(0, FAKE_BPY)
        self.addCleanup(sys.path.remove, FAKE_BPY)
        import bpy
        self.bpy = bpy
        self.scene = read_plain_scene(os.path.join(folder.name, "s.obj"))
        self.addCleanup(bpy.data.reset_mock)

    def test_no_light_is_cut(self):
        cycles = cycles_scene.build_scene(self.bpy, self.scene, 40, 30).cycles
        self.assertEqual((cycles.max_bounces, cycles.diffuse_bounces, cycles.transmission_bounces), (3, 3, 3))
        self.assertEqual((cycles.sample_clamp_indirect, cycles.sample_clamp_direct, cycles.blur_glossy), (0, 0, 0))
        self.assertFalse(cycles.use_adaptive_sampling or cycles.use_denoising)

    def test_camera_and_sun_look_where_they_should(self):
        by_name = {}

        def make(name, data):
            return by_name.setdefault(name, types.SimpleNamespace(data=data))
        with mock.patch.object(self.bpy.data.objects, "new", make):
            cycles_scene.build_scene(self.bpy, self.scene, 40, 30)
        self.assertEqual(by_name["camera"].matrix_world, [(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 5, 1)])
        self.assertTrue(math.isclose(by_name["camera"].data.angle_y, math.radians(40)))
        self.assertEqual(by_name["sun"].matrix_world[2][:3], (0, 1, 0), "shines along its -z")
        self.assertEqual((by_name["sun"].data.energy, by_name["sun"].data.color), (4, [1, 0.5, 0.25]))
        self.assertEqual(set(by_name), {"camera", "sun", "mirror", "glass", "lamp"})


if __name__ == "__main__":
    unittest.main()
