# SPDX-License-Identifier: Apache-2.0
"""Renders a scene with another renderer and measures what it took: a series that `clrt-study --against` reads (study_series.py).
What clrt-mitsuba and clrt-cycles have in common."""
import argparse
import contextlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

from clrt_tools.atomic_text import write_text
from clrt_tools.find_clrt import NoClrt, find_clrt
from clrt_tools.help_page import CommandLine
from clrt_tools.mean_check import compare_means
from clrt_tools.plain_scene import NotPlain, read_plain_scene

# The list of the pictures; its form is in study_series.py.
LIST_FILE = "series.json"
FAILED = 1
# Seeds of the run that compiles, whose seconds do not count, and of pictures whose mean alone counts; far from those of the
# repeats, which count from 1.
WARM_UP_SEED, MEAN_SEED = 20001, 10001
# Pictures of clrt, of the most samples asked for, whose mean the other's must have. Rare bright samples make few pictures look
# surer than they are: where the means seem to differ, both render again, with so many times the samples.
CHECK_RUNS, CHECK_SEED, DOUBT_FACTOR = 4, 2000001, 16
PURPOSE = """Renders a scene of clrt with {peer}, another renderer, and writes what `clrt-study --against` reads: pictures, their
seconds, and series.json. Only scenes that both renderers understand alike are taken: matte, mirror, clear glass, area lights, a
constant sky and a sun that is a point, with the camera of the options file; all else is refused with file and line. In the end the
mean of the pictures is checked against that of clrt's. Needs the Python packages {packages}: run it with the Python that has
them."""
EXIT_CODES = ((0, "the series is written"),
              (1, "the scene cannot be converted, {peer} or clrt is missing or fails, or the means differ: no series.json"),
              (2, "wrong command line"))


class Failure(Exception):
    """Ends the program; the message says why."""


class Peer:
    """Another renderer, as a program of its own shows it."""
    program = name = packages = ""  # such as clrt-mitsuba, Mitsuba 3, "mitsuba and numpy"

    def add_options(self, add):
        """Adds those that it alone has, by argparse's add_argument."""

    def open(self, scene, options, folder):
        """The PlainScene as a PeerScene; `folder` is there until the end. Raises Failure."""
        raise NotImplementedError


class PeerScene:
    """A scene in another renderer. Pictures are of whatever kind it likes."""
    title = ""  # of renderer and choices, for legends

    def warm_up(self, spp):
        """Does what only the first render of so many samples has to do."""

    def render(self, spp, seed):
        """A picture. What it takes is measured."""
        raise NotImplementedError

    def write(self, picture, path):
        """Writes it as EXR."""
        raise NotImplementedError

    def mean(self, picture):
        """Of the pixels and of R, G and B."""
        raise NotImplementedError

    def mean_of_file(self, path):
        """The same of an EXR file of clrt's."""
        raise NotImplementedError


def run(peer, here):
    """The program; `here`: its folder."""
    options = _parse_arguments(peer)
    try:
        scene = read_plain_scene(options.scene)
        with tempfile.TemporaryDirectory(prefix=peer.program + "-") as folder:
            opened = peer.open(scene, options, folder)
            program = find_clrt(options.clrt, here)
            os.makedirs(options.output, exist_ok=True)
            with contextlib.suppress(FileNotFoundError):
                os.remove(os.path.join(options.output, LIST_FILE))  # it names pictures that are written anew
            listed, means = _series(opened, options)
            check = _check(opened, options, program, folder, means)
    except (Failure, NotPlain, NoClrt, OSError, RuntimeError, ValueError) as error:
        _fail(peer, error)
    if check.differs:
        _fail(peer, f"expected the mean of clrt's pictures, found {check}: the two do not render the same scene")
    write_text(os.path.join(options.output, LIST_FILE), json.dumps({"name": opened.title, "pictures": listed}, indent=1) + "\n")
    print(f"{len(listed)} pictures in {options.output}; mean over that of clrt's: {check}")


def _fail(peer, message):
    print(f"{peer.program}: error: {message}", file=sys.stderr)
    sys.exit(FAILED)


def _say(text):
    print(text, file=sys.stderr, flush=True)


def _counts(text):
    values = text.split(",")
    if not all(value.isdecimal() and int(value) > 0 for value in values):
        raise argparse.ArgumentTypeError(f"expected whole numbers from 1 such as 16,64, found '{text}'")
    return sorted({int(value) for value in values})


