# SPDX-License-Identifier: Apache-2.0
"""Whether methods that simulate the same paths agree, and whether their error bars hold: independent pictures of every method,
each with a seed of its own, and what follows from them.

Two methods agree by the tests of clrt-compare (verdict.py), the pictures of the seeds being replicates. An error bar is judged by
its own method's other pictures, so that what all of a method's pictures lack shows in the tests above and not here: x minus the
mean of m others is scattered as x around the truth, times sqrt((m + 1) / m)."""
import dataclasses
import itertools
import math
import os
import shlex

import numpy
from scipy.special import betaincinv

from clrt_tools import picture_file, verdict
from clrt_tools.study_runs import Point

# What error bars promise, and the shares that are taken as that, of all and of a scene.
NOMINAL, LEAST, MOST, LEAST_OF_A_SCENE = 0.95, 0.93, 0.97, 0.85
# Fewer pictures hardly tell how they scatter.
FEWEST_SEEDS = 3
# Groups of methods that simulate the same paths: all of them, and those that the others do (src/options/integrators.h).
GROUPS = (("path", "path+light", "bdpt", "mlt"),
          ("light", "path --paths L((D|S)*D)?E"),
          ("distribution --min-contribution 0", "path --paths LD?(G|S)*E"),
          ("whitted --min-contribution 0", "path --paths LD?S*E"),
          ("raycast", "path --paths LD?E"))
# Of a scene that asks for some paths by itself, by --paths in its own options: what takes them.
GROUPS_OF_PATHS = (("path", "distribution --min-contribution 0"),)
# Effects of a scene under which an integrator's paths are others than those of `path`, or its light is: light paths meet no light
# below facets that corner normals round, and the two classics give highlights where `path` follows rays.
APART = {"light": ("smooth normals",),
         "whitted": ("glossy", "rough refraction", "coat", "sheen"),
         "raycast": ("glossy", "rough refraction", "coat", "sheen")}


def default_groups(scene):
    """The groups for a scene that is rendered with its own options, which stand beside it (src/app/options_file.cpp)."""
    options = os.path.splitext(scene)[0] + ".clrt"
    if not os.path.isfile(options):
        return GROUPS
    with open(options, encoding="utf-8") as file:
        return GROUPS_OF_PATHS if any(line.split()[:1] == ["--paths"] for line in file) else GROUPS


@dataclasses.dataclass(frozen=True)
class Participant:
    """A method by the words of clrt's command line: an integrator's name, and options."""
    text: str

    def words(self):
        """The part of clrt's command line that says so."""
        return ["-i", *shlex.split(self.text)]

    def apart(self, effects):
        """The first of a scene's effects under which it cannot be compared; None: there is none."""
        return next((name for name in APART.get(shlex.split(self.text)[0], ()) if name in effects), None)

    def __str__(self):
        return self.text


@dataclasses.dataclass
class Sample:
    """The pictures of a method, and what clrt says of the error of each over all pixels: (rel. RMSE, low, high), or None."""
    pictures: list
    errors: list
    effects: tuple = ()  # of the scene, by name

    def joined(self):
        """Their mean; they are its replicates."""
        values = numpy.array([picture.mean for picture in self.pictures])
        first = self.pictures[0]
        return picture_file.Picture(first.path, first.window, values.mean(axis=0), values.var(axis=0, ddof=1) / len(values),
                                    len(values) - 1, values)


@dataclasses.dataclass(frozen=True)
class Calibration:
    """How many of `count` error bars held the error, and the errors that they tell over those that there are."""
    held: int
    count: int
    told_over_true: float = float("nan")

    @property
    def share(self):
        return self.held / self.count

    def interval(self, level=NOMINAL):
        """Of the share (Clopper and Pearson 1934)."""
        tail, missed = (1 - level) / 2, self.count - self.held
        low = betaincinv(self.held, missed + 1, tail) if self.held else 0.0
        high = betaincinv(self.held + 1, missed, 1 - tail) if missed else 1.0
        return float(low), float(high)


def render(runner, participant, seeds, spp, name):
    """The pictures of a method, one a seed."""
    runs = [runner.run(f"{name}-{seed}", Point(participant, spp, seed)) for seed in seeds]
    errors = [(run.stats.get("error") or {}).get("whole_picture") for run in runs]
    return Sample([picture_file.read_picture(run.picture) for run in runs],
                  [error and (error["rel_rmse"], error["low"], error["high"]) for error in errors],
                  tuple(effect["name"] for effect in runs[0].stats.get("effects") or () if effect["present"]))


def compare_pairs(samples, tile, alpha, margin):
    """[(first, second, Verdict)] of every pair. `samples`: {participant: Sample}."""
    joined = {participant: sample.joined() for participant, sample in samples.items()}
    return [(a, b, verdict.judge(joined[a], joined[b], tile, alpha, margin)) for a, b in itertools.combinations(samples, 2)]


def true_error(values, index):
    """Squared error of a picture, over its mean: by the mean of the others, without its noise. The product of the differences from
    the means of two halves of them has the same mean, and scatters more than the error that an error bar is for."""
    others = [value for i, value in enumerate(values) if i != index]
    squared = float(((values[index] - numpy.mean(others, axis=0)) ** 2).mean()) * len(others) / (len(others) + 1)
    return squared / float(values[index].mean()) ** 2


def calibrate(sample):
    """Of a method's error bars; None where it has none."""
    told = [(i, error) for i, error in enumerate(sample.errors)
            if error and error[1] is not None and sample.pictures[i].mean.mean() > 0]
    if not told:
        return None
    values = [picture.mean for picture in sample.pictures]
    true = {i: true_error(values, i) for i, _ in told}
    held = sum(low <= math.sqrt(true[i]) <= high for i, (_, low, high) in told)
    all_true = sum(true.values())
    ratio = math.sqrt(sum(error[0] ** 2 for _, error in told) / all_true) if all_true > 0 else float("nan")
    return Calibration(held, len(told), ratio)


def pool(calibrations):
    """All of them as one."""
    return Calibration(sum(each.held for each in calibrations), sum(each.count for each in calibrations))


def is_calibrated(calibration, scenes):
    """Whether the pooled share can be one that is taken as the nominal one, and none of a scene is surely below the least."""
    low, high = calibration.interval()
    return low <= MOST and high >= LEAST and all(each.interval()[1] >= LEAST_OF_A_SCENE for each in scenes)
