# SPDX-License-Identifier: Apache-2.0
"""Numbers for how far a picture a lies from a picture b. The same name hides different constants in different tools, so every
metric carries its formula."""
import dataclasses
from typing import Optional

import numpy

# Keeps dark pixels from ruling MAPE and SMAPE: radiance.
SMALL_RADIANCE = 0.01
# Part of a picture's mean that keeps dark pixels from ruling its relative squared error: the eye adapts to the whole, and a
# picture twice as bright has the same error.
DARK_SHARE = 0.1
RELATIVE_MSE_FORMULA = f"mean (a-b)^2 / (b^2 + ({DARK_SHARE} mean b)^2)"


@dataclasses.dataclass
class Metric:
    """One number; `value` is None where it could not be computed, and `remark` says why."""
    name: str
    formula: str
    value: Optional[float]
    remark: str = ""


def relative_weight(b):
    """What makes a squared difference from b a relative one: 1 / (b^2 + (DARK_SHARE mean b)^2); ones of a black b."""
    scale = b ** 2 + (DARK_SHARE * b.mean()) ** 2
    return 1 / numpy.where(scale > 0, scale, 1)


def relative_mse(a, b):
    """RELATIVE_MSE_FORMULA, over pixels and channels."""
    return float(numpy.mean((a - b) ** 2 * relative_weight(b)))


def all_metrics(a, b, radiance=True):
    """Metrics of the finite pixels (height, width, 3) of a against b. `radiance`: both are; else there is no HDR-FLIP."""
    finite = numpy.isfinite(a).all(axis=-1) & numpy.isfinite(b).all(axis=-1)
    if radiance and finite.all():
        flip = _flip(a, b)
    else:
        flip = Metric("FLIP", "HDR-FLIP", None, "not for non-finite pixels" if radiance else "needs radiance")
    a, b = a[finite], b[finite]
    if a.size == 0:
        return []
    difference, mean_b = a - b, b.mean()
    distance = numpy.abs(difference)
    rmse = float(numpy.sqrt(numpy.mean(difference ** 2)))
    relative = [Metric("rel. RMSE", "RMSE / mean b", rmse / mean_b),
                Metric("bias", "mean a / mean b - 1", float(a.mean() / mean_b - 1))] if mean_b > 0 else [
                    Metric("rel. RMSE", "RMSE / mean b", None, "b is black"),
                    Metric("bias", "mean a / mean b - 1", None, "b is black")]
    return [
        Metric("RMSE", "sqrt(mean (a-b)^2)", rmse),
        relative[0],
        Metric("relMSE", RELATIVE_MSE_FORMULA, relative_mse(a, b)),
        Metric("MAPE", f"mean |a-b| / (|b| + {SMALL_RADIANCE})",
               float(numpy.mean(distance / (numpy.abs(b) + SMALL_RADIANCE)))),
        Metric("SMAPE", f"mean 2|a-b| / (|a| + |b| + {SMALL_RADIANCE})",
               float(numpy.mean(2 * distance / (numpy.abs(a) + numpy.abs(b) + SMALL_RADIANCE)))),
        relative[1],
        flip,
    ]


def noise_rmse(variances):
    """The RMSE that noise alone would give; None where a variance is not known."""
    if any(variance is None for variance in variances):
        return None
    return float(numpy.sqrt(sum(numpy.nanmean(variance) for variance in variances)))


def squared_error_without_noise(x, half_a, half_b):
    """mean (x - half_a)(x - half_b): the mean squared error of x, free of the reference's own noise."""
    return float(numpy.mean((x - half_a) * (x - half_b)))


def _flip(a, b):
    formula = "HDR-FLIP, mean over pixels, 67 pixels a degree"
    try:
        import flip_evaluator
    except ImportError:
        return Metric("FLIP", formula, None, "needs the Python package flip-evaluator")
    try:
        reference, test = (numpy.maximum(p, 0).astype(numpy.float32) for p in (b, a))
        return Metric("FLIP", formula, float(flip_evaluator.evaluate(reference, test, "HDR")[1]))
    except Exception as error:  # a foreign library's failure must not hide the other numbers
        return Metric("FLIP", formula, None, f"flip-evaluator failed: {error}")
