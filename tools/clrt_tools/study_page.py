# SPDX-License-Identifier: Apache-2.0
"""One HTML page with everything inside: it opens from disk without a network."""
import os

import jinja2

from clrt_tools import study_charts
from clrt_tools.metrics import SMALL_SQUARE
from clrt_tools.picture_file import read_picture

FOLDER = os.path.dirname(os.path.realpath(__file__))


def _pictures(runs, reference):
    """Reference first, then the first repeat of each method with most samples."""
    exposure = study_charts.exposure_for(reference.mean)
    pictures = [{"name": "reference", "error": "", "png": study_charts.picture_png(reference.mean, exposure), "map": None}]
    for method in dict.fromkeys(run.point.method for run in runs):
        own = [run for run in runs if run.point.method == method]
        run = max(own, key=lambda run: (run.point.spp, -run.point.seed))
        mean = read_picture(run.picture).mean
        pictures.append({
            "name": f"{method}, {run.point.spp} spp",
            "error": f"{100 * run.rel_rmse:.3g} % in {run.render_seconds:.3g} s" if run.rel_rmse else
                     f"below the reference's noise, {run.render_seconds:.3g} s",
            "png": study_charts.picture_png(mean, exposure), "map": study_charts.error_map_png(mean, reference.mean)})
    return pictures, exposure


def page(title, runs, summaries, reference, notes):
    """The page's text. `notes`: what was skipped or failed."""
    pictures, exposure = _pictures(runs, reference)
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(FOLDER), autoescape=True, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)
    template = environment.get_template("study_page.html.jinja")
    first = runs[0].stats
    return template.render(
        title=title, device=first["device"], version=first["version"], width=first["width"], height=first["height"],
        triangles=first.get("triangles"), cores=os.cpu_count(), reference=reference, notes=notes, pictures=pictures,
        exposure=exposure, summaries=summaries, runs=runs, error_chart=study_charts.error_chart(summaries),
        efficiency_chart=study_charts.efficiency_chart(summaries), stages_chart=study_charts.stages_chart(runs),
        scale=study_charts.scale_svg(), small=SMALL_SQUARE)
