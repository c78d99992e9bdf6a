# SPDX-License-Identifier: Apache-2.0
"""Errors of the runs of a study against its reference, summed up method by method, and as CSV."""
import csv
import dataclasses
import io
import math
import statistics
from typing import Optional

import numpy

from clrt_tools.atomic_text import write_text
from clrt_tools.metrics import relative_weight
from clrt_tools.picture_file import read_picture
from clrt_tools.study_methods import SWITCHES, Method
from clrt_tools.verdict import tile_sums

# Parts of a picture, along its longer side, whose errors are taken as independent: enough for a jackknife over them.
BLOCKS = 12


@dataclasses.dataclass
class Reference:
    """The picture that errors are measured against, and how its own noise is taken out."""
    mean: numpy.ndarray
    halves: Optional[tuple] = None          # two independent pictures
    variance: Optional[numpy.ndarray] = None
    text: str = ""                          # where it comes from
    seconds: float = 0

    @property
    def treatment(self):
        if self.halves:
            return "its own noise is taken out: mean (x - a)(x - b) with its halves a and b"
        if self.variance is not None:
            return "its own noise is taken out by its variance layer"
        return "its own noise is not known and is part of every error"


def reference_of_files(paths):
    """One file, or two halves."""
    pictures = [read_picture(path) for path in paths]
    for picture in pictures:
        if picture.encoding:
            raise ValueError(f"expected a reference of linear radiance (EXR, HDR, PFM, float TIFF), found {picture.path} with "
                             f"{picture.encoding}")
    mean = sum(picture.mean for picture in pictures) / len(pictures)
    halves = tuple(picture.mean for picture in pictures) if len(pictures) == 2 else None
    return Reference(mean, halves, None if halves else pictures[0].variance, " + ".join(paths))


def measure(run, reference):
    """Fills in the errors of a run."""
    picture = read_picture(run.picture)
    x = picture.mean
    if x.shape != reference.mean.shape:
        raise ValueError(f"{run.picture}: expected {reference.mean.shape[1]}x{reference.mean.shape[0]} pixels like the reference, "
                         f"found {x.shape[1]}x{x.shape[0]}")
    run.brightness = float(x.mean() / reference.mean.mean()) if reference.mean.any() else 1.0
    weight = relative_weight(reference.mean)
    if reference.halves:
        a, b = reference.halves
        square = (x - a) * (x - b)
    else:
        square = (x - reference.mean) ** 2 - (0 if reference.variance is None else reference.variance)
    run.mse, run.relmse = float(square.mean()), float((square * weight).mean())
    run.blocks, run.relative_blocks = (block_sums(values.mean(axis=-1)) for values in (square, square * weight))
    run.noise_blocks = None if picture.variance is None else block_sums(picture.variance.mean(axis=-1))
    run.rel_rmse = relative_root(run.mse, reference)


def block_sums(values):
    """Sums over BLOCKS x BLOCKS parts of a picture, of (height, width) values; fewer where it has fewer pixels."""
    size = max(1, math.ceil(max(values.shape) / BLOCKS))
    return tile_sums(values[..., None], size).ravel()


def relative_root(mse, reference):
    """sqrt(MSE) over the reference's mean; None where the error is lost in the noise."""
    mean = float(reference.mean.mean())
    return float(numpy.sqrt(mse)) / mean if mse > 0 and mean > 0 else None


@dataclasses.dataclass
class Summary:
    """The repeats of a method at one number of samples."""
    spp: int
    runs: list
    error: Optional[float]      # relative RMSE from the mean of their MSE
    low: Optional[float]        # range of the repeats
    high: Optional[float]
    relmse: float
    seconds: float              # median of the render stage
    seconds_low: float
    seconds_high: float
    cpu_seconds: Optional[float]  # median, of the whole process; None where not known
    own_error: Optional[float]  # what clrt itself says, root of the mean square

    @property
    def repeats(self):
        return len(self.runs)

    @property
    def blocks(self):
        """Squared errors of the blocks of the picture, mean of the repeats."""
        return sum(run.blocks for run in self.runs) / len(self.runs)

    @property
    def relative_blocks(self):
        """Likewise of relative squared errors."""
        return sum(run.relative_blocks for run in self.runs) / len(self.runs)

    @property
    def noise_blocks(self):
        """The part of them that is noise, as clrt's variance layers tell; None where one is missing."""
        known = [run.noise_blocks for run in self.runs if run.noise_blocks is not None]
        return sum(known) / len(known) if len(known) == len(self.runs) else None


def summarise(runs, reference):
    """{method: [Summary, ...]}, by rising samples."""
    groups = {}
    for run in runs:
        groups.setdefault(run.point.method, {}).setdefault(run.point.spp, []).append(run)
    return {method: [_summary(spp, group, reference) for spp, group in sorted(by_spp.items())]
            for method, by_spp in groups.items()}


def _summary(spp, group, reference):
    error = relative_root(statistics.fmean(run.mse for run in group), reference)
    each = [run.rel_rmse for run in group if run.rel_rmse is not None]
    own, cpu = [run.own_error for run in group], [run.cpu_seconds for run in group]
    seconds = [run.render_seconds for run in group]
    return Summary(spp, group, error, min(each, default=None), max(each, default=None),
                   statistics.fmean(run.relmse for run in group), statistics.median(seconds), min(seconds), max(seconds),
                   statistics.median(cpu) if None not in cpu else None,
                   math.sqrt(statistics.fmean(e * e for e in own)) if all(own) else None)


STAGES = ("load", "bvh", "compile", "first_launch", "pilots", "render", "total")
COLUMNS = ["scene", "renderer", "device", *SWITCHES, "seed", "spp", "width", "height", "cold",
           *(f"{stage}_s" for stage in STAGES), "process_cpu_s", "mse", "rel_rmse", "relmse", "own_rel_rmse", "nonfinite", "command"]
# Kinds of samples that a film leaves out.
BAD_SAMPLES = ("nan", "infinite", "negative", "overflow")


def _row(run, scene):
    """{column: value} of a run; of another renderer's what is known."""
    stats, point = run.stats, run.point
    row = {"scene": scene, "renderer": "clrt", "seed": point.seed, "spp": point.spp, "width": stats["width"],
           "height": stats["height"], "mse": repr(run.mse), "relmse": repr(run.relmse), "command": run.command,
           **{f"{stage}_s": f"{stats['seconds'][stage]:.6f}" for stage in STAGES if stage in stats["seconds"]}}
    if run.cpu_seconds is not None:
        row["process_cpu_s"] = f"{run.cpu_seconds:.6f}"
    if run.rel_rmse is not None:
        row["rel_rmse"] = repr(run.rel_rmse)
    if not isinstance(point.method, Method):
        return {**row, "renderer": str(point.method)}
    return {**row, **point.method.names(), "device": stats["device"]["name"], "cold": int(point.cold),
            "own_rel_rmse": run.own_error or "", "nonfinite": sum(stats["nonfinite"][kind] for kind in BAD_SAMPLES)}


def write_csv(path, runs, scene):
    """One row a run; an error below the reference's noise leaves rel_rmse empty."""
    table = io.StringIO()
    writer = csv.DictWriter(table, COLUMNS, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(_row(run, scene) for run in runs)
    write_text(path, table.getvalue())
