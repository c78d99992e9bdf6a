# SPDX-License-Identifier: Apache-2.0
"""The command clrt-agree with the built clrt: agree_command_test.py PATH/clrt. A tiny scene, few seeds."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
CLRT = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")
AGREE, DISAGREE, USAGE = 0, 1, 2

# A floor and a wall under a lamp.
SCENE = """mtllib scene.mtl
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v -1 1 -1
v 1 1 -1
v -0.5 2 -0.5
v 0.5 2 -0.5
v 0.5 2 0.5
v -0.5 2 0.5
usemtl matte
f 1 2 3 4
f 1 5 6 2
usemtl lamp
f 7 8 9 10
"""
MATERIALS = "newmtl matte\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n"


class AgreeCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name, text in (("scene.obj", SCENE), ("scene.mtl", MATERIALS)):
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                file.write(text)

    def run_command(self, *arguments):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-agree"), *arguments], cwd=self.folder,
                              capture_output=True, text=True, timeout=300, check=False)
        return done.returncode, done.stdout, done.stderr

    def study(self, *groups):
        code, out, error = self.run_command("scene.obj", "--clrt", CLRT, "-d", DEVICE, "-r", "16x12", "-s", "64", "--seeds", "5",
                                            "--margin", "10", "--stats", "a.json", *groups)
        self.assertIn(code, (AGREE, DISAGREE), error)
        with open(os.path.join(self.folder, "a.json"), encoding="utf-8") as file:
            return code, out, json.load(file)

    def test_what_simulates_the_same_agrees(self):
        _, out, found = self.study("-g", "path", "bdpt", "-g", "raycast", "path --paths LD?E")
        self.assertEqual([(each["a"], each["b"], each["verdict"]) for each in found["pairs"]],
                         [("path", "bdpt", "equivalent"), ("raycast", "path --paths LD?E", "equivalent")])
        self.assertEqual({each["method"]: each["count"] for each in found["error_bars"]},
                         {"path": 5, "bdpt": 5, "raycast": 5, "path --paths LD?E": 5})
        self.assertIn("2 pairs: 2 equivalent, 0 undecided, 0 different", out)

    def test_a_scene_that_asks_for_paths_is_rendered_by_what_takes_them(self):
        with open(os.path.join(self.folder, "scene.clrt"), "w", encoding="utf-8") as file:
            file.write("--paths LD?E\n")
        _, out, found = self.study()
        self.assertEqual([(each["a"], each["b"], each["verdict"]) for each in found["pairs"]],
                         [("path", "distribution --min-contribution 0", "equivalent")])
        self.assertIn("1 pairs: 1 equivalent", out)

    def test_what_lacks_paths_differs(self):
        code, out, _ = self.study("-g", "path", "raycast")
        self.assertEqual(code, DISAGREE)
        self.assertIn("1 different", out)

    def test_faults_are_one_line(self):
        for arguments in ((), ("scene.obj", "--seeds", "2"), ("scene.obj", "-s", "0")):
            code, out, error = self.run_command(*arguments)
            self.assertEqual((code, out), (USAGE, ""), arguments)
            self.assertTrue(error.startswith("clrt-agree: error: ") and error.count("\n") == 1, error)
        code, _, error = self.run_command("none.obj", "--clrt", CLRT)
        self.assertEqual(code, DISAGREE)
        self.assertIn("none.obj", error)


if __name__ == "__main__":
    unittest.main()
