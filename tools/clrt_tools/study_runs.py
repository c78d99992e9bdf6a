# SPDX-License-Identifier: Apache-2.0
"""Runs clrt once for every point of a sweep, and measures what it cost."""
import dataclasses
import json
import os
import shlex
import subprocess
import time
from typing import Optional

# Seeds of the reference's halves: far from those of the repeats, which count from 1.
REFERENCE_SEEDS = (1000001, 1000002)


class RunError(Exception):
    """clrt ended without a picture; the message is its own."""


@dataclasses.dataclass(frozen=True)
class Method:
    """What is compared."""
    integrator: str
    precision: str
    sampler: str

    def __str__(self):
        return f"{self.integrator}, {self.precision}, {self.sampler}"


@dataclasses.dataclass(frozen=True)
class Point:
    """One run of a sweep."""
    method: Method
    spp: int
    seed: int
    cold: bool = False  # compiles its kernels anew


@dataclasses.dataclass
class Run:
    """A run that was made."""
    point: Point
    command: str
    picture: str                # path of the EXR
    stats: dict                 # clrt --stats
    cpu_seconds: float          # user and system time of the process
    mse: Optional[float] = None
    rel_rmse: Optional[float] = None
    relmse: Optional[float] = None

    @property
    def render_seconds(self):
        return self.stats["seconds"]["render"]


@dataclasses.dataclass
class Runner:
    """How clrt is called."""
    program: str
    scene: str
    folder: str                 # of the pictures
    size: Optional[str] = None
    device: Optional[str] = None
    extra: tuple = ()

    def command(self, name, spp, seed, method, cold=False):
        words = [self.program, self.scene, "-q", "-s", str(spp), "--seed", str(seed), "-i", method.integrator,
                 "--precision", method.precision, "--sampler", method.sampler, "--aov", "variance,samples"]
        words += ["-r", self.size] if self.size else []
        words += ["-d", self.device] if self.device else []
        words += ["--no-cache"] if cold else []
        path = os.path.join(self.folder, name)
        return words + list(self.extra) + ["-o", path + ".exr", "--stats", path + ".json"], path

    def run(self, name, point, more=()):
        """Renders, with `more` options; raises RunError with clrt's own words."""
        words, path = self.command(name, point.spp, point.seed, point.method, point.cold)
        words += more
        with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, errors="replace") as process:
            try:
                said = process.stderr.read()
                _, status, usage = os.wait4(process.pid, 0)
            except BaseException:
                process.terminate()
                raise
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            lines = said.strip().splitlines()
            raise RunError(lines[-1] if lines else f"{self.program} ended with exit code {process.returncode}")
        with open(path + ".json", encoding="utf-8") as file:
            stats = json.load(file)
        return Run(point, shlex.join(words), path + ".exr", stats, usage.ru_utime + usage.ru_stime)


def sweep(methods, samples, repeats):
    """All points; repeats outermost, so that a machine's slow minutes are shared by all methods. The first run of each method
    is cold: it shows what compiling costs."""
    return [Point(method, spp, repeat, cold=repeat == 1 and spp == min(samples))
            for repeat in range(1, repeats + 1) for spp in sorted(samples) for method in methods]


class Budget:
    """Tells whether a run still fits, from the runs of its method so far."""

    def __init__(self, seconds, clock=time.monotonic):
        self.clock, self.start, self.seconds = clock, clock(), seconds
        self.known = {}  # method: (spp, seconds of rendering, all other seconds) of its longest run

    def elapsed(self):
        return self.clock() - self.start

    def note(self, point, seconds, render_seconds, compile_seconds=0.0):
        """Notes a run; only a cold run's compiling is not to be expected again."""
        if point.cold:
            seconds -= compile_seconds
        if point.spp >= self.known.get(point.method, (0,))[0]:
            self.known[point.method] = (point.spp, render_seconds, seconds - render_seconds)

    def estimate(self, point):
        """Seconds that a run will take; 0 where nothing is known."""
        spp, rendering, others = self.known.get(point.method, (point.spp, 0.0, 0.0))
        return others + rendering * point.spp / spp

    def fits(self, point):
        return self.seconds is None or self.elapsed() + self.estimate(point) <= self.seconds
