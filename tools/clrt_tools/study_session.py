# SPDX-License-Identifier: Apache-2.0
"""The runs of a study in their order: probe and plan (quick studies), one run a method that compiles, the reference, the sweep,
one run at the size asked for."""
import dataclasses
import os
import sys

from clrt_tools import study_plan, study_results
from clrt_tools.picture_file import read_picture
from clrt_tools.study_methods import combinations
from clrt_tools.study_runs import REFERENCE_METHOD, REFERENCE_SEEDS, OutOfTime, Point, Refused, RunError, sweep

COUNTS, REPEATS = (4, 16, 64, 256), 3  # of studies that are not quick
REFERENCE_FACTOR = 8  # samples of each half, over the most of a run
# Pixels and samples of the two launches that measure the machine's speed, and the longest render stage of the second, seconds.
PROBE_PIXELS, PROBE_SAMPLES, PROBE_SECONDS = 112 * 84, (1, 16), 2.0
# Part of the budget that each half of the reference may take.
HALF_REFERENCE_SHARE = 0.25
# Load of the machine, over its cores, above which it counts as busy with other work when a study begins.
BUSY = 0.5


class ProgressLine:
    """One line on a terminal, plain lines elsewhere."""

    def __init__(self, budget):
        self.budget, self.total, self.done, self.terminal = budget, 0, 0, sys.stderr.isatty()

    def step(self, text):
        elapsed = self.budget.elapsed()
        left = f", about {elapsed / self.done * (self.total - self.done):.0f} s left" if self.done and self.total else ""
        self.done += 1
        place = f"[{self.done}/{self.total}] " if self.total else ""
        line = f"{place}{text}  ({elapsed:.0f} s{left})"
        print(f"\r\x1b[K{line}" if self.terminal else line, end="" if self.terminal else "\n", file=sys.stderr, flush=True)

    def skip(self):
        self.total -= 1

    def end(self):
        if self.terminal:
            print(file=sys.stderr)


