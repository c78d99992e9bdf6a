# SPDX-License-Identifier: Apache-2.0
"""Keeps a study within its seconds of wall time: plans from measured speed before the runs, and watches the clock between them."""
import dataclasses
import math
import time
from typing import Optional

# What a quick study may do, dearest first: pixels, samples a pixel, repeats.
QUICK_STEPS = ((320 * 240, (4, 16, 64, 256), 3), (320 * 240, (4, 16, 64), 3), (240 * 180, (4, 16, 64), 3),
               (240 * 180, (4, 16, 64), 2), (160 * 120, (4, 16, 64), 2), (128 * 96, (4, 16, 64), 2), (128 * 96, (4, 16), 2),
               (112 * 84, (4, 16), 1), (56 * 42, (4, 16), 1))
# Part of the time left that a plan may take; the rest is for a machine that gets busier, and for dearer methods.
PLANNED_SHARE = 0.65
# Part of the time left that runs at the scene's own size may take.
OWN_SIZE_SHARE = 0.15
# Samples of each half of a quick study's reference, over the most of a run: its own noise is taken out, so it need not be small.
REFERENCE_FACTOR = 4
# A run starts if it fits even when it takes so many times what is expected.
CAUTION = 1.3


@dataclasses.dataclass
class Speed:
    """What was measured of this machine, now, with this scene and the default method."""
    samples: float   # a second: pixels times samples a pixel, in the render stage
    overhead: float  # seconds of a process around its render stage, kernels compiled
    compiling: float  # seconds of compiling and of the first launch


@dataclasses.dataclass
class Plan:
    """What a study does. `size`: (width, height) or None for the scene's own."""
    methods: list
    counts: tuple
    repeats: int
    size: Optional[tuple] = None
    reference_spp: int = 0         # of each half
    own_spp: Optional[int] = None  # of one run at the scene's own size
    notes: tuple = ()              # what was dropped

    def seconds(self, speed):
        """What it takes, about."""
        pixels = self.size[0] * self.size[1]
        runs = len(self.methods) * self.repeats
        samples = pixels * (runs * sum(self.counts) + 2 * self.reference_spp)
        launches = runs * len(self.counts) + (2 if self.reference_spp else 0)
        return samples / speed.samples + launches * speed.overhead + (len(self.methods) - 1) * speed.compiling


def shrunk(size, pixels):
    """A size of the same aspect with about so many pixels, never larger."""
    scale = min(1.0, math.sqrt(pixels / (size[0] * size[1])))
    return tuple(max(1, round(length * scale)) for length in size)


def choose_plan(speed, seconds, own_size, methods, given):
    """The dearest plan that fits into `seconds`; methods are dropped from the end when not even the cheapest does. `given`:
    a dictionary of what the user has chosen (counts, repeats, size, reference_spp), which stays."""
    for kept in range(len(methods), 0, -1):
        for pixels, counts, repeats in QUICK_STEPS:
            counts = given.get("counts") or counts
            plan = Plan(list(methods[:kept]), counts, given.get("repeats") or repeats,
                        given.get("size") or shrunk(own_size, pixels))
            plan.reference_spp = given.get("reference_spp", REFERENCE_FACTOR * max(counts))
            if plan.seconds(speed) <= PLANNED_SHARE * seconds:
                break
        else:
            continue
        break
    dropped = methods[len(plan.methods):]
    if dropped:
        plan.notes = (f"dropped, because there is no time for them: {'; '.join(str(method) for method in dropped)}",)
    plan.own_spp = _own_size_samples(plan, speed, seconds, own_size)
    return plan


def _own_size_samples(plan, speed, seconds, own_size):
    """Most samples of the sweep for which a run at the scene's own size fits; None where none does or none is needed."""
    if plan.size == tuple(own_size):
        return None
    pixels = own_size[0] * own_size[1]
    fitting = [spp for spp in plan.counts if speed.overhead + pixels * spp / speed.samples <= OWN_SIZE_SHARE * seconds]
    return max(fitting, default=None)


class Budget:
    """Tells whether a run still fits, from the runs of its method so far, and when it must end."""

    def __init__(self, seconds, clock=time.monotonic):
        self.clock, self.start, self.seconds = clock, clock(), seconds
        self.known = {}  # method: (spp, seconds of rendering, all other seconds) of its longest run
        self.compiling = 0.0  # the longest so far
        self.pace = 1.0  # seconds of the last run over what was expected, at least 1

    def elapsed(self):
        return self.clock() - self.start

    def left(self):
        """Seconds; None without a limit."""
        return None if self.seconds is None else max(0.0, self.seconds - self.elapsed())

    def note(self, point, seconds, render_seconds, compile_seconds=0.0):
        """Notes a run; only a cold run's compiling is not to be expected again."""
        expected = self.estimate(point)
        self.pace = max(1.0, seconds / expected) if expected > 0 else 1.0
        if point.cold:
            seconds -= compile_seconds
            self.compiling = max(self.compiling, compile_seconds)
        if point.spp >= self.known.get(point.method, (0,))[0]:
            self.known[point.method] = (point.spp, render_seconds, seconds - render_seconds)

    def estimate(self, point, larger=1.0):
        """Seconds that a run will take: as its method took, else as the slowest method took and compiling; 0 where nothing is
        known. `larger`: times the pixels of the runs so far."""
        own = self.known.get(point.method)
        times = [others + rendering * larger * point.spp / spp for spp, rendering, others in ([own] if own else self.known.values())]
        return max(times, default=0.0) + (0.0 if own else self.compiling)

    def fits(self, point, larger=1.0):
        """Whether it ends in time even on a machine that has become slower."""
        return self.seconds is None or self.elapsed() + CAUTION * self.pace * self.estimate(point, larger) <= self.seconds
