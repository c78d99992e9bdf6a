# SPDX-License-Identifier: Apache-2.0
"""Stands in for the package bpy where a test must know what it renders: grey pictures of FAKE_BPY_BRIGHTNESS, with noise of known
size, of a scene that takes whatever clrt-cycles says. What it said is appended to the file FAKE_BPY_LOG, where that is set."""
import os
import sys
from unittest import mock

import numpy
import OpenImageIO

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), ".."))
from noisy_pictures import write_exr  # noqa: E402

# Standard deviation of a pixel for one sample; it falls with the root of the samples.
NOISE = 0.5
app = mock.Mock(version_string="4.5.0")
context, data, ops = mock.MagicMock(), mock.MagicMock(), mock.MagicMock()


def _render(write_still):
    scene = context.scene
    spp, size = scene.cycles.samples, (scene.render.resolution_y, scene.render.resolution_x, 3)
    noise = numpy.random.default_rng([scene.cycles.seed, spp]).normal(0, NOISE * spp ** -0.5, size)
    print("Fra:1 Sample", spp)  # as Blender does
    assert write_still
    write_exr(scene.render.filepath, float(os.environ.get("FAKE_BPY_BRIGHTNESS", "0.5")) * (1 + noise))
    if "FAKE_BPY_LOG" in os.environ:
        with open(os.environ["FAKE_BPY_LOG"], "a", encoding="utf-8") as file:
            file.write(f"{spp} spp, guiding {scene.cycles.use_guiding}, tree {scene.cycles.use_light_tree}\n")


def _load(path):
    image = OpenImageIO.ImageInput.open(path)
    pixels = numpy.asarray(image.read_image(OpenImageIO.FLOAT))
    image.close()
    return mock.Mock(pixels=pixels.ravel().tolist(), channels=pixels.shape[-1])


ops.render.render = _render
data.images.load = _load
