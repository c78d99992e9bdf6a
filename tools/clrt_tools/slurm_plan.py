# SPDX-License-Identifier: Apache-2.0
"""One picture, or the frames of a turn, as a job array of Slurm: which task renders which samples or frame, and the scripts
that say so. Runs nothing."""
import dataclasses
import json
import os
import shlex

SAMPLE_GROUP = 8  # ranges are cut at multiples of it: all replicates of clrt get as many samples

# What clrt-slurm gives to clrt itself, or what makes no picture; and why.
REFUSED = {
    ("-s", "--spp"): "give it to clrt-slurm",
    ("-e", "--error"): "give it to clrt-slurm",
    ("-o", "--output"): "give it to clrt-slurm",
    ("--frames",): "give it to clrt-slurm",
    ("--checkpoint",): "every part has its own",
    ("--resume",): "parts are gone on with by themselves",
    ("--stats",): "every part has its own",
    ("--ledger",): "it makes no picture",
    ("--pixel",): "it makes no picture",
    ("--explain",): "it makes no picture",
}
# What a picture has that no part of it can have.
REFUSED_OF_PARTS = {
    ("-t", "--time"): "a part must have all of its samples; sbatch's --time bounds a task",
    ("--first-sample",): "every part has its own",
    ("--save-every",): "`clrt-slurm status` writes the picture so far",
    ("--adaptive",): "its samples are dealt out by the noise of all before them; films of it do not merge",
    ("--guide",): "guided samples need all those before them; parts are rendered with --guide off",
}
REFUSED_INTEGRATORS = {"mlt": "a step of a chain follows from all those before it",
                       "auto": "its pilots depend on the samples of a part; name what they choose for the whole picture"}


class PlanError(Exception):
    """A job that cannot be: what was expected, what was found."""


@dataclasses.dataclass
class Plan:
    """A job, as it lies in its folder."""
    words: list       # of clrt's command line, the scene among them
    folder: str       # where it was given; paths are relative to it
    clrt: str         # the program
    version: str      # of it
    ranges: list      # [first, end) of each task: samples, or frames, from 1
    outputs: list     # pictures
    error: str        # as given to --error; empty: none
    checkpoint: str   # seconds or a duration between two saves of a part
    frames: int = 0   # of a turn; 0: one picture
    spp: int = 0      # of a frame; 0: as clrt does without

    def text(self):
        return json.dumps(dataclasses.asdict(self), indent=1) + "\n"


def read_plan(path):
    with open(path, encoding="utf-8") as file:
        return Plan(**json.load(file))


def split_samples(spp, tasks):
    """[first, end) of each task: even, in order, cut at multiples of SAMPLE_GROUP; fewer tasks where there are fewer such parts."""
    groups = -(-spp // SAMPLE_GROUP)
    tasks = min(tasks, groups)
    bounds = [min(SAMPLE_GROUP * (groups * i // tasks), spp) for i in range(tasks + 1)]
    return [[first, end] for first, end in zip(bounds, bounds[1:])]


def split_frames(frames):
    """[first, end) of each task: a frame."""
    return [[frame, frame + 1] for frame in range(1, frames + 1)]


def array_text(tasks):
    """The tasks as --array= takes them: "0-3,7"."""
    parts = []
    for task in sorted(set(tasks)):
        if parts and parts[-1][1] == task - 1:
            parts[-1][1] = task
        else:
            parts.append([task, task])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in parts)


def range_text(ranges):
    """"0 to 63, 128 to 191", neighbours joined."""
    joined = []
    for first, end in sorted(ranges):
        if joined and joined[-1][1] == first:
            joined[-1][1] = end
        else:
            joined.append([first, end])
    return ", ".join(f"{first} to {end - 1}" for first, end in joined)


def is_within(part, ranges):
    """Whether all samples of a part are among the ranges."""
    return any(first <= part[0] and part[1] <= end for first, end in ranges)


def check_words(words, frames=0):
    """Raises PlanError for options of clrt that parts of a picture, or whole ones, cannot have."""
    refused = REFUSED if frames else {**REFUSED, **REFUSED_OF_PARTS}
    for index, word in enumerate(words):
        name, _, value = word.partition("=") if word.startswith("--") else (word[:2], "", word[2:])
        for names, reason in refused.items():
            if name in names:
                raise PlanError(f"expected no {name} behind --, found '{word}': {reason}")
        if name in ("-i", "--integrator") and not frames:
            integrator = value or (words[index + 1] if index + 1 < len(words) else "")
            if integrator in REFUSED_INTEGRATORS:
                raise PlanError(f"expected another integrator than {integrator}: {REFUSED_INTEGRATORS[integrator]}")


def part_path(folder, task):
    return os.path.join(folder, f"part-{task:04}.film")


def frame_path(folder, frame):
    """What is told of a finished frame."""
    return os.path.join(folder, f"frame-{frame:04}.json")


def clrt_command(plan, folder, task, picture, resumes, threads=None):
    """The command line that renders a task's samples into its part. `picture`: a file that nobody needs."""
    first, end = plan.ranges[task]
    part = part_path(folder, task)
    return [plan.clrt, *plan.words, "--first-sample", str(first), "--spp", str(end - first), "--guide", "off",
            "--checkpoint", f"{part},{plan.checkpoint}", "-o", picture, "--aov", "none", *run_words(plan, threads),
            *(["--resume", part] if resumes else ["--force"])]


def frame_command(plan, folder, task, threads=None):
    """The command line that renders a task's frame into the pictures of the plan."""
    frame = plan.ranges[task][0]
    command = [plan.clrt, *plan.words, "--frames", f"{plan.frames}:{frame}", "--stats", frame_name(folder)]
    command += [word for path in plan.outputs for word in ("-o", path)]
    command += ["--spp", str(plan.spp)] if plan.spp else []
    command += ["--error", plan.error] if plan.error else []
    return command + run_words(plan, threads)


def frame_name(folder):
    """frame_path of all frames, as clrt takes names."""
    return os.path.join(folder.replace("{", "{{").replace("}", "}}"), "frame-{frame:4}.json")


def run_words(plan, threads):
    """How every task runs."""
    has_threads = any(word.startswith(("-j", "--threads")) for word in plan.words)
    return ["--progress", "off", *(["--threads", threads] if threads and not has_threads else [])]


def script(folder, program, call, options):
    """A batch script that runs `program call FOLDER`; `call` may name a variable of Slurm."""
    name = "clrt-" + (os.path.basename(folder) or "picture")
    lines = ["#!/bin/sh", f"#SBATCH --job-name={name}", *(f"#SBATCH {option}" for option in options),
             f"exec {shlex.quote(program)} {call} {shlex.quote(folder)}"]
    return "\n".join(lines) + "\n"


def array_script(folder, program, tasks, at_once, further):
    """Of the array. The signal comes a minute before the task's time is over: its film is saved then, and the task requeued. It
    is another than that of scancel, which ends a task for good."""
    limit = f"%{at_once}" if at_once else ""
    return script(folder, program, 'task --task "$SLURM_ARRAY_TASK_ID"',
                  [f"--array={array_text(tasks)}{limit}", "--requeue", "--open-mode=append", "--signal=B:USR1@60",
                   f'--output="{os.path.join(folder, "task-%a.log")}"', *further])


def merge_script(folder, program, further):
    """Of the job behind the array."""
    return script(folder, program, "merge", [f'--output="{os.path.join(folder, "merge.log")}"', "--open-mode=append", *further])
