# SPDX-License-Identifier: Apache-2.0
"""The command clrt-mitsuba with stand-ins for Mitsuba and clrt, and with Mitsuba itself where Python has it:
mitsuba_command_test.py PATH/clrt."""
import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
TOOLS, SUPPORT = os.path.join(ROOT, "tools"), os.path.join(ROOT, "tests", "support")
FAKE_CLRT, FAKE_MITSUBA = os.path.join(SUPPORT, "fake_clrt.py"), os.path.join(SUPPORT, "fake_mitsuba")
CORNELL_BOX = os.path.join(ROOT, "scenes", "cornell_box", "cornell_box.obj")
CLRT = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")
ABSENT = 'raise ImportError("No module named \'mitsuba\'", name="mitsuba")\n'


class MitsubaCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_tool(self, name, *arguments, packages=FAKE_MITSUBA, **settings):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, name), *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, check=False, env={**os.environ, "FAKE_CLRT_SAMPLES": "1e9", "PYTHONPATH": packages,
                                                             "PYTHONDONTWRITEBYTECODE": "1", **settings})
        self.assertNotIn("Traceback", done.stderr)
        return done

    def series(self, *arguments, scene=CORNELL_BOX, **settings):
        return self.run_tool("clrt-mitsuba", scene, "--clrt", FAKE_CLRT, "--variant", "fake_rgb", "-r", "40x30", "--spp", "4,16",
                             "--repeats", "2", "-o", "series", *arguments, **settings)

    def listed(self):
        return os.listdir(os.path.join(self.folder, "series"))

    def test_one_thread_renders_but_does_not_write(self):
        done = self.series("-j", "1")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_makes_a_series_that_clrt_study_draws(self):
        done = self.series()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"^4 pictures in series; mean over that of clrt's: [+-]\d\.\d\d % \+- \d\.\d\d %\n$")
        with open(os.path.join(self.folder, "series", "series.json"), encoding="utf-8") as file:
            said = json.load(file)
        self.assertEqual(said["name"], "Mitsuba 3.0.0 path, fake_rgb, independent")
        self.assertEqual({(p["file"], p["spp"], p["seed"]) for p in said["pictures"]},
                         {(f"spp{spp}_seed{seed}.exr", spp, seed) for spp in (4, 16) for seed in (1, 2)})
        self.assertTrue(all(p["seconds"] > 0 and p["cpu_seconds"] >= 0 for p in said["pictures"]))
        self.study()

    def study(self):
        done = self.run_tool("clrt-study", CORNELL_BOX, "--clrt", FAKE_CLRT, "-i", "path", "-p", "single", "--samplers", "sobol",
                             "--spp", "4,16", "--repeats", "2", "--reference-spp", "256", "--against", "series", "-o", "page.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout.splitlines()[0], "at 40x30.* clrt's default and Mitsuba 3.0.0 path, fake_rgb, independent: ")
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertEqual(len(re.findall(r'<tr class="ratio"><td>Mitsuba 3.0.0 path', page)), 1)
        self.assertEqual(len(re.findall(r'<tr class="number"><td>Mitsuba 3.0.0 path', page)), 2)
        self.assertIn("difference of Mitsuba 3.0.0 path, fake_rgb, independent", page)
        with open(os.path.join(self.folder, "page.csv"), encoding="utf-8") as file:
            self.assertEqual(len(re.findall("Mitsuba 3.0.0", file.read())), 4)
        done = self.run_tool("clrt-study", CORNELL_BOX, "--clrt", FAKE_CLRT, "-r", "80x60", "--against", "series")
        self.assertEqual((done.returncode, "series: expected pictures of 80x60, found 40x30" in done.stderr), (1, True), done.stderr)

    def test_refuses_a_renderer_that_shows_another_scene(self):
        self.assertEqual(self.series().returncode, 0)
        done = self.series(FAKE_MITSUBA_BRIGHTNESS="0.55")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"error: expected the mean of clrt's pictures, found \+(9|10)\.\d\d % \+- ")
        self.assertIn("256 spp, seed 10001, for the mean alone", done.stderr, "looks twice before it refuses")
        self.assertNotIn("series.json", self.listed(), "no list of other pictures stays")

    def test_says_what_it_cannot_do(self):
        with open(os.path.join(self.folder, "mitsuba.py"), "w", encoding="utf-8") as file:
            file.write(ABSENT)
        done = self.series(packages=self.folder + os.pathsep + FAKE_MITSUBA)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^clrt-mitsuba: error: expected the Python package mitsuba, found none in .*; pip install mitsuba")
        scene = os.path.join(ROOT, "scenes", "glossy_plates", "glossy_plates.obj")
        for code, expected, arguments, settings in (
                (1, r"glossy_plates\.mtl:\d+: expected one of .*, found Pm", (), {"scene": scene}),
                (1, "expected one of fake_rgb as --variant, found llvm_ad_rgb", ("--variant", "llvm_ad_rgb"), {}),
                (1, "clrt: .*No such file", ("--clrt", "./none/clrt"), {}),
                (2, "option --size: expected WxH such as 320x240, found '40'", ("-r", "40"), {}),
                (2, "option --spp: expected whole numbers from 1", ("--spp", "0"), {})):
            done = self.series(*arguments, **settings)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertRegex(done.stderr, expected if code == 2 else "error: .*" + expected.removeprefix("clrt: "))

    @unittest.skipUnless(importlib.util.find_spec("mitsuba"), "needs the Python package mitsuba")
    def test_mitsuba_itself_shows_the_same_scene(self):
        done = self.run_tool("clrt-mitsuba", CORNELL_BOX, "--clrt", CLRT, "-d", DEVICE, "-r", "32x32", "--spp", "16", "--repeats", "4",
                             "-o", "series", packages="")
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
