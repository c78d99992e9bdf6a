# SPDX-License-Identifier: Apache-2.0
"""Draws where two pictures differ: pixel by pixel, and tile by tile in standard errors."""
import os
import tempfile

import numpy

# Rec. 709 luminance.
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])
# Part of the pixels that may exceed the scale where none is given.
BEYOND_SCALE = 0.01
SIGNED, ERROR = "signed", "error"


def _save(figure, path):
    """Under a temporary name first: a failed drawing leaves nothing behind."""
    folder, name = os.path.split(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(suffix=os.path.splitext(name)[1] or ".png", dir=folder)
    os.close(handle)
    try:
        figure.savefig(temporary, dpi=100)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def pixel_values(a, b, kind):
    """The values of the left drawing: luminance of a - b, or relative error of all channels."""
    if kind == SIGNED:
        return (a.mean - b.mean) @ LUMINANCE
    return (numpy.abs(a.mean - b.mean) / (numpy.abs(b.mean) + 0.01)).mean(axis=-1)


def pixel_scale(values):
    """A scale that all but BEYOND_SCALE of the finite pixels keep within."""
    finite = numpy.abs(values[numpy.isfinite(values)])
    largest = float(numpy.quantile(finite, 1 - BEYOND_SCALE)) if finite.size else 0.0
    return largest or (float(finite.max()) if finite.size else 0.0) or 1.0


def draw_difference(a, b, verdict, path, kind=SIGNED, scale=None):
    """Writes the drawing; the extension of `path` decides its format."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    values = pixel_values(a, b, kind)
    scale = scale or pixel_scale(values)
    window = a.window
    x0, y0, x1, y1 = window.x, window.y, window.x + window.width, window.y + window.height
    aspect = window.height / window.width
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(14, min(max(5.2 * aspect, 2.2), 12) + 1.6), layout="constrained")
    signed = kind == SIGNED
    image = left.imshow(values, extent=(x0, x1, y1, y0), interpolation="nearest",
                        cmap="RdBu_r" if signed else "viridis", vmin=-scale if signed else 0, vmax=scale)
    left.set_title("a - b, luminance (red: a is brighter)" if signed else "|a - b| / (|b| + 0.01), mean of channels")
    figure.colorbar(image, ax=left, extend="both" if signed else "max", shrink=0.8,
                    label=("decoded value" if a.encoding or b.encoding else "radiance") if signed else "relative error")
    _draw_tiles(figure, right, window, verdict, (x0, x1, y1, y0))
    for axes in (left, right):
        axes.set_xlabel("x, pixels")
        axes.set_ylabel("y, pixels")
    a_name, b_name = (" + ".join(os.path.basename(part) for part in p.path.split(" + ")) for p in (a, b))
    figure.suptitle(f"a = {a_name}    b = {b_name}    verdict: {verdict.name}")
    _save(figure, path)
    pyplot.close(figure)


def _tile_values(verdict):
    """What the tiles show, of the channel where it is largest, its unit, and the largest value of the colours: differences in
    standard errors, or in margins where there is no noise to measure them by."""
    tiles = verdict.tiles
    by_margin = not (tiles.error > 0).any()
    unit = tiles.margin if by_margin else tiles.error
    values = numpy.divide(tiles.difference, unit, out=numpy.zeros_like(unit), where=(unit > 0) & numpy.isfinite(unit))
    worst = numpy.argmax(numpy.abs(values), axis=-1)[..., None]
    shown = numpy.take_along_axis(values, worst, -1)[..., 0]
    return (shown, "margins", 2.0) if by_margin else (shown, "standard errors", 6.0)


def _draw_tiles(figure, axes, window, verdict, extent):
    """Tile means; rejected ones have a frame."""
    from matplotlib.patches import Rectangle
    size = verdict.tile_size
    shown, unit, limit = _tile_values(verdict)
    grid = numpy.repeat(numpy.repeat(shown, size, 0), size, 1)[:window.height, :window.width]
    image = axes.imshow(grid, extent=extent, interpolation="nearest", cmap="RdBu_r", vmin=-limit, vmax=limit)
    rejected = verdict.rejected_tiles
    for row, column in zip(*numpy.nonzero(rejected)):
        x, y = window.x + column * size, window.y + row * size
        axes.add_patch(Rectangle((x, y), min(size, extent[1] - x), min(size, extent[2] - y), fill=False, edgecolor="black",
                                 linewidth=1.5))
    tested = f" (frame: rejected, {int(rejected.sum())} of {rejected.size})" if verdict.noise_known else ""
    axes.set_title("tile means, channel that differs most" + tested, fontsize=11)
    figure.colorbar(image, ax=axes, extend="both", shrink=0.8, label=unit)
