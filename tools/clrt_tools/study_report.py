# SPDX-License-Identifier: Apache-2.0
"""The findings of a study: everything that its page and its lines on the terminal say."""
import dataclasses
import math

from clrt_tools import study_ratios, study_results, study_sentence


@dataclasses.dataclass
class Study:
    """`times`: {method: [TimeTo of each target]}; `ratios`: {method: Ratio}."""
    runs: list
    reference: study_results.Reference
    default: object
    own_size: study_ratios.OwnSize
    summaries: dict
    ratios: dict
    times: dict
    stages: dict                # {method: (samples a pixel, seconds of each stage)}
    rivals: dict                # {Rival: [Summary]} of other renderers' pictures; they are in `times` and `ratios` too
    own_runs: list              # renders at the size asked for, the default first
    notes: list

    @property
    def headline(self):
        return study_sentence.headline(self.times[self.default], self.own_size, self.ratios, self.default)

    @property
    def is_extrapolated(self):
        """Whether any of the times is."""
        return any(time.kind == study_ratios.EXTRAPOLATED for times in self.times.values() for time in times)

    @property
    def end_slope(self):
        """Slope of the default's error over its samples at the last two counts, or None."""
        known = [(math.log(point.spp), math.log(point.error)) for point in self.summaries[self.default] if point.error]
        return study_ratios.slope_at_end(tuple(zip(*known))) if len(known) > 1 else None


def conclude(runs, reference, cold, own_runs, asked_size, notes, series=()):
    """The findings. `cold`: {method: seconds of a run that compiled}; `own_runs`: of the default first, at the size asked for;
    `asked_size`: (width, height); `series`: of other renderers, measured."""
    summaries = study_results.summarise(runs, reference)
    default = next(iter(summaries))
    rivals = study_results.summarise([run for each in series for run in each.runs], reference)
    notes = [*notes, *filter(None, (each.brightness_note() for each in series))]
    size = carry_over(summaries[default], runs[0].stats, own_runs[0] if own_runs else None, asked_size)
    times = {method: [study_ratios.time_to(points, target, size) for target in study_ratios.TARGETS]
             for method, points in {**summaries, **rivals}.items()}
    ratios = {method: ratio for method, ratio in study_ratios.compare(summaries, default).items() if method != default}
    ratios.update({rival: study_ratios.compare_rival(rival, points, summaries[default]) for rival, points in rivals.items()})
    return Study(runs, reference, default, size, summaries, ratios, times, stage_seconds(summaries, cold), rivals, own_runs, notes)


def stage_seconds(summaries, cold):
    """{method: (samples, seconds of each stage)}: compile and first launch of its cold run, the rest of a run with most samples."""
    result = {}
    for method, points in summaries.items():
        seconds = dict(points[-1].runs[0].stats["seconds"])
        seconds.update({stage: cold[method][stage] for stage in ("compile", "first_launch") if method in cold})
        result[method] = (points[-1].spp, seconds)
    return result


def carry_over(points, stats, own_run, asked_size):
    """How the study's figures become those of the size asked for: by a run of that size, else by the number of pixels."""
    width, height = asked_size
    if (stats["width"], stats["height"]) == (width, height):
        return study_ratios.OwnSize(width, height)
    if own_run is None:
        return study_ratios.OwnSize(width, height, width * height / (stats["width"] * stats["height"]), 1.0, False)
    last = points[-1]
    same = next((point for point in points if point.spp == own_run.stats["spp"]), None)
    seconds = own_run.render_seconds / own_run.stats["spp"] / (last.seconds / last.spp)
    error = own_run.own_error / same.own_error if same and same.own_error and own_run.own_error else 1.0
    return study_ratios.OwnSize(width, height, seconds, error)