class Session:
    """Runs what a study needs, within its budget."""

    def __init__(self, options, runner, budget, default):
        """`default`: the Method of clrt without options."""
        self.options, self.runner, self.budget, self.default = options, runner, budget, default
        self.progress = ProgressLine(budget)
        self.runs, self.notes, self.failed, self.refused, self.skipped = [], [], {}, {}, []
        self.cold = {}  # method: seconds of the stages of its first run, which compiled
        load = os.getloadavg()[0] / (os.cpu_count() or 1)
        if load > BUSY:
            self.notes.append(f"the machine was busy with other work when the study began (load {load:.1f} a core): the seconds "
                              "are those of this machine now, not of an idle one")

    def plan(self):
        """What to run: as the options say, or, of a quick study, what fits."""
        options = self.options
        methods = combinations(options.names, options.given, options.quick, self.default)
        if not options.quick:
            counts = tuple(options.spp or COUNTS)
            half = max(1, options.reference_spp // 2) if options.reference_spp else REFERENCE_FACTOR * max(counts)
            return study_plan.Plan(methods, counts, options.repeats or REPEATS, None, 0 if options.reference else half), None
        own_size, speed = self._probe(methods[0])
        given = {"counts": tuple(options.spp or ()), "repeats": options.repeats}
        if options.reference:
            window = read_picture(options.reference[0]).window
            given.update(reference_spp=0, size=(window.full_width, window.full_height))
        elif options.reference_spp:
            given["reference_spp"] = max(1, options.reference_spp // 2)
        if "--crop" in options.extra or options.against:
            given["size"] = own_size  # numbers of the crop are pixels of that size; another renderer's pictures have it
        plan = study_plan.choose_plan(speed, self.budget.left(), own_size, methods, given)
        self.notes += plan.notes
        return plan, own_size

    def _probe(self, method):
        """The size asked for, and the machine's speed: one launch that compiles, one that does not."""
        self.progress.step("the machine's speed")
        corner = () if "--crop" in self.options.extra else ("--crop", "0,0,1,1")
        cold = self.runner.run("probe_size", Point(method, PROBE_SAMPLES[0], 1, True), corner, self.budget.left())
        window = read_picture(cold.picture).window
        own_size = (window.full_width, window.full_height)
        width, height = own_size if not corner else study_plan.shrunk(own_size, PROBE_PIXELS)
        begin = self.budget.elapsed()
        warm = self.runner.run("probe_speed", Point(method, PROBE_SAMPLES[1], 1), ("-t", f"{PROBE_SECONDS:g}"),
                               self.budget.left(), f"{width}x{height}")
        rendering = max(warm.render_seconds, 1e-3)
        samples = warm.stats["width"] * warm.stats["height"] * warm.stats["spp"] / rendering
        seconds = cold.stats["seconds"]
        self.cold[method] = seconds
        return own_size, study_plan.Speed(samples, max(self.budget.elapsed() - begin - rendering, 0.0),
                                          seconds["compile"] + seconds["first_launch"])

    def sweep(self, plan):
        """All runs that fit and succeed, measured against the reference, which is returned."""
        points = sweep(plan.methods, plan.counts, plan.repeats)
        self.progress.total = (self.progress.done + len(points) + (0 if self.options.reference else 2) +
                               (len(plan.methods) if plan.own_spp else 0))
        if plan.size:
            self.runner.size = "{}x{}".format(*plan.size)
        first = [point for point in points if point.cold]
        self._run_all([dataclasses.replace(point, cold=point.method not in self.cold) for point in first])
        reference = self._reference(plan)
        self._run_all(points[len(first):], len(first))
        for run in self.runs:
            study_results.measure(run, reference)
        self._note_what_is_missing(len(points))
        return reference

    def own_size_runs(self, plan, own_size):
        """Runs at the size asked for, at equal samples, of the default and of as many other methods as fit; none where the sweep
        had that size."""
        size, larger = "{}x{}".format(*own_size), own_size[0] * own_size[1] / (plan.size[0] * plan.size[1])
        runs = []
        for method in plan.methods if plan.own_spp and self.runs else ():
            point = Point(method, plan.own_spp, 1)
            if method in self.failed or not self.budget.fits(point, larger):
                self.progress.skip()
                continue
            self.progress.step(f"{method} at {size}: {plan.own_spp} spp")
            try:
                runs.append(self.runner.run(f"own_size_{len(runs)}", point, (), self.budget.left(), size))
            except (OutOfTime, RunError):
                break
        if plan.own_spp and (not runs or runs[0].point.method != plan.methods[0]):
            self.notes.append(f"no render of {size} was made: it failed or did not fit into the time")
            return []
        return runs

    def _run_all(self, points, first=0):
        for index, point in enumerate(points, first):
            if point.method in self.failed or point.spp in self.refused.get(point.method, ()):
                self.progress.skip()
            elif not self.budget.fits(point):
                self.progress.skip()
                self.skipped.append(point)
            else:
                self._run(index, point)

    def _run(self, index, point):
        self.progress.step(f"{point.method}: {point.spp} spp, seed {point.seed}")
        begin = self.budget.elapsed()
        try:
            run = self.runner.run(f"run_{index:04d}", point, (), self.budget.left())
        except OutOfTime:
            self.skipped.append(point)
            return
        except Refused as error:
            self.refused.setdefault(point.method, {})[point.spp] = str(error)
            return
        except RunError as error:
            self.failed[point.method] = str(error)
            return
        seconds = run.stats["seconds"]
        self.cold.setdefault(point.method, seconds)
        self.budget.note(point, self.budget.elapsed() - begin, run.render_seconds, seconds["compile"] + seconds["first_launch"])
        self.runs.append(run)

    def _reference(self, plan):
        """Renders both halves, or reads the files."""
        if self.options.reference:
            return study_results.reference_of_files(self.options.reference)
        halves = []
        for half, seed in zip("ab", REFERENCE_SEEDS):
            self.progress.step(f"reference, half {half}: {plan.reference_spp} spp")
            limit = ("-t", f"{self.budget.seconds * HALF_REFERENCE_SHARE:g}") if self.budget.seconds else ()
            try:
                halves.append(self.runner.run(f"reference_{half}", Point(REFERENCE_METHOD, plan.reference_spp, seed), limit,
                                              self.budget.left()))
            except OutOfTime:
                if not halves:
                    raise
                self.notes.append("no time for the second half of the reference: the variance layer of the first tells its noise")
        reference = study_results.reference_of_files([run.picture for run in halves])
        reference.text = (f"{REFERENCE_METHOD}, {' and '.join(str(run.stats['spp']) for run in halves)} spp, seeds "
                          f"{' and '.join(str(run.point.seed) for run in halves)}")
        reference.seconds = sum(run.render_seconds for run in halves)
        return reference

    def _note_what_is_missing(self, total):
        self.notes += [f"{method}: not measured. {message}" for method, message in self.failed.items()]
        self.notes += [f"{method}: not with {' and '.join(map(str, counts))} spp. {next(iter(counts.values()))}"
                       for method, counts in self.refused.items() if method not in self.failed]
        if self.skipped:
            made = {run.point.method for run in self.runs}
            lost = list(dict.fromkeys(str(point.method) for point in self.skipped if point.method not in made))
            self.notes.append(f"{len(self.skipped)} of {total} runs were dropped to end within {self.budget.seconds} s" +
                              (f", all of {'; '.join(lost)}" if lost else ""))
