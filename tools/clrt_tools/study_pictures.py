# SPDX-License-Identifier: Apache-2.0
"""The pictures of a study for its page: renders at one exposure, and their differences from the reference in one scale."""
import base64
import io

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import image, pyplot  # noqa: E402 (needs the backend above)

from clrt_tools.difference_picture import LUMINANCE  # noqa: E402
from clrt_tools.study_charts import WIDTH, svg  # noqa: E402

# Pixels above which a picture is stored as JPEG: noise makes PNG files of megabytes.
PNG_PIXELS = 200_000
JPEG_QUALITY = 92
# Part of the mean below which a pixel counts as black when the exposure is chosen.
BLACK = 0.01
DIFFERENCE_COLOURS = "RdBu_r"
# Largest values of the differences' colours, in parts of the reference's mean, and the part of the default's pixels that lies
# within.
SCALES = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
WITHIN_SCALE = 0.98


def _data_uri(values, **options):
    """(height, width, 3) in 0..1, or (height, width) with a colour map, as an address that holds the file itself."""
    kind = "png" if values.shape[0] * values.shape[1] <= PNG_PIXELS else "jpeg"
    if kind == "jpeg":
        options["pil_kwargs"] = {"quality": JPEG_QUALITY, "subsampling": 0}
    buffer = io.BytesIO()
    image.imsave(buffer, values, format=kind, **options)
    return f"data:image/{kind};base64," + base64.b64encode(buffer.getvalue()).decode()


def picture_uri(mean, exposure):
    """8-bit sRGB of radiance times 2^exposure; not finite values in magenta."""
    bad = ~numpy.isfinite(mean).all(axis=-1)
    x = numpy.clip(numpy.nan_to_num(mean * 2.0 ** exposure), 0, 1)
    values = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    values[bad] = (1, 0, 1)
    return _data_uri(values)


def exposure_for(mean):
    """Half stops that put the typical pixel near a fifth of white: the median of those that are not black beside the mean, which a
    window or a lamp does not move."""
    luminance = numpy.nan_to_num(mean @ LUMINANCE)
    seen = luminance[luminance > BLACK * luminance.mean()]
    return round(2 * numpy.log2(0.2 / float(numpy.median(seen)))) / 2 if seen.size and numpy.median(seen) > 0 else 0.0


def difference(mean, reference):
    """Luminance of the difference from the reference, in parts of the reference's mean: its root mean square is about the
    picture's error."""
    return numpy.nan_to_num((mean - reference) @ LUMINANCE) / max(float(reference.mean()), 1e-30)


def scale_for(values):
    """The smallest of SCALES that WITHIN_SCALE of the pixels keep within."""
    largest = float(numpy.quantile(numpy.abs(values), WITHIN_SCALE))
    return next((scale for scale in SCALES if scale >= largest), SCALES[-1])


def difference_uri(values, scale):
    """In false colours from -scale to scale."""
    return _data_uri(values, cmap=DIFFERENCE_COLOURS, vmin=-scale, vmax=scale)


def scale_svg(scale):
    """The colours of the differences."""
    figure, axes = pyplot.subplots(figsize=(WIDTH, 0.8), layout="constrained")
    mappable = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(-100 * scale, 100 * scale), DIFFERENCE_COLOURS)
    figure.colorbar(mappable, cax=axes, orientation="horizontal", extend="both",
                    label="render - reference, luminance, % of the reference's mean")
    return svg(figure)
