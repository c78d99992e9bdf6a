# SPDX-License-Identifier: Apache-2.0
"""Another renderer's pictures of the scene, to compare with: a folder of EXR files (or other linear pictures) and series.json:

    {"name": "Mitsuba 3.9.1 path",
     "pictures": [{"file": "spp16_seed1.exr", "spp": 16, "seed": 1, "seconds": 0.52, "cpu_seconds": 1.02}, ...]}

`seconds`: of rendering, wall clock, without loading and compiling, on the machine of the study; `cpu_seconds`, which may be left
out: user and system time of the same. Pictures of one count of samples and of different seeds are independent repeats."""
import dataclasses
import json
import math
import os
import statistics

from clrt_tools.peer_series import LIST_FILE
from clrt_tools.picture_file import UnreadableFile, read_picture
from clrt_tools.study_runs import Point, Run

# What a picture of the list must say, as (type, least value).
KEYS = {"file": (str, None), "spp": (int, 1), "seed": (int, 0), "seconds": ((int, float), 1e-9)}
# A mean that is surely off by more than this, relative, is of another scene.
SAME_MEAN, SURELY = 0.01, 4.0


class SeriesError(Exception):
    """A folder that holds no series; the message names the file, what was expected and what was found."""


@dataclasses.dataclass(frozen=True)
class Rival:
    """Takes the place of a Method for another renderer."""
    name: str

    def __str__(self):
        return self.name

    def label(self, _):
        return self.name


@dataclasses.dataclass
class Series:
    """Pictures of one renderer, all of one size."""
    rival: Rival
    runs: list
    size: tuple  # (width, height)

    def brightness_note(self):
        """What to say where the pictures, once measured, surely have another mean than the reference; else nothing."""
        values = [run.brightness - 1 for run in self.runs]
        mean = statistics.fmean(values)
        if len(values) < 2 or abs(mean) < max(SAME_MEAN, SURELY * statistics.stdev(values) / math.sqrt(len(values))):
            return ""
        return (f"{self.rival}: its pictures are {100 * abs(mean):.1f} % {'brighter' if mean > 0 else 'darker'} than the "
                "reference: it renders another scene, and its errors count that")


def read_series(folder):
    """The Series of a folder. Raises SeriesError or UnreadableFile."""
    path = os.path.join(folder, LIST_FILE)
    try:
        with open(path, encoding="utf-8") as file:
            said = json.load(file)
    except OSError as error:
        raise SeriesError(f"{path}: expected the list of another renderer's pictures, found none that can be read "
                          f"({error.strerror})") from error
    except ValueError as error:
        raise SeriesError(f"{path}: expected JSON, found: {error}") from error
    if not isinstance(said, dict) or not isinstance(said.get("name"), str) or not isinstance(said.get("pictures"), list):
        raise SeriesError(f'{path}: expected {{"name": "...", "pictures": [...]}}, found something else')
    if not said["pictures"]:
        raise SeriesError(f"{path}: expected one picture or more, found none")
    rival = Rival(said["name"])
    runs = [_run(path, index, picture, rival) for index, picture in enumerate(said["pictures"], 1)]
    keys = [(run.point.spp, run.point.seed) for run in runs]
    if len(set(keys)) != len(keys):
        raise SeriesError(f"{path}: expected one picture for each spp and seed, found two with the same")
    return Series(rival, runs, _common_size(runs))


def read_all_series(folders, size):
    """Those of several renderers, all of one size: that of `size` ("WxH") where it is given."""
    found = [read_series(folder) for folder in folders]
    for folder, series in zip(folders, found):
        expected = size or _words(found[0].size)
        if _words(series.size) != expected:
            raise SeriesError(f"{folder}: expected pictures of {expected}, found {_words(series.size)}")
    if len({series.rival for series in found}) != len(found):
        raise SeriesError(f"{folders[-1]}: expected renderers of different names, found {found[-1].rival} twice")
    return found


def _words(size):
    return "{}x{}".format(*size)


def _run(path, index, picture, rival):
    """A picture of the list as a Run."""
    for key, (kind, least) in KEYS.items():
        value = picture.get(key) if isinstance(picture, dict) else None
        if not isinstance(value, kind) or isinstance(value, bool) or (least is not None and not least <= value < math.inf):
            raise SeriesError(f'{path}: picture {index}: expected "{key}", ' +
                              ("a file name" if least is None else f"a number of at least {least:g}") + f", found {value!r}")
    spp, seconds = picture["spp"], float(picture["seconds"])
    stats = {"spp": spp, "seconds": {"render": seconds}}
    return Run(Point(rival, spp, picture["seed"]), "", os.path.join(os.path.dirname(path), picture["file"]), stats,
               picture.get("cpu_seconds"))


def _common_size(runs):
    """(width, height) of all pictures."""
    sizes = {}
    for run in runs:
        picture = read_picture(run.picture)
        if picture.encoding:
            raise UnreadableFile(f"{run.picture}: expected linear radiance (EXR, HDR, PFM, float TIFF), found {picture.encoding}")
        run.stats["height"], run.stats["width"] = picture.mean.shape[:2]
        sizes.setdefault((run.stats["width"], run.stats["height"]), run.picture)
    if len(sizes) > 1:
        (first, where), (other, there) = list(sizes.items())[:2]
        raise SeriesError(f"{there}: expected {first[0]}x{first[1]} pixels like {where}, found {other[0]}x{other[1]}")
    return next(iter(sizes))

