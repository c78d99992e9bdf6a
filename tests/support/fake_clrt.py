#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stands in for clrt where a test must know its speed: takes the options that clrt-study gives, takes as long as a machine of
FAKE_CLRT_SAMPLES samples a second and FAKE_CLRT_START seconds a process would, and writes a grey picture with noise of known size.
Double precision takes twice the seconds. A test that imports it may have the seconds pass by a clock of its own."""
import json
import os
import sys
import time

import numpy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from noisy_pictures import write_exr  # noqa: E402

OWN_SIZE = "160x120"
# Standard deviation of a pixel for one sample, over the picture's mean, and the power of the samples by which it falls.
NOISE, SLOPE = 1.0, {"sobol": -0.75, "independent": -0.5}

HELP = """Work:
  -i, --integrator NAME  path (all light) or whitted (mirrors) (default path)
      --precision NAME   single, double (slow) or fast (default single)
      --sampler NAME     sobol or independent (default sobol)
"""


def render(words, samples_a_second, start, pass_time):
    """Writes the picture and the statistics that the command line asks for. `start`: seconds of the process before its first
    sample; `pass_time(seconds)` lets them pass."""
    def option(name, default=None):
        return words[words.index(name) + 1] if name in words else default

    width, height = map(int, option("-r", OWN_SIZE).split("x"))
    crop = option("--crop")
    x0, y0, x1, y1 = map(int, crop.split(",")) if crop else (0, 0, width, height)
    spp, sampler = int(option("-s")), option("--sampler", "sobol")
    slow = 2 if option("--precision") == "double" else 1
    second = slow * (x1 - x0) * (y1 - y0) / samples_a_second  # of a sample a pixel
    spp = min(spp, max(1, int(float(option("-t", "1e6")) / second)))
    pass_time(slow * start + spp * second)
    deviation = NOISE * spp ** SLOPE[sampler]
    random = numpy.random.default_rng([int(option("--seed")), spp, sampler == "sobol"])
    mean = 0.5 * (1 + random.normal(0, deviation, (y1 - y0, x1 - x0, 3)))
    write_exr(option("-o"), mean, numpy.full(mean.shape, (0.5 * deviation) ** 2), spp, (), (x0, y0), (width, height))
    stats = {"width": x1 - x0, "height": y1 - y0, "spp": spp, "version": "0.0.0", "triangles": 2,
             "device": {"platform": "fake", "name": "fake", "driver": "1"}, "error": {"rel_rmse": deviation},
             "nonfinite": {"nan": 0, "infinite": 0, "negative": 0, "overflow": 0},
             "seconds": {"load": 0.0, "bvh": 0.0, "compile": 0.0, "first_launch": 0.0, "render": spp * second,
                         "total": slow * start + spp * second}}
    if option("--stats"):
        with open(option("--stats"), "w", encoding="utf-8") as file:
            json.dump(stats, file)


def main():
    if "--help" in sys.argv:
        print(HELP)
        return
    render(sys.argv, float(os.environ["FAKE_CLRT_SAMPLES"]), float(os.environ.get("FAKE_CLRT_START", "0")), time.sleep)


if __name__ == "__main__":
    main()
