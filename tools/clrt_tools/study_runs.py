# SPDX-License-Identifier: Apache-2.0
"""Runs clrt once for every point of a sweep, and measures what it cost."""
import dataclasses
import json
import os
import shlex
import subprocess
import threading
from typing import Optional

import numpy

from clrt_tools.study_methods import Method

# Seeds of the reference's halves: far from those of the repeats, which count from 1.
REFERENCE_SEEDS = (1000001, 1000002)
# What renders them.
REFERENCE_METHOD = Method("path", "single", "sobol")
# Folders of compiled kernels: clrt's own and PoCL's (XDG), PoCL's where it is set by hand, NVIDIA's, Intel's for GPUs.
CACHE_VARIABLES = ("XDG_CACHE_HOME", "POCL_CACHE_DIR", "CUDA_CACHE_PATH", "NEO_CACHE_DIR")


# clrt's exit code for a command line that it cannot follow.
USAGE_ERROR = 2


class RunError(Exception):
    """clrt ended without a picture; the message is its own."""


class Refused(RunError):
    """clrt does not take these options together, such as so few samples with --adaptive."""


class OutOfTime(Exception):
    """The run was ended because its time was over."""


@dataclasses.dataclass(frozen=True)
class Point:
    """One run of a sweep."""
    method: Method
    spp: int
    seed: int
    cold: bool = False  # the first of its program: it compiles


@dataclasses.dataclass
class Run:
    """A run that was made."""
    point: Point
    command: str
    picture: str                # path of the EXR
    stats: dict                 # clrt --stats
    cpu_seconds: Optional[float]  # user and system time of the process; None where not known
    brightness: Optional[float] = None      # mean over the reference's
    mse: Optional[float] = None
    rel_rmse: Optional[float] = None
    relmse: Optional[float] = None
    blocks: Optional[numpy.ndarray] = None  # sums of the squared error over blocks of the picture
    relative_blocks: Optional[numpy.ndarray] = None  # likewise of the relative squared error
    noise_blocks: Optional[numpy.ndarray] = None  # of the variance that clrt itself estimates

    @property
    def render_seconds(self):
        """Of the samples and of the pilots that chose how they are taken; those of a cold run compile, and are left out."""
        seconds = self.stats["seconds"]
        return seconds["render"] + (0 if self.point.cold else seconds.get("pilots", 0))

    @property
    def own_error(self):
        """What clrt itself says of its error over all pixels, over which the study compares; None where it does not."""
        error = self.stats.get("error") or {}
        return error.get("whole_picture", error).get("rel_rmse")


@dataclasses.dataclass
class Runner:
    """How clrt is called."""
    program: str
    scene: str
    folder: str                 # of the pictures
    size: Optional[str] = None
    device: Optional[str] = None
    extra: tuple = ()
    caches: Optional[str] = None  # folder of compiled kernels, empty at first: each program compiles once, whatever ran before

    def command(self, name, point, size=None):
        words = [self.program, self.scene, "-q", "-s", str(point.spp), "--seed", str(point.seed), *point.method.words(),
                 "--aov", "variance,samples"]
        size = size or self.size
        words += ["-r", size] if size else []
        words += ["-d", self.device] if self.device else []
        path = os.path.join(self.folder, name)
        return words + list(self.extra) + ["-o", path + ".exr", "--stats", path + ".json"], path

    def run(self, name, point, more=(), seconds=None, size=None):
        """Renders, with `more` options, at most for `seconds`; raises RunError with clrt's own words, or OutOfTime."""
        words, path = self.command(name, point, size)
        words += more
        code, said, cpu_seconds = self._call(words, seconds)
        if code != 0:
            lines = said.strip().splitlines()
            error = Refused if code == USAGE_ERROR else RunError
            raise error(lines[-1] if lines else f"{self.program} ended with exit code {code}")
        with open(path + ".json", encoding="utf-8") as file:
            stats = json.load(file)
        return Run(point, shlex.join(words), path + ".exr", stats, cpu_seconds)

    def _call(self, words, seconds):
        """Exit code, what it said, user and system seconds."""
        settings = {**os.environ, **{name: self.caches for name in CACHE_VARIABLES}} if self.caches else None
        with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, errors="replace", env=settings) as process:
            late = threading.Event()
            timer = threading.Timer(max(seconds, 0), lambda: (late.set(), process.kill())) if seconds is not None else None
            try:
                if timer:
                    timer.start()
                said = process.stderr.read()
                _, status, usage = os.wait4(process.pid, 0)
            except BaseException:
                process.terminate()
                raise
            finally:
                if timer:
                    timer.cancel()
            process.returncode = os.waitstatus_to_exitcode(status)
        if late.is_set() and process.returncode != 0:
            raise OutOfTime(f"ended after {seconds:.0f} s")
        return process.returncode, said, usage.ru_utime + usage.ru_stime


def sweep(methods, samples, repeats):
    """All points; repeats outermost, so that a machine's slow minutes are shared by all methods. The first run of each method
    is cold: it shows what compiling costs."""
    return [Point(method, spp, repeat, cold=repeat == 1 and spp == min(samples))
            for repeat in range(1, repeats + 1) for spp in sorted(samples) for method in methods]
