# SPDX-License-Identifier: Apache-2.0
"""Integrators that simulate the same paths give the same picture: clrt-compare calls each pair equivalent within half a
percent, and a path that one of them lacks different.

    integrator_pairs_test.py CLRT"""
import os
import subprocess
import sys
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
EQUIVALENT, DIFFERENT = 0, 1
# Corners of a box: bit 0 is x, bit 1 is y, bit 2 is z. Faces outwards.
FACES = ((4, 5, 7, 6), (1, 0, 2, 3), (5, 1, 3, 7), (0, 4, 6, 2), (6, 7, 3, 2), (0, 1, 5, 4))
FRONT = 0

MATERIALS = """newmtl white
Kd 0.7 0.7 0.7
newmtl red
Kd 0.6 0.1 0.1
newmtl mirror
Kd 0 0 0
Ks 0.9 0.9 0.9
illum 3
newmtl glass
Ks 1 1 1
Ni 1.5
illum 7
newmtl lamp
Kd 0 0 0
Ke 8 7 5
"""


def box(material, low, high, without=()):
    """OBJ text of a box; negative indices count from its own corners."""
    corners = "".join("v %g %g %g\n" % tuple((low, high)[i >> axis & 1][axis] for axis in range(3)) for i in range(8))
    faces = "".join("f %d %d %d %d\n" % tuple(corner - 8 for corner in face)
                    for i, face in enumerate(FACES) if i not in without)
    return corners + "usemtl %s\n" % material + faces


# A room whose front is open, with a lamp, a mirror and a block of glass.
SCENE = ("mtllib room.mtl\n" + box("white", (-1, 0, -2), (1, 2, 1), without=(FRONT,)) +
         box("red", (-0.99, 0.3, -1), (-0.98, 1.5, 0)) + box("mirror", (-0.7, 0.01, -1.3), (-0.2, 1.1, -0.9)) +
         box("glass", (0.15, 0.01, -0.8), (0.6, 0.8, -0.5)) +
         "usemtl lamp\nv -0.6 1.95 -1.2\nv 0.6 1.95 -1.2\nv 0.6 1.95 -0.2\nv -0.6 1.95 -0.2\nf -4 -3 -2 -1\n")
VIEW = ["--eye", "0,1,3.2", "--at", "0,1,-1", "--fov", "45", "--env", "0,0,0", "-r", "64x64"]


class IntegratorPairs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        for name, text in (("room.obj", SCENE), ("room.mtl", MATERIALS)):
            with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
                file.write(text)

    def film(self, seed, samples, *options):
        """Renders a film file; every call has a seed of its own."""
        name = os.path.join(self.folder, "%d.film" % seed)
        subprocess.run([sys.argv[1], "room.obj", *VIEW, "-s", str(samples), "--seed", str(seed), "-q", "--checkpoint", name,
                        "-o", name + ".exr", "--aov", "none", *options], cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
        return name

    def verdict(self, a, b):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-compare"), a, b, "--margin", "0.5%"],
                              capture_output=True, text=True, timeout=120, check=False)
        print(done.stdout.splitlines()[-1])
        return done.returncode, done.stdout + done.stderr

    def test_ray_casting_is_direct_light(self):
        code, out = self.verdict(self.film(1, 512, "-i", "raycast"), self.film(2, 512, "--paths", "LD?E", "--max-depth", "2"))
        self.assertEqual(code, EQUIVALENT, out)

    def test_whitted_is_direct_light_through_mirrors_and_glass(self):
        whitted = self.film(3, 512, "-i", "whitted", "--min-contribution", "0", "--max-depth", "6")
        code, out = self.verdict(whitted, self.film(4, 2048, "--paths", "LD?S*E", "--max-depth", "6"))
        self.assertEqual(code, EQUIVALENT, out)
        code, out = self.verdict(whitted, self.film(5, 64, "--max-depth", "6"))
        self.assertEqual(code, DIFFERENT, out)

    def test_distribution_is_whitted_where_nothing_is_rough(self):
        tree = self.film(6, 256, "-i", "distribution", "--max-depth", "6")
        code, out = self.verdict(tree, self.film(7, 2048, "--paths", "LD?S*E", "--max-depth", "6"))
        self.assertEqual(code, EQUIVALENT, out)
        code, out = self.verdict(tree, self.film(8, 512, "-i", "raycast"))
        self.assertEqual(code, DIFFERENT, out)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
