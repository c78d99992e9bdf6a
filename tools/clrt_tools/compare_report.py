# SPDX-License-Identifier: Apache-2.0
"""The result of a comparison as text and as JSON."""
import math
from fractions import Fraction

import numpy

from clrt_tools import verdict as verdicts

CHANNELS = "RGB"
# Half width of a 95 % interval of a normal variable, in standard deviations.
NORMAL_95 = 1.96
# A margin so many times the smallest that passes tells less than the pictures do.
WIDE_MARGIN = 4
AS_PERCENT = ("rel. RMSE", "bias")


def _number(value):
    return f"{value:.4g}" if abs(value) >= 1e-3 or value == 0 else f"{value:.3e}"


def _two_digits(value):
    """An estimate without digits it does not have, and without an exponent."""
    return f"{float(f'{value:.2g}'):,.0f}" if 10 <= value < 1e9 else f"{value:.2g}"


def picture_line(label, picture):
    """What a file holds."""
    facts = [str(picture.window)] + ([picture.encoding] if picture.encoding else [])
    if picture.samples:
        facts.append(f"{picture.samples} spp")
    if picture.seed:
        facts.append(f"seed {picture.seed}")
    return f"{label}  {picture.path}: {', '.join(facts)}; noise: {picture.noise}"


def display_lines(pictures):
    """What numbers of files made to be looked at cannot tell; nothing where there are none."""
    if not any(picture.encoding for picture in pictures):
        return []
    return ["note  8- and 16-bit files carry clipping, exposure and tone curve, and are quantised: the numbers are of their values",
            "      decoded as sRGB, not of radiance; compare EXR or film files for those"]


def metric_lines(metrics, noise, half_error):
    """A table of numbers with their formulas."""
    width = max(len(metric.formula) for metric in metrics)
    lines = []
    for metric in metrics:
        value = metric.remark
        if metric.value is not None:
            value = f"{100 * metric.value:.4g} %" if metric.name in AS_PERCENT else _number(metric.value)
        if metric.name == "RMSE" and noise is not None:
            value += f"   (noise alone gives {_number(noise)})"
        lines.append(f"  {metric.name:<10} {metric.formula:<{width}}  {value}")
    if half_error is not None:
        root = _number(math.sqrt(half_error)) if half_error > 0 else "0 (below the noise)"
        lines.append(f"  {'RMSE':<10} {'sqrt(mean (a-b1)(a-b2)), halves b1, b2':<{width}}  {root}")
    return lines


def worst_tile(family, values, tile_size, window):
    """The tile and channel where `values` is largest, in words."""
    row, column, channel = index = numpy.unravel_index(int(numpy.nanargmax(values)), values.shape)
    x, y = window.x + column * tile_size, window.y + row * tile_size
    x1, y1 = (min(x + tile_size, window.x + window.width) - 1, min(y + tile_size, window.y + window.height) - 1)
    return (f"x {x}-{x1}, y {y}-{y1}, {CHANNELS[channel]} ({family.difference[index]:+.3g} +- "
            f"{NORMAL_95 * family.error[index]:.2g})")


def test_lines(verdict, window):
    """What was tested, and where it came closest to failing."""
    tiles, whole, size = verdict.tiles, verdict.whole, verdict.tile_size
    rows, columns, channels = tiles.difference.shape
    welch = "Welch's t with Holm's correction, " if verdict.noise_known else ""
    lines = [f"tests     {rows * columns} tiles of {size}x{size} pixels and the whole picture, {channels} channels; "
             f"{welch}TOST at {100 * verdict.alpha:g} %",
             f"margin    {100 * verdict.margin:g} % of a tile's mean + "
             f"{100 * verdict.margin * verdicts.PICTURE_PART:g} % of the picture's mean"]
    for channel in range(channels):
        lines.append(f"  whole {CHANNELS[channel]}   a - b = {whole.difference[0, 0, channel]:+.4g} +- "
                     f"{NORMAL_95 * whole.error[0, 0, channel]:.2g} (95 %), margin {whole.margin[0, 0, channel]:.2g}")
    if verdict.noise_known:
        where = worst_tile(tiles, 1 - tiles.adjusted_p, size, window)
        lines.append(f"  smallest p, corrected  {verdict.smallest_p:.3g}; of the tiles at {where}")
    where = worst_tile(tiles, tiles.within, size, window)
    lines.append(f"  equivalent within      {100 * verdict.within:.3g} % (the smallest margin that all pass); worst tile {where}")
    return lines


def verdict_line(verdict):
    """One line; the first word is the verdict."""
    name = f"{verdict.name} within {100 * verdict.margin:g} %" if verdict.name == verdicts.EQUIVALENT else verdict.name
    line = f"verdict   {name}: {verdict.reason}"
    if verdict.needs is not None:
        line += (f"; 'equivalent' needs about {_two_digits(verdict.needs)} times the samples of both pictures where the error "
                 "falls with their square root, fewer where it falls faster")
    return line


def _percent_above(value):
    """The next decimal number of two digits above a fraction, in percent: a margin at which it passes."""
    percent = 100 * value
    unit = Fraction(10) ** (math.floor(math.log10(percent)) - 1)
    return f"{float(math.ceil(Fraction(percent) / unit) * unit):g}%"


def margin_line(verdict):
    """The margin that would decide, or that an equivalence needs not have been so wide for; nothing where none would."""
    if not verdict.margin_decides or not 0 < verdict.within < 1:
        return []
    smallest = _percent_above(verdict.within)
    if verdict.name != verdicts.EQUIVALENT:
        return [f"hint      the smallest margin that would make them equivalent is --margin {smallest}"]
    if verdict.within * WIDE_MARGIN <= verdict.margin:
        return [f"hint      the margin is wide: they pass down to --margin {smallest}"]
    return []


def _optional(value):
    """JSON has no infinity."""
    return None if value is None or not math.isfinite(value) else float(value)


def as_json(pictures, metrics, noise, half_error, verdict):
    """Everything for machines, in the units of the pictures."""
    def picture_json(picture):
        window = picture.window
        return {"path": picture.path, "x": window.x, "y": window.y, "width": window.width, "height": window.height,
                "samples": picture.samples, "seed": picture.seed, "noise": picture.noise, "encoding": picture.encoding}

    tiles = verdict.tiles
    return {
        "a": picture_json(pictures[0]), "b": picture_json(pictures[1]),
        "metrics": [{"name": m.name, "formula": m.formula, "value": _optional(m.value)} for m in metrics],
        "noise_rmse": _optional(noise), "mse_without_reference_noise": _optional(half_error),
        "verdict": verdict.name, "reason": verdict.reason, "needs_times_samples": _optional(verdict.needs),
        "alpha": verdict.alpha, "margin": verdict.margin, "smallest_p": _optional(verdict.smallest_p if verdict.noise_known else None),
        "equivalent_within": _optional(verdict.within), "tile_size": verdict.tile_size,
        "tiles": list(tiles.difference.shape[:2]),
        "rejected_tiles": int(verdict.rejected_tiles.sum()) if verdict.noise_known else None,
        "outside_margin_tiles": int((tiles.within.max(axis=-1) > verdict.margin).sum()),
        "whole": {"difference": [_optional(v) for v in verdict.whole.difference.ravel()],
                  "standard_error": [_optional(v) for v in verdict.whole.error.ravel()]},
    }
