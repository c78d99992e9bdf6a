#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Stands in for clrt where a test must know its speed: takes the options that clrt-study gives, sleeps as long as a machine of
FAKE_CLRT_SAMPLES samples a second and FAKE_CLRT_START seconds a process would take, and writes a grey picture with noise of
known size. From the FAKE_CLRT_SLOW_AFTER-th call on it is ten times as slow; double precision takes twice the seconds."""
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
SLOWER = 10


def option(name, default=None):
    return sys.argv[sys.argv.index(name) + 1] if name in sys.argv else default


def calls_so_far():
    """Counts the calls in a file beside the pictures."""
    path = os.path.join(os.path.dirname(option("-o")), "calls.txt")
    with open(path, "a+", encoding="utf-8") as file:
        file.write(".")
        return file.tell()


HELP = """Work:
  -i, --integrator NAME  path (all light) or whitted (mirrors) (default path)
      --precision NAME   single, double (slow) or fast (default single)
      --sampler NAME     sobol or independent (default sobol)
"""


def main():
    begin = time.monotonic()
    if "--help" in sys.argv:
        print(HELP)
        return
    width, height = map(int, option("-r", OWN_SIZE).split("x"))
    crop = option("--crop")
    x0, y0, x1, y1 = map(int, crop.split(",")) if crop else (0, 0, width, height)
    spp, sampler, precision = int(option("-s")), option("--sampler", "sobol"), option("--precision")
    slow = SLOWER if calls_so_far() > int(os.environ.get("FAKE_CLRT_SLOW_AFTER", "1000000")) else 1
    slow *= 2 if precision == "double" else 1
    second = slow * (x1 - x0) * (y1 - y0) / float(os.environ["FAKE_CLRT_SAMPLES"])  # of a sample a pixel
    spp = min(spp, max(1, int(float(option("-t", "1e6")) / second)))
    time.sleep(float(os.environ.get("FAKE_CLRT_START", "0")) * slow)
    time.sleep(spp * second)
    deviation = NOISE * spp ** SLOPE[sampler]
    random = numpy.random.default_rng([int(option("--seed")), spp, sampler == "sobol"])
    mean = 0.5 * (1 + random.normal(0, deviation, (y1 - y0, x1 - x0, 3)))
    write_exr(option("-o"), mean, numpy.full(mean.shape, (0.5 * deviation) ** 2), spp, (), (x0, y0), (width, height))
    stats = {"width": x1 - x0, "height": y1 - y0, "spp": spp, "version": "0.0.0", "triangles": 2,
             "device": {"platform": "fake", "name": "fake", "driver": "1"}, "error": {"rel_rmse": deviation},
             "nonfinite": {"nan": 0, "infinite": 0, "negative": 0, "overflow": 0},
             "seconds": {"load": 0.0, "bvh": 0.0, "compile": 0.0, "first_launch": 0.0, "render": spp * second,
                         "total": time.monotonic() - begin}}
    if option("--stats"):
        with open(option("--stats"), "w", encoding="utf-8") as file:
            json.dump(stats, file)


if __name__ == "__main__":
    main()
