# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/plain_scene.py and mitsuba_scene.py: what is read, what is refused, and what Mitsuba is told."""
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
from clrt_tools import mitsuba_scene, plain_scene  # noqa: E402
from clrt_tools.plain_scene import NotPlain, read_plain_scene  # noqa: E402

OBJECT = """mtllib scene.mtl
v 0 0 0
v 2 0 0
v 2 1 0
v 0 1 0
vn 0 0 1
usemtl matte
f 1 2 3 4
usemtl light
f -4//1 -3//1 -2//1
"""
LIBRARY = "newmtl matte\nKd 0.7 0.6 0.5\nnewmtl light\nKd 0 0 0\nKe 3 2 1\n"
OPTIONS = "--eye 1,2,3\n--at 0,0,0\n--fov 33\n--spp 64\n"


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def read(self, obj=OBJECT, mtl=LIBRARY, options=OPTIONS):
        for suffix, text in ((".obj", obj), (".mtl", mtl), (".clrt", options)):
            with open(os.path.join(self.folder, "scene" + suffix), "w", encoding="utf-8") as file:
                file.write(text)
        return read_plain_scene(os.path.join(self.folder, "scene.obj"))


class Reading(Scenes):
    def test_takes_what_any_renderer_shows_alike(self):
        scene = self.read(mtl=LIBRARY + "newmtl glass\nKd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7\n"
                          "newmtl mirror\nKd 0 0 0\nKs .9 .8 .7\nillum 3\n")
        self.assertEqual({name: (m.kind, m.colour) for name, m in scene.materials.items()},
                         {"matte": ("matte", (0.7, 0.6, 0.5)), "light": ("matte", (0, 0, 0)), "glass": ("glass", (1, 1, 1)),
                          "mirror": ("mirror", (0.9, 0.8, 0.7))})
        self.assertEqual(scene.materials["light"].emission, (3, 2, 1))
        self.assertEqual(scene.materials["glass"].ior, 1.5)
        self.assertEqual({key: len(triangles) for key, triangles in scene.triangles.items()},
                         {("matte", False): 2, ("light", True): 1})
        self.assertEqual((scene.sky, scene.field_of_view(4, 3)), ((0, 0, 0), 33))

    def test_cuts_quads_along_the_shorter_diagonal(self):
        skewed = OBJECT.replace("v 2 1 0", "v 3 1 0").replace("v 0 1 0", "v 1 1 0")
        corners = [[point for point, _ in triangle] for triangle in self.read(skewed).triangles["matte", False]]
        shared = set(corners[0]) & set(corners[1])
        self.assertEqual(shared, {(2, 0, 0), (1, 1, 0)})

    def test_takes_the_lens_and_the_sky(self):
        scene = self.read(options="--eye 1,2,3\n--at 0,0,0\n--focal-length 35\n--film-width 36\n--env 1,2,3\n--env-scale 0.5\n")
        self.assertAlmostEqual(scene.field_of_view(360, 240), 37.8, delta=0.1)  # 24 mm high, 35 mm away
        self.assertEqual(scene.sky, (0.5, 1, 1.5))

    def test_refuses_all_else_and_says_where(self):
        for part, found, instead, where, expected in (
                ("mtl", "Kd 0.7 0.6 0.5", "Kd 1 1 1\nPr 0.2", "mtl:3", "expected one of .*found Pr"),
                ("mtl", "Kd 0.7 0.6 0.5", "Kd 1 1 1\nmap_Kd a.png", "mtl:3", "found map_Kd"),
                ("mtl", "Kd 0.7 0.6 0.5", "Kd 1 1 1\nKs .1 .1 .1", "mtl:1", "expected a matte material"),
                ("mtl", "Kd 0.7 0.6 0.5", "Kd 1 1", "mtl:2", "expected 3 numbers, found '1 1'"),
                ("mtl", "Kd 0.7 0.6 0.5", "Kd 1 1 1\nd 0.5", "mtl:1", "expected an opaque material, found d 0.5"),
                ("mtl", "Ke 3 2 1", "", "scene.obj", "expected a light"),
                ("options", "--spp 64", "--sun 0,1,0,1,1,1,0.53", "clrt", "--sun: expected 6 numbers, found '0 1 0 1 1 1 0.53'"),
                ("options", "--spp 64", "--sun 0,1,0,1,1,1\n--sun 0,1,0,1,1,1", "clrt:5", "expected one --sun, found another"),
                ("options", "--spp 64", "--point 0,1,0,1,1,1", "clrt:4", "found --point"),
                ("options", "--fov 33", "--filter gaussian", "clrt:3", "found --filter"),
                ("options", "--eye 1,2,3", "", "clrt", "expected --eye, found none"),
                ("options", "--spp 64", "--env sky.hdr", "clrt", "expected 3 numbers, found 'sky.hdr'"),
                ("obj", "usemtl matte", "usemtl none", "obj:7", "expected a material of the library, found none"),
                ("obj", "usemtl matte", "s 1\nusemtl matte", "obj:7", "expected no smoothing group"),
                ("obj", "v 0 0 0", "v 0 0 0 1 0 0", "obj:2", "expected 3 numbers"),
                ("obj", "f 1 2 3 4", "f 1 2 3 9", "obj:8", "expected the number of a vertex above, found 9"),
                ("obj", "f 1 2 3 4", "f 1 3 2 4", "obj:8", "expected a convex polygon"),
                ("obj", "f 1 2 3 4", "l 1 2", "obj:8", "expected vertices and faces, found l")):
            parts = {"obj": OBJECT, "mtl": LIBRARY, "options": OPTIONS}
            self.assertIn(found, parts[part])
            parts[part] = parts[part].replace(found, instead)
            with self.subTest(instead=instead), self.assertRaisesRegex(NotPlain, f"{where}.*: .*{expected}"):
                self.read(**parts)

    def test_takes_the_shipped_scenes_that_are_plain(self):
        taken = []
        for name in sorted(os.listdir(os.path.join(ROOT, "scenes"))):
            try:
                read_plain_scene(os.path.join(ROOT, "scenes", name, name + ".obj"))
                taken.append(name)
            except NotPlain:
                pass
        self.assertTrue({"caustic", "colour_bleeding", "cornell_box", "door_ajar", "furnace", "hall_of_lamps", "mirror_glass_depth10",
                         "spheres_over_plane"} <= set(taken), taken)
        self.assertFalse({"every_effect", "glossy_plates", "plates_far_lamp", "still_life", "textured_interior"} & set(taken), taken)


