# SPDX-License-Identifier: Apache-2.0
"""One HTML page with everything inside: it opens from disk without a network."""
import math
import os

import jinja2

from clrt_tools import study_charts, study_pictures, study_sentence
from clrt_tools.metrics import DARK_SHARE
from clrt_tools.picture_file import read_picture
from clrt_tools.study_ratios import TARGETS

# Pixels of the screen a pixel of a picture may take: beyond it pictures look like mosaics.
LARGEST_ZOOM = 2
FOLDER = os.path.dirname(os.path.realpath(__file__))


def _shown(summaries, default):
    """(method, its summary) at the most samples that the default and all single changes to it have: equal samples."""
    methods = [method for method in summaries if len(method.changes(default)) <= 1]
    common = set.intersection(*({s.spp for s in summaries[method]} for method in methods))
    if not common:
        methods, common = [default], {summaries[default][-1].spp}
    spp = max(common)
    return [(method, next(s for s in summaries[method] if s.spp == spp)) for method in methods]


def _nearest(points, summary):
    """The first run of the points whose seconds are nearest to those of a summary."""
    return min(points, key=lambda point: abs(math.log(point.seconds / summary.seconds))).runs[0]


def _of_runs(runs, default, exposure):
    """Renders for the page, at one exposure."""
    return [_picture(f"{run.point.method.label(default)}, {run.stats['spp']} spp", _about(run), read_picture(run.picture).mean,
                     exposure) for run in runs]


def _picture(name, about, mean, exposure):
    height, width = mean.shape[:2]
    return {"name": name, "about": about, "size": f"{width}x{height}", "largest": LARGEST_ZOOM * width,
            "uri": study_pictures.picture_uri(mean, exposure)}


def _about(run):
    """Its error and its seconds."""
    seconds = study_sentence.duration(run.render_seconds)
    if run.blocks is None:
        return seconds
    error = f"error {study_sentence.number(100 * run.rel_rmse)} %" if run.rel_rmse else "error below the reference's noise"
    return f"{error} in {seconds}"


def _pictures(study):
    """What the page shows: renders at the size asked for where there are two or more to compare, else those of the sweep with
    their reference; and the differences from it. One exposure, one scale."""
    reference = study.reference.mean
    exposure = study_pictures.exposure_for(reference)
    runs = [min(summary.runs, key=lambda run: run.point.seed) for _, summary in _shown(study.summaries, study.default)]
    runs += [_nearest(points, study.summaries[study.default][-1]) for points in study.rivals.values()]
    if len(study.own_runs) > 1:
        shown = _of_runs(study.own_runs, study.default, exposure)
    else:
        shown = [_picture("reference", "", reference, exposure)] + _of_runs(runs, study.default, exposure)
    values = [study_pictures.difference(read_picture(run.picture).mean, reference) for run in runs]
    scale = study_pictures.scale_for(values[0])
    differences = [{"name": f"{run.point.method.label(study.default)}, {run.point.spp} spp", "about": _about(run),
                    "largest": LARGEST_ZOOM * reference.shape[1], "uri": study_pictures.difference_uri(value, scale)}
                   for run, value in zip(runs, values)]
    return {"shown": shown, "differences": differences, "exposure": exposure, "scale": study_pictures.scale_svg(scale),
            "largest": scale}


def gains(study, labels):
    """{words: accuracy a second over the default's, by both errors} of every single change to the default and of
    other renderers."""
    return {labels[method]: tuple(cost and cost.inverse() for cost in (ratio.cost, ratio.relative_cost))
            for method, ratio in study.ratios.items() if method in study.rivals or len(method.changes(study.default)) == 1}


def page(title, study):
    """The page's text, of a study_report.Study."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(FOLDER), autoescape=True, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(number=study_sentence.number, duration=study_sentence.duration, ends=study_sentence.ends,
                               time_words=study_sentence.time_words, cost_words=study_sentence.cost_words)
    first = study.runs[0].stats
    curves = {**study.summaries, **study.rivals}
    labels = {method: method.label(study.default) for method in curves}
    return environment.get_template("study_page.html.jinja").render(
        title=title, study=study, curves=curves, labels=labels, targets=TARGETS, cores=os.cpu_count(), dark=DARK_SHARE,
        device=first["device"], version=first["version"], width=first["width"], height=first["height"],
        triangles=first.get("triangles"), **_pictures(study),
        gains_chart=study_charts.gains_chart(gains(study, labels)),
        error_chart=study_charts.error_chart(curves, labels), stages_chart=study_charts.stages_chart(study.stages, labels),
        stages=study.stages[study.default][1])
