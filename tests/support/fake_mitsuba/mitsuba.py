# SPDX-License-Identifier: Apache-2.0
"""Stands in for the package mitsuba where a test must know what it renders: grey pictures of FAKE_MITSUBA_BRIGHTNESS, with noise
of known size. Takes what clrt-mitsuba gives."""
import os
import sys

import drjit
import numpy
import OpenImageIO

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), ".."))
from noisy_pictures import write_exr  # noqa: E402

__version__ = "3.0.0"
# Standard deviation of a pixel for one sample; it falls with the root of the samples.
NOISE = 0.5


def variants():
    return ["fake_rgb"]


def set_variant(name):
    if name not in variants():
        raise ImportError(f"no variant {name}")


class ScalarTransform4f:
    def look_at(self, *view):
        return view


def load_dict(words):
    for mesh in (part for part in words.values() if isinstance(part, dict) and part["type"] == "obj"):
        assert os.path.isfile(mesh["filename"]), mesh
    return words


def render(scene, spp, seed):
    film = scene["sensor"]["film"]
    noise = numpy.random.default_rng([seed, spp]).normal(0, NOISE * spp ** -0.5, (film["height"], film["width"], 3))
    return float(os.environ.get("FAKE_MITSUBA_BRIGHTNESS", "0.5")) * (1 + noise)


class Bitmap:
    def __init__(self, source):
        self.pixels = source
        if isinstance(source, str):
            image = OpenImageIO.ImageInput.open(source)
            self.pixels = numpy.asarray(image.read_image(OpenImageIO.FLOAT))
            image.close()

    def __array__(self, dtype=None, copy=None):
        return numpy.asarray(self.pixels, dtype)

    def write(self, path):
        if drjit.thread_count() < 2:
            raise RuntimeError("Mitsuba would wait for ever")
        write_exr(path, self.pixels)
