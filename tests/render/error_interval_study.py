#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Whether the printed interval holds the error that the picture has, over the project's own scenes.

    error_interval_study.py CLRT [--seeds N] [--spp N,...] [--denoise filter|oidn] [SCENE.obj ...]

Renders each scene with many seeds at 16 and 64 spp, 64 x 48 pixels, and compares with two references of 6400 spp each:
mean((x - a) (x - b)) is the squared error of x without the references' own noise. With --denoise the picture is the
denoised one, and its error is judged over the pixels that show the scene. Prints a line a scene: how many intervals held
the error, how often the upper end was too low, what was stated over what is true (roots of mean squares), how long the
interval's upper part is, and how often bright samples decided that single replicates saw. Exit code 1 where the intervals
of 95 % hold less than 93 % or more than 97 % of all errors, or less than 85 % of those of a scene. Takes half an hour on
two cores, so that the suite skips it (exit code 77) unless the variable CLRT_TEST_LONG is set.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from clrt_tools.film_file import read_film  # noqa: E402

SCENES = ("caustic", "colour_bleeding", "cornell_box", "every_effect", "glossy_plates", "mirror_glass_depth10",
          "spheres_over_plane", "still_life", "textured_interior")
DENOISED = ("caustic", "cornell_box", "door_ajar", "hall_of_lamps", "soft_shadows", "spheres_over_plane", "still_life",
            "textured_interior")
FOLDER = pathlib.Path(__file__).resolve().parents[2] / "scenes"
SKIPPED = 77
SEEDS, SPP = 25, (16, 64)
REFERENCE_SPP, REFERENCE_SEEDS = 6400, (1000, 1001)
LEAST, MOST, LEAST_OF_A_SCENE = 0.93, 0.97, 0.85


class Rendered:
    """The picture of a run, what it says of its error, and over which pixels."""

    def __init__(self, clrt, scene, seed, spp, folder, denoiser=None):
        film, stats, exr = (os.path.join(folder, name) for name in ("a.film", "s.json", "a.exr"))
        if os.path.exists(film):
            os.remove(film)
        output = [f"--denoise={denoiser}", "--aov", "alpha", "-o", exr] if denoiser else ["-o", os.path.join(folder, "a.pfm")]
        subprocess.run([clrt, str(scene), "--size", "64x48", "--seed", str(seed), "--spp", str(spp), "--checkpoint", film,
                        "--stats", stats, "-q", *output], check=True, timeout=3600, stdout=subprocess.DEVNULL)
        with open(stats, encoding="utf-8") as file:
            statistics = json.load(file)
        means = read_film(film).means.mean(axis=0)
        self.is_trusted = statistics["error"]["verdict"] != "untrusted"
        if denoiser:
            layers = read_layers(exr)
            shown = layers["A"] > 0
            self.picture, self.error = layers["denoised"], statistics["denoised"]["error"]
        else:
            shown = np.ones(means.shape[:2], bool)
            self.picture, self.error = means, statistics["error"]["whole_picture"]
        self.shown, self.mean = shown, float(means[shown].mean())

    def squared_error(self, references):
        """The mean squared error, by two independent references."""
        return float(((self.picture - references[0]) * (self.picture - references[1]))[self.shown].mean())


def read_layers(path):
    """The layers "denoised" (rows x columns x 3) and "A" of an EXR file."""
    import OpenImageIO
    image = OpenImageIO.ImageInput.open(path)
    names, values = image.spec().channelnames, image.read_image(format=OpenImageIO.FLOAT).astype(float)
    image.close()
    values = values.reshape(image.spec().height, image.spec().width, -1)
    channels = [names.index("denoised." + c) for c in "RGB"]
    return {"denoised": values[:, :, channels], "A": values[:, :, names.index("A")]}


def study(clrt, scene, arguments, folder):
    """Prints a line for each number of samples; which of the intervals hold the error."""
    references = [Rendered(clrt, scene, seed, REFERENCE_SPP, folder).picture for seed in REFERENCE_SEEDS]
    held = []
    for spp in arguments.spp:
        estimated = realised = lengths = untrusted = low = 0
        before = len(held)
        for seed in range(arguments.seeds):
            rendered = Rendered(clrt, scene, seed, spp, folder, arguments.denoise)
            squared, error = rendered.squared_error(references), rendered.error
            own = math.sqrt(max(squared, 0)) / rendered.mean
            if rendered.is_trusted or not arguments.denoise:  # else clrt says no interval of a denoised error
                held.append(error["low"] <= own <= error["high"])
                low += own > error["high"]
            estimated += (error["rel_rmse"] * rendered.mean) ** 2
            realised += squared
            lengths += error["high"] / own if own > 0 else 0
            untrusted += not rendered.is_trusted
        print(f"{scene.stem:22} {spp:3} spp: held {sum(held[before:]):3} of {len(held) - before}, above {low}, stated over "
              f"true {math.sqrt(estimated / realised):.3f}, upper end over true {lengths / arguments.seeds:.2f}, "
              f"untrusted {untrusted}", flush=True)
    return held


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clrt")
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--spp", type=lambda text: [int(word) for word in text.split(",")], default=SPP)
    parser.add_argument("--denoise", choices=("filter", "oidn"))
    arguments = parser.parse_intermixed_args()
    if not arguments.scenes and "CLRT_TEST_LONG" not in os.environ:
        print("skipped: CLRT_TEST_LONG is not set")
        return SKIPPED
    scenes = arguments.scenes or [FOLDER / name / f"{name}.obj" for name in (DENOISED if arguments.denoise else SCENES)]
    with tempfile.TemporaryDirectory() as folder:
        held = [study(arguments.clrt, scene, arguments, folder) for scene in scenes]
    shares = [sum(each) / len(each) for each in held if each]
    pooled = sum(shares) / len(shares)
    print(f"all: {100 * pooled:.1f} %, the scene with the fewest {100 * min(shares):.1f} %")
    return 0 if LEAST <= pooled <= MOST and min(shares) >= LEAST_OF_A_SCENE else 1


if __name__ == "__main__":
    sys.exit(main())
