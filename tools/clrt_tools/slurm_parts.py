# SPDX-License-Identifier: Apache-2.0
"""The parts of a picture in the folder of its job: what is there, what it adds up to, what is missing."""
import collections
import contextlib
import dataclasses
import fcntl
import json
import os
import subprocess

from clrt_tools.film_header import FilmError, read_header
from clrt_tools.slurm_plan import frame_path, is_within, part_path


@dataclasses.dataclass
class Part:
    """A task's film file."""
    task: int
    state: str                 # "whole", "begun", "absent", "damaged"
    samples: int = 0           # of those of the task
    identity: str = ""         # what decides its bits
    reason: str = ""           # what is wrong with it


@dataclasses.dataclass
class Sum:
    """What the whole parts add up to."""
    ranges: list               # of samples, or frames
    error: float = None        # relative, of frames the largest; None: not known
    error_text: str = ""       # clrt-merge's report
    problems: list = dataclasses.field(default_factory=list)  # (task, reason) of parts that are not in it


def look_at(plan, folder, task):
    """What a task's header says; sums are not read."""
    try:
        header = read_header(part_path(folder, task))
        ranges = [list(pair) for pair in header["ranges"]]
        identity = json.dumps(header["identity"], sort_keys=True)
    except FileNotFoundError:
        return Part(task, "absent")
    except (FilmError, OSError, KeyError, TypeError) as error:
        return Part(task, "damaged", reason=str(error))
    first, end = plan.ranges[task]
    samples = sum(b - a for a, b in ranges)
    if ranges == [[first, end]]:
        return Part(task, "whole", samples, identity)
    if len(ranges) == 1 and ranges[0][0] == first and ranges[0][1] < end:
        return Part(task, "begun", samples, identity, f"{samples} of {end - first} spp are there")
    return Part(task, "damaged", reason=f"expected samples {first} to {end - 1}, found other ones")


def frames_there(plan, folder):
    """The frames that are finished; one that a signal has stopped is not."""
    found = Sum([])
    for task, part in enumerate(plan.ranges):
        try:
            with open(frame_path(folder, part[0]), encoding="utf-8") as file:
                told = json.load(file)
            if told["stop"]["rule"] == "signal":
                continue
            error = told["error"].get("rel_rmse")
        except FileNotFoundError:
            continue
        except (OSError, ValueError, KeyError, TypeError) as problem:
            found.problems.append((task, f"{frame_path(folder, part[0])}: {problem!r}"))
            continue
        found.ranges.append(part)
        found.error = max(found.error or 0, error) if error is not None else found.error
    return found


def merge_program(plan):
    """clrt-merge beside the job's clrt."""
    beside = os.path.join(os.path.dirname(plan.clrt), "clrt-merge")
    return beside if os.path.exists(beside) else "clrt-merge"


def run_merge(plan, films, *arguments):
    """Runs clrt-merge; returns (whether it succeeded, what it printed, what it complained of)."""
    done = subprocess.run([merge_program(plan), *films, *arguments], capture_output=True, text=True, check=False)
    return done.returncode == 0, done.stdout, done.stderr.strip()


def make_sum(plan, films, folder):
    """Adds films up to sum.film; returns what clrt-merge complains of, nothing where it succeeds."""
    scratch = os.path.join(folder, f".sum-{os.getpid()}.film")
    stats = os.path.join(folder, "sum.json")
    succeeded, _, complaint = run_merge(plan, films, "-o", scratch, "--stats", stats, "-q")
    if not succeeded:
        return complaint or "clrt-merge failed"
    os.replace(scratch, os.path.join(folder, "sum.film"))
    return ""


def is_readable(plan, path, folder):
    """Whether a film is whole to its last byte, and what is wrong."""
    scratch = os.path.join(folder, f".check-{os.getpid()}.json")
    succeeded, _, complaint = run_merge(plan, [path], "-q", "--stats", scratch)
    with contextlib.suppress(FileNotFoundError):
        os.remove(scratch)
    return succeeded, complaint.removeprefix("clrt-merge: error: ")


@contextlib.contextmanager
def lock(folder):
    """One process at a time adds up the parts; the lock goes with its process."""
    with open(os.path.join(folder, ".lock"), "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def difference(expected, found):
    """The first field in which two identities differ."""
    expected, found = json.loads(expected), json.loads(found)
    names = [name for name in {**expected, **found} if expected.get(name) != found.get(name)]
    return ", ".join(f"{name}: expected {json.dumps(expected.get(name))}, found {json.dumps(found.get(name))}"
                     for name in names[:1])


def add_up(plan, folder):
    """Brings sum.film to all whole parts there are. Parts of other scenes, options or versions than most have stay out, and so
    do those that cannot be read."""
    path, stats = os.path.join(folder, "sum.film"), os.path.join(folder, "sum.json")
    parts = [look_at(plan, folder, task) for task in range(len(plan.ranges))]
    whole = [part for part in parts if part.state == "whole"]
    problems = [(part.task, part.reason) for part in parts if part.state == "damaged"]
    counts = collections.Counter(part.identity for part in whole)
    identity = max(counts, key=counts.get) if counts else None
    problems += [(part.task, difference(identity, part.identity)) for part in whole if part.identity != identity]
    have = []
    with contextlib.suppress(FilmError, OSError, KeyError):
        header = read_header(path)
        if json.dumps(header["identity"], sort_keys=True) == identity:
            have = [list(pair) for pair in header["ranges"]]
    fresh = [part for part in whole if part.identity == identity and not is_within(plan.ranges[part.task], have)]
    films = [path] if have else []
    new = [part_path(folder, part.task) for part in fresh]
    if new and make_sum(plan, films + new, folder):
        # One of them cannot be read: find it.
        for part in list(fresh):
            readable, complaint = is_readable(plan, part_path(folder, part.task), folder)
            if not readable:
                fresh.remove(part)
                problems.append((part.task, complaint))
        if films and not is_readable(plan, path, folder)[0]:
            os.remove(path)
            return add_up(plan, folder)
        new = [part_path(folder, part.task) for part in fresh]
        if new and (complaint := make_sum(plan, films + new, folder)):
            problems.append((fresh[0].task, complaint))
    return read_sum(path, stats, sorted(problems))


def read_sum(path, stats, problems):
    """What sum.film and sum.json say."""
    ranges, error = [], None
    with contextlib.suppress(FilmError, OSError, KeyError):
        ranges = [list(pair) for pair in read_header(path)["ranges"]]
    with contextlib.suppress(OSError, ValueError):
        with open(stats, encoding="utf-8") as file:
            error = json.load(file)["error"].get("rel_rmse")
    return Sum(ranges, error, problems=problems)


def put_aside(folder, problems):
    """Takes parts that cannot be used out of the way of new ones."""
    for task, _ in problems:
        with contextlib.suppress(FileNotFoundError):
            os.replace(part_path(folder, task), part_path(folder, task) + ".left-out")


def missing_tasks(plan, ranges):
    """Tasks whose samples are not among the ranges."""
    return [task for task, part in enumerate(plan.ranges) if not is_within(part, ranges)]
