#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the add-on headless, by Python 3.11 with the packages bpy and numpy; without bpy they are skipped. clrt is that
of the variable CLRT or of the search path."""
import os
import sys
import tempfile
import time
import unittest

here = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [here, os.path.dirname(here)]
SKIPPED = 77  # ctest's SKIP_RETURN_CODE

try:
    import bpy
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}; run by Python 3.11 after 'pip install bpy==5.0.1'")
    sys.exit(SKIPPED)

import clrt_render  # noqa: E402 (needs the path above)
from clrt_render import engine, process, settings  # noqa: E402
import rendering  # noqa: E402
import scenes  # noqa: E402


class AddOn(unittest.TestCase):
    """Each test starts with the still life."""

    @classmethod
    def setUpClass(cls):
        clrt_render.register()
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        clrt_render.unregister()
        cls.folder.cleanup()

    def setUp(self):
        self.scene = scenes.still_life(48, 36)

    def render(self, samples=4):
        path = os.path.join(self.folder.name, "picture.exr")
        return rendering.render(self.scene, "CLRT", path, samples), path

    def test_all_passes_arrive(self):
        passes, _path = self.render()
        for name in ("Combined.A", "Depth.Z", "Normal.X", "Position.Z", "Denoising Albedo.B", "Denoising Normal.Z",
                     "CryptoObject02.A",
                     "CryptoMaterial00.R"):
            self.assertIn(name, list(passes))
        self.assertTrue((passes["Combined.A"] == 1).all())
        self.assertGreater(passes["Combined.G"].mean(), 0.05)

    def test_vectors_are_in_blenders_axes(self):
        passes, path = self.render(16)
        floor = rendering.coverage(passes, "CryptoObject", rendering.matte_names(path, "CryptoObject"))["floor"] == 1
        self.assertGreater(floor.sum(), 300)
        np.testing.assert_allclose(passes["Normal.Z"][floor], 1, atol=1e-5)
        np.testing.assert_allclose(passes["Position.Z"][floor], 0, atol=1e-4)
        eye = self.scene.camera.matrix_world.translation
        forward = -self.scene.camera.matrix_world.to_3x3().col[2]
        way = sum((passes["Position." + axis][floor] - eye[i]) * forward[i] for i, axis in enumerate("XYZ"))
        np.testing.assert_allclose(passes["Depth.Z"][floor], way, rtol=1e-4)

    def test_mattes_name_blenders_objects(self):
        passes, path = self.render()
        names = rendering.matte_names(path, "CryptoObject")
        self.assertLessEqual({"floor", "red box", "twin box", "metal ball"}, set(names.values()))
        shares = rendering.coverage(passes, "CryptoObject", names)
        self.assertGreater(shares["twin box"].sum(), 20)

    def test_a_film_without_sky_is_transparent(self):
        self.scene.render.film_transparent = True
        passes, _path = self.render()
        self.assertEqual(passes["Combined.A"].min(), 0)
        self.assertEqual(passes["Combined.A"].max(), 1)

    def test_moved_instances_are_rendered_where_they_are(self):
        # An orthographic view from above: the middle of a box is where it stands.
        scenes.set_camera(self.scene, (0, 0, 9), (0, 0, 0), type="ORTHO", ortho_scale=8)
        passes, path = self.render(32)
        share = rendering.coverage(passes, "CryptoObject", rendering.matte_names(path, "CryptoObject"))["twin box"]
        rows, columns = np.indices(share.shape)
        x = (share * columns).sum() / share.sum() + 0.5
        self.assertAlmostEqual((x - 24) * 8 / 48, 2.6, delta=0.05)

    def test_a_border_has_the_pixels_of_the_whole(self):
        whole, _path = self.render()
        render = self.scene.render
        render.use_border = render.use_crop_to_border = True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.7, 0.2, 0.55
        part, _path = self.render()
        left, right, top, bottom = 12, 33, 36 - 19, 36 - 7
        for name in ("Combined.R", "Normal.Z", "CryptoObject00.R"):
            self.assertEqual(part[name].shape, (bottom - top, right - left))
            np.testing.assert_array_equal(part[name], whole[name][top:bottom, left:right])

    def test_a_missing_program_is_said(self):
        before = os.environ.get("CLRT")
        os.environ["CLRT"] = "/nowhere/clrt"
        try:
            with self.assertRaisesRegex(FileNotFoundError, "/nowhere/clrt"):
                settings.program()
            with self.assertRaisesRegex(RuntimeError, "/nowhere/clrt"):
                self.render()
        finally:
            os.environ.pop("CLRT")
            if before:
                os.environ["CLRT"] = before

    def test_what_clrt_refuses_is_said(self):
        self.scene.clrt.further = "--no-such-option"
        with self.assertRaisesRegex(RuntimeError, "no-such-option"):
            self.render()

    def test_cancel_keeps_the_picture_so_far(self):
        begun, original = time.monotonic(), engine.ClrtEngine.is_cancelled
        engine.ClrtEngine.is_cancelled = lambda self: time.monotonic() > begun + 3
        try:
            passes, _path = self.render(1 << 18)
        finally:
            engine.ClrtEngine.is_cancelled = original
        self.assertGreater(passes["Combined.G"].mean(), 0.05)
        self.assertLess(time.monotonic() - begun, 60)

    def test_progress_is_understood(self):
        self.assertEqual(process.fraction_of("render   42%  64 spp  3.1 s  ETA 2.0 s"), 0.42)
        self.assertIsNone(process.fraction_of("compile 1.0 s"))


if __name__ == "__main__":
    unittest.main()