class ForMitsuba(Scenes):
    def words(self, **parts):
        return mitsuba_scene.scene_dictionary(self.read(**parts), 32, 24, "independent", self.folder, lambda *view: view)

    def test_camera_path_and_film_are_those_of_clrt(self):
        words = self.words(options=OPTIONS + "--max-depth 7\n--up z\n")
        self.assertEqual(words["integrator"], {"type": "path", "max_depth": 7, "rr_depth": 5})
        sensor = words["sensor"]
        self.assertEqual((sensor["fov_axis"], sensor["fov"], sensor["to_world"]), ("y", 33, ([1, 2, 3], [0, 0, 0], [0, 0, 1])))
        self.assertEqual((sensor["film"]["width"], sensor["film"]["height"], sensor["film"]["rfilter"]["type"]), (32, 24, "box"))
        self.assertNotIn("sky", words)
        self.assertEqual(self.words(options=OPTIONS + "--env 1,2,3\n")["sky"]["radiance"]["value"], [1, 2, 3])
        self.assertNotIn("sun", words)
        sun = self.words(options=OPTIONS + "--sun 1,2,-3,4,5,6\n")["sun"]
        self.assertEqual((sun["direction"], sun["irradiance"]["value"]), ([-1, -2, 3], [4, 5, 6]))
        self.assertEqual(self.words()["integrator"]["max_depth"], mitsuba_scene.ENDLESS)

    def test_lights_shine_and_flat_faces_stay_flat(self):
        words = self.words()
        matte, light = words["mesh_0"], words["mesh_1"]
        self.assertEqual((matte["face_normals"], light["face_normals"]), (True, False))
        self.assertEqual(matte["bsdf"]["side"]["reflectance"]["value"], [0.7, 0.6, 0.5])
        self.assertNotIn("emitter", matte)
        self.assertEqual(light["emitter"]["radiance"]["value"], [3, 2, 1])
        with open(light["filename"], encoding="utf-8") as file:
            self.assertEqual(file.read().split("\n")[:2], ["v 0.0 0.0 0.0", "vn 0.0 0.0 1.0"])
        with open(matte["filename"], encoding="utf-8") as file:
            self.assertEqual(len(plain_scene._lines(matte["filename"])), 6 + 2)
            self.assertNotIn("vn", file.read())


if __name__ == "__main__":
    unittest.main()