def _size(text):
    parts = text.split("x")
    if len(parts) != 2 or not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise argparse.ArgumentTypeError(f"expected WxH such as 320x240, found '{text}'")
    return tuple(map(int, parts))


def _parse_arguments(peer):
    names = {"peer": peer.name, "packages": peer.packages}
    examples = ("pip install " + peer.packages.replace(" and ", " "),
                f"python3 {peer.program} scenes/cornell_box/cornell_box.obj -r 320x240 --spp 16,64,256 -o series",
                "clrt-study scenes/cornell_box/cornell_box.obj --against series")
    line = CommandLine(peer.program, " ".join(PURPOSE.format(**names).split()), examples,
                       [(code, text.format(**names)) for code, text in EXIT_CODES])
    add = line.add_argument
    add("scene", metavar="scene.obj", help="the scene")
    add("-r", "--size", type=_size, default=(320, 240), metavar="WxH", help="width and height in pixels (default 320x240)")
    add("-s", "--spp", type=_counts, default=[16, 64, 256], metavar="LIST", help="samples a pixel (default 16,64,256)")
    add("--repeats", type=int, choices=range(2, 1000), default=3, metavar="N",
        help="runs of each, 2 or more, with seeds 1 to N (default 3)")
    peer.add_options(add)
    add("-j", "--threads", type=int, metavar="N", help="CPU threads (default: all)")
    add("-d", "--device", metavar="NAME", help="as for clrt, which checks the mean")
    add("-o", "--output", required=True, metavar="DIR", help="folder of the pictures and of series.json; made where it is missing")
    add("--clrt", metavar="PROGRAM", help="(default: the clrt beside this program)")
    line.add_help_and_version()
    return line.parse_args()


def missing_package(error, packages):
    """The Failure for an ImportError."""
    return Failure(f"expected the Python package {error.name}, found none in {sys.executable}; pip install "
                   f"{packages.replace(' and ', ' ')}, in a virtual environment if need be, and run this program with its Python")


def _series(opened, options):
    """Renders all, writes the pictures. Returns what series.json says of them, and (spp, mean) of each."""
    listed, means = [], []
    for spp in options.spp:
        _say(f"{spp} spp, warming up")
        opened.warm_up(spp)
    for seed in range(1, options.repeats + 1):
        for spp in options.spp:
            _say(f"{spp} spp, seed {seed}")
            before, begin = _cpu_seconds(), time.perf_counter()
            picture = opened.render(spp, seed)
            seconds, cpu_seconds = time.perf_counter() - begin, _cpu_seconds() - before
            name = f"spp{spp}_seed{seed}.exr"
            opened.write(picture, os.path.join(options.output, name))
            listed.append({"file": name, "spp": spp, "seed": seed, "seconds": seconds, "cpu_seconds": cpu_seconds})
            means.append((spp, opened.mean(picture)))
    return listed, means


def _cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def _check(opened, options, program, folder, means):
    """The means of both renderers, twice where they seem to differ."""
    most = max(options.spp)
    check = compare_means(_means_of_clrt(opened, options, program, most, folder), [mean for spp, mean in means if spp == most])
    if check.differs:
        most *= DOUBT_FACTOR
        check = compare_means(_means_of_clrt(opened, options, program, most, folder), _more_means(opened, most))
    return check


def _means_of_clrt(opened, options, program, spp, folder):
    """Of pictures of other seeds."""
    means = []
    for seed in range(CHECK_SEED, CHECK_SEED + CHECK_RUNS):
        _say(f"clrt, {spp} spp, seed {seed}")
        path = os.path.join(folder, f"clrt_{seed}.exr")
        words = [program, options.scene, "-q", "-r", "{}x{}".format(*options.size), "-s", str(spp), "--seed", str(seed),
                 "--aov", "none", "-o", path] + (["-d", options.device] if options.device else [])
        done = subprocess.run(words, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise Failure(f"expected clrt to render the scene, found exit code {done.returncode}: {done.stderr.strip()}")
        means.append(opened.mean_of_file(path))
    return means


def _more_means(opened, spp):
    """Of pictures of seeds that no series has."""
    found = []
    for seed in range(MEAN_SEED, MEAN_SEED + CHECK_RUNS):
        _say(f"{spp} spp, seed {seed}, for the mean alone")
        found.append(opened.mean(opened.render(spp, seed)))
    return found
