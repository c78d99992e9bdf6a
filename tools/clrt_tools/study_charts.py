# SPDX-License-Identifier: Apache-2.0
"""The drawings of a study, as SVG text and PNG bytes to put into the page."""
import base64
import io
import re

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402 (needs the backend above)

from clrt_tools.metrics import SMALL_RADIANCE  # noqa: E402

# Okabe and Ito's colours, which people who see fewer colours tell apart as well.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]
SAMPLER_STYLES = {"sobol": ("-", "o"), "independent": ("--", "s")}
STAGES = [("load", "load scene"), ("bvh", "build tree"), ("compile", "compile"), ("first_launch", "first launch"),
          ("render", "render")]
STAGE_COLOURS = ["#56b4e9", "#009e73", "#e69f00", "#cc79a7", "#0072b2"]
# Relative error at the top of the error maps' colours.
MAP_SCALE = 0.5
matplotlib.rcParams.update({"svg.hashsalt": "clrt", "font.size": 11, "axes.grid": True, "grid.alpha": 0.35,
                            "axes.axisbelow": True})


def _svg(figure):
    """An SVG element for HTML: without XML declaration, metadata and names of namespaces, which HTML does not need."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    pyplot.close(figure)
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg"):], flags=re.DOTALL)
    text = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", text)
    return re.sub(r'width="[^"]*pt" height="[^"]*pt"|height="[^"]*pt" width="[^"]*pt"', "", text, count=1)


def _styles(methods):
    """A colour for integrator and precision, a line and a marker for the sampler."""
    kinds = list(dict.fromkeys((m.integrator, m.precision) for m in methods))
    return {m: (COLOURS[kinds.index((m.integrator, m.precision)) % len(COLOURS)],
                *SAMPLER_STYLES.get(m.sampler, (":", "^"))) for m in methods}


def _plain(axis):
    """0.5 and 20 instead of powers of ten."""
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def error_chart(summaries):
    """Error against seconds, log-log, with the range of the repeats and guides of slope -1/2."""
    figure, axes = pyplot.subplots(figsize=(10, 5.2), layout="constrained")
    points = []
    for method, style in _styles(summaries).items():
        known = [s for s in summaries[method] if s.error]
        if not known:
            continue
        seconds, errors = [s.seconds for s in known], [100 * s.error for s in known]
        points += list(zip(seconds, errors))
        y_range = [[e - 100 * s.low for e, s in zip(errors, known)], [100 * s.high - e for e, s in zip(errors, known)]]
        x_range = [[s.seconds - s.seconds_low for s in known], [s.seconds_high - s.seconds for s in known]]
        axes.errorbar(seconds, errors, yerr=numpy.maximum(y_range, 0), xerr=x_range, color=style[0], linestyle=style[1],
                      marker=style[2], markersize=5, capsize=3, linewidth=1.6, elinewidth=0.9, label=str(method))
    axes.set_xscale("log")
    axes.set_yscale("log")
    if points:
        _draw_guides(axes, points)
    axes.set_xlabel("render, seconds (wall clock)")
    axes.set_ylabel("error, % (RMSE / mean)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        _plain(axis)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=10, frameon=False,
                handlelength=3.5)
    return _svg(figure)


def _draw_guides(axes, points):
    """Lines along which twice the time gives the error over sqrt(2)."""
    x0, x1 = axes.get_xlim()
    y0, y1 = axes.get_ylim()
    x = numpy.array([x0, x1])
    centre = numpy.exp(numpy.mean(numpy.log(points), axis=0))
    for step in range(-12, 13):
        axes.plot(x, centre[1] * 2.0 ** step * numpy.sqrt(centre[0] / x), color="#777777", linewidth=0.9, linestyle=":", zorder=0,
                  label="slope -1/2" if step == 0 else None)
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)


def efficiency_chart(summaries):
    """1 / (error^2 x seconds) of each method at its most samples."""
    rows = [(method, known[-1]) for method, known in (
        (method, [s for s in points if s.efficiency]) for method, points in summaries.items()) if known]
    figure, axes = pyplot.subplots(figsize=(10, 0.9 + 0.42 * max(len(rows), 1)), layout="constrained")
    styles = _styles(summaries)
    for row, (method, summary) in enumerate(rows):
        axes.barh(row, summary.efficiency, color=styles[method][0], height=0.7,
                  alpha=1 if method.sampler == "sobol" else 0.5)
        axes.annotate(f" {summary.efficiency:.3g}", (summary.efficiency, row), va="center")
    axes.set_yticks(range(len(rows)), [f"{method}, {summary.spp} spp" for method, summary in rows])
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("efficiency: 1 / ((RMSE / mean)² x render seconds), 1/s; longer is better")
    return _svg(figure)


def stage_seconds(runs):
    """{method: seconds of each stage}: compile and first launch of its cold run, the rest of a run with most samples."""
    result = {}
    for method in dict.fromkeys(run.point.method for run in runs):
        own = [run for run in runs if run.point.method == method]
        longest = max(own, key=lambda run: run.point.spp)
        cold = next((run for run in own if run.point.cold), longest)
        seconds = dict(longest.stats["seconds"])
        for stage in ("compile", "first_launch"):
            seconds[stage] = cold.stats["seconds"][stage]
        result[method] = (longest.point.spp, seconds)
    return result


def stages_chart(runs):
    """Where the seconds go."""
    rows = stage_seconds(runs)
    figure, axes = pyplot.subplots(figsize=(10, 1.5 + 0.42 * max(len(rows), 1)), layout="constrained")
    left = numpy.zeros(len(rows))
    for (stage, label), colour in zip(STAGES, STAGE_COLOURS):
        widths = numpy.array([seconds[stage] for _, seconds in rows.values()])
        axes.barh(range(len(rows)), widths, left=left, color=colour, height=0.7, label=label)
        left += widths
    for row, total in enumerate(left):
        axes.annotate(f" {total:.2f} s", (total, row), va="center")
    axes.set_yticks(range(len(rows)), [f"{method}, {spp} spp" for method, (spp, _) in rows.items()])
    axes.invert_yaxis()
    axes.margins(x=0.1)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("seconds (wall clock); compile without any cache")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(STAGES), fontsize=10, frameon=False)
    return _svg(figure)


def _png(values, **options):
    buffer = io.BytesIO()
    matplotlib.image.imsave(buffer, values, format="png", **options)
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()


def picture_png(mean, exposure):
    """8-bit sRGB of radiance times 2^exposure; not finite values in magenta."""
    bad = ~numpy.isfinite(mean).all(axis=-1)
    x = numpy.clip(numpy.nan_to_num(mean * 2.0 ** exposure), 0, 1)
    values = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    values[bad] = (1, 0, 1)
    return _png(values)


def exposure_for(mean):
    """Half stops that put the picture's mean near a fifth of white."""
    level = float(numpy.nanmean(mean))
    return round(2 * numpy.log2(0.2 / level)) / 2 if level > 0 else 0.0


def error_map_png(mean, reference):
    """|x - r| / (r + small), mean of channels, in false colours up to MAP_SCALE."""
    error = (numpy.abs(mean - reference) / (numpy.abs(reference) + SMALL_RADIANCE)).mean(axis=-1)
    return _png(numpy.nan_to_num(error, nan=MAP_SCALE), cmap="viridis", vmin=0, vmax=MAP_SCALE)


def scale_svg():
    """The colours of the error maps."""
    figure, axes = pyplot.subplots(figsize=(6, 0.75), layout="constrained")
    mappable = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, 100 * MAP_SCALE), "viridis")
    figure.colorbar(mappable, cax=axes, orientation="horizontal", extend="max",
                    label=f"|x - r| / (r + {SMALL_RADIANCE}), mean of channels, %")
    return _svg(figure)
