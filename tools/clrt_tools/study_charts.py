# SPDX-License-Identifier: Apache-2.0
"""The curves and bars of a study, as SVG text to put into the page."""
import dataclasses
import io
import re
import textwrap

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402 (needs the backend above)

from clrt_tools.study_methods import Method  # noqa: E402

# Okabe and Ito's colours, which people who see fewer colours tell apart as well.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31"]
# Drawn in this colour, which nothing else has, is what takes the colour of the page's text, dark or light.
INK = "#010203"
SAMPLER_STYLES = {"sobol": ("-", "o"), "independent": ("--", "s")}
RIVAL_STYLE = (INK, "-.", "D")
# Letters of a line beside a row, and in a legend of two columns.
ROW_LETTERS, LEGEND_LETTERS = 22, 30
# The two errors of a gain: words, colour, marker, and place beside the middle of its row.
ERRORS = (("squared error", COLOURS[0], "o", -0.13), ("relative squared error", COLOURS[1], "D", 0.13))
# How far a bar reaches, as a factor, where an end of its interval is not known.
UNKNOWN = 10
STAGES = [("load", "load scene"), ("bvh", "build tree"), ("compile", "compile"), ("first_launch", "first launch"),
          ("pilots", "pilots"), ("render", "render")]
STAGE_COLOURS = ["#56b4e9", "#009e73", "#e69f00", "#cc79a7", "#f0e442", "#0072b2"]
# Inches of a drawing: narrow, so that its letters can still be read at the width of a telephone.
WIDTH = 7.0
matplotlib.rcParams.update({"svg.hashsalt": "clrt", "font.size": 12, "axes.grid": True, "grid.alpha": 0.35, "grid.color": "#888888",
                            "axes.axisbelow": True, "figure.facecolor": "none", "axes.facecolor": "none",
                            **{f"{name}color": INK for name in ("text.", "axes.edge", "axes.label", "xtick.", "ytick.")}})


def svg(figure):
    """An SVG element for HTML: without XML declaration, metadata and names of namespaces, which HTML does not need."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    pyplot.close(figure)
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg"):], flags=re.DOTALL)
    text = re.sub(r'\sxmlns(:\w+)?="[^"]*"', "", text).replace(INK, "currentColor")
    return re.sub(r'width="[^"]*pt" height="[^"]*pt"|height="[^"]*pt" width="[^"]*pt"', "", text, count=1)


def _styles(methods):
    """A line and a marker for the sampler, a colour for all else; other renderers look like nothing of clrt's."""
    def kind(method):
        return dataclasses.replace(method, sampler=None)

    own = [method for method in methods if isinstance(method, Method)]
    kinds = list(dict.fromkeys(map(kind, own)))
    return {**{m: (COLOURS[kinds.index(kind(m)) % len(COLOURS)], *SAMPLER_STYLES.get(m.sampler, (":", "^"))) for m in own},
            **{rival: RIVAL_STYLE for rival in methods if rival not in own}}


def _plain(axis):
    """0.5 and 20 instead of powers of ten."""
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def error_chart(summaries, labels):
    """Error against seconds, log-log, with the range of the repeats and guides of slope -1/2. `labels`: {method: words}."""
    figure, axes = pyplot.subplots(figsize=(WIDTH, 5 + 0.13 * len(summaries)), layout="constrained")
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
                      marker=style[2], markersize=5, capsize=3, linewidth=1.6, elinewidth=0.9,
                      label=textwrap.fill(labels[method], LEGEND_LETTERS))
    axes.set_xscale("log")
    axes.set_yscale("log")
    if points:
        _draw_guides(axes, points)
    axes.set_xlabel("render, seconds (wall clock)")
    axes.set_ylabel("error, % (RMSE / mean)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        _plain(axis)
    axes.legend(loc="upper left", bbox_to_anchor=(-0.1, -0.13), ncols=2, fontsize=11, frameon=False, handlelength=3)
    return svg(figure)


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


def gains_chart(gains):
    """What each change buys: accuracy a second over the default's, by both errors. `gains`: {words: (Interval or None of the
    squared error, likewise of the relative squared error)}."""
    figure, axes = pyplot.subplots(figsize=(WIDTH, 1.5 + 0.5 * len(gains)), layout="constrained")
    axes.axvline(1, color=INK, linewidth=1)
    for which, (label, colour, marker, shift) in enumerate(ERRORS):
        known = [(row + shift, pair[which]) for row, pair in enumerate(gains.values()) if pair[which]]
        values = numpy.array([gain.value for _, gain in known])
        ends = numpy.array([(max(gain.low, gain.value / UNKNOWN), min(gain.high, gain.value * UNKNOWN)) for _, gain in known])
        axes.errorbar(values, [row for row, _ in known], xerr=abs(ends.reshape(-1, 2).T - values), fmt=marker, color=colour,
                      markersize=6, capsize=3, linewidth=1.6, label=label)
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.5), max(high, 2))
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    _plain(axes.xaxis)
    axes.set_yticks(range(len(gains)), [textwrap.fill(words, ROW_LETTERS) for words in gains])
    axes.set_ylim(len(gains) - 0.5, -0.5)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("accuracy a second over the default's")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=11, frameon=False)
    return svg(figure)


def stages_chart(rows, labels):
    """Where the seconds go. `rows`: {method: (samples a pixel, seconds of each stage)}; `labels`: {method: words}."""
    figure, axes = pyplot.subplots(figsize=(WIDTH, 1.7 + 0.42 * max(len(rows), 1)), layout="constrained")
    left = numpy.zeros(len(rows))
    for (stage, label), colour in zip(STAGES, STAGE_COLOURS):
        widths = numpy.array([seconds.get(stage, 0) for _, seconds in rows.values()])
        axes.barh(range(len(rows)), widths, left=left, color=colour, height=0.7, label=label)
        left += widths
    for row, total in enumerate(left):
        axes.annotate(f" {total:.2f} s", (total, row), va="center")
    axes.set_yticks(range(len(rows)), [f"{labels[method]}\n{spp} spp" for method, (spp, _) in rows.items()], fontsize=10)
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("seconds (wall clock); compile without any cache")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, fontsize=10, frameon=False)
    return svg(figure)
