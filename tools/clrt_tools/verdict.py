# SPDX-License-Identifier: Apache-2.0
"""Do two pictures show the same expected radiance? Two tests, tile by tile and channel by channel:

- Welch's t-test (Welch 1947; for rendering: Jung, Hanika and Dachsbacher, JCGT 9(2) 2020) rejects equality. Half of the
  level goes to the mean of the whole picture, half to the tiles, each with Holm's step-down correction (Holm 1979), so
  that pictures of equal expectation are called different in at most `alpha` of all comparisons.
- Two one-sided tests (TOST; Schuirmann 1987) show equivalence: every tile's difference with its one-sided bound lies
  within the margin. All of them must pass, so no correction is needed (Berger 1982).

A difference that is certain but smaller than the margin counts as equivalent; neither shown is undecided.
"""
import dataclasses
from typing import Optional

import numpy
from scipy.special import betainc, ndtri, stdtrit

DIFFERENT, EQUIVALENT, UNDECIDED = "different", "equivalent", "undecided"

# The margin of a tile is relative to its own mean, plus this part of it relative to the mean of the whole picture, without which
# black tiles would ask for infinitely many samples.
PICTURE_PART = 0.2
# Probability of the verdict 'equivalent', for equal pictures, that the number of samples asked for should give.
POWER = 0.8
# Largest relative rounding error of a channel in a file of 32-bit floats.
FLOAT_ROUNDING = 2.0 ** -24


@dataclasses.dataclass
class Estimate:
    """Tile means (rows, columns, 3), the variances of these means and their degrees of freedom; None: not known."""
    mean: numpy.ndarray
    variance: Optional[numpy.ndarray] = None
    degrees: Optional[numpy.ndarray] = None


@dataclasses.dataclass
class Comparison:
    """Tests of every tile (rows, columns, 3)."""
    difference: numpy.ndarray  # of the tile means
    error: numpy.ndarray       # standard error of the difference
    adjusted_p: numpy.ndarray  # Holm within this family
    margin: numpy.ndarray
    within: numpy.ndarray      # the smallest margin that would show equivalence
    factor: numpy.ndarray      # samples needed, over those taken


@dataclasses.dataclass
class Verdict:
    name: str
    reason: str
    tiles: Comparison
    whole: Comparison
    tile_size: int
    alpha: float
    margin: float
    within: float = float("inf")   # the smallest margin that would show equivalence
    needs: Optional[float] = None  # times the samples, where undecided
    noise_known: bool = True       # of both pictures; else p-values say nothing
    margin_decides: bool = True    # a margin of `within` gives the verdict 'equivalent'

    @property
    def rejected_tiles(self):
        """Tiles (rows, columns) in which equality is rejected for some channel."""
        return (2 * self.tiles.adjusted_p.min(axis=-1) <= self.alpha) & self.noise_known

    @property
    def smallest_p(self):
        """Of all tests, adjusted for all of them."""
        return min(1.0, 2 * float(min(self.tiles.adjusted_p.min(), self.whole.adjusted_p.min())))


def tile_sums(values, size):
    """Sums over tiles of size x size pixels; those at the right and bottom edge may be smaller."""
    rows = numpy.arange(0, values.shape[0], size)
    columns = numpy.arange(0, values.shape[1], size)
    return numpy.add.reduceat(numpy.add.reduceat(values, rows, axis=0), columns, axis=1)


def tile_estimate(picture, size):
    """Tile means of a picture with their variances: from the spread of its replicates' tile means where it has replicates, which
    holds for correlated pixels too, else from the pixels' variances, taken as independent."""
    pixels = tile_sums(numpy.ones(picture.mean.shape[:2] + (1,)), size)
    mean = tile_sums(picture.mean, size) / pixels
    if picture.replicates is not None:
        means = numpy.array([tile_sums(replicate, size) / pixels for replicate in picture.replicates])
        count = len(means)
        return Estimate(mean, means.var(axis=0, ddof=1) / count, numpy.full(mean.shape, count - 1.0))
    if picture.variance is None:
        return Estimate(mean)
    # Satterthwaite 1946: nu = (sum v)^2 / sum(v^2 / nu_pixel); for normal samples v^2 (nu + 2) / nu is what the
    # square of an estimate with nu degrees of freedom has on average.
    total = tile_sums(picture.variance, size)
    squares = tile_sums(picture.variance ** 2, size)
    with numpy.errstate(invalid="ignore", divide="ignore"):
        degrees = numpy.where(squares > 0, total ** 2 * (picture.degrees + 2) / squares, 1.0)
    return Estimate(mean, total / pixels ** 2, degrees)


def holm(p_values):
    """Holm's adjusted p-values, in the shape given."""
    flat = p_values.ravel()
    order = numpy.argsort(flat)
    steps = numpy.maximum.accumulate(flat[order] * (flat.size - numpy.arange(flat.size)))
    adjusted = numpy.empty_like(flat)
    adjusted[order] = numpy.minimum(steps, 1)
    return adjusted.reshape(p_values.shape)


def two_sided_p(t, degrees):
    """P(|T| > |t|) of Student's t distribution."""
    return betainc(0.5 * degrees, 0.5, degrees / (degrees + t * t))


def compare_tiles(a, b, picture_mean, alpha, margin):
    """All tests of one family of tiles. `picture_mean`: of b, per channel. A variance that is not known counts as none."""
    zero, one = numpy.zeros_like(a.mean), numpy.ones_like(a.mean)
    variance_a, degrees_a = (zero, one) if a.variance is None else (a.variance, a.degrees)
    variance_b, degrees_b = (zero, one) if b.variance is None else (b.variance, b.degrees)
    difference, variance = a.mean - b.mean, variance_a + variance_b
    error = numpy.sqrt(variance)
    # Rounding in the files is no difference.
    rounding = FLOAT_ROUNDING * (numpy.abs(a.mean) + numpy.abs(b.mean))
    with numpy.errstate(invalid="ignore", divide="ignore"):
        degrees = variance ** 2 / (variance_a ** 2 / degrees_a + variance_b ** 2 / degrees_b)
        degrees = numpy.where(variance > 0, degrees, 1.0)
        p = numpy.where(error > 0, two_sided_p(difference / error, degrees), 0.0)
    p = numpy.where(numpy.abs(difference) <= rounding, 1.0, p)
    scale = numpy.abs(b.mean) + PICTURE_PART * numpy.abs(picture_mean)
    bound = margin * scale
    quantile = stdtrit(degrees, 1 - alpha)
    power = ndtri(1 - 0.5 * (1 - POWER) / error.size)
    with numpy.errstate(invalid="ignore", divide="ignore"):
        largest = numpy.maximum(numpy.abs(difference) + quantile * error - rounding, 0)
        within = numpy.where(largest > 0, largest / scale, 0.0)
        factor = numpy.where(error > 0, ((ndtri(1 - alpha) + power) * error / bound) ** 2, 0.0)
    return Comparison(difference, error, holm(p), bound, within, factor)


def judge(a, b, tile_size=32, alpha=0.01, margin=0.005, exact=False):
    """The verdict on two pictures of the same window. `exact`: a picture without known noise has none."""
    picture_mean = b.mean.mean(axis=(0, 1))
    families = [compare_tiles(tile_estimate(a, size), tile_estimate(b, size), picture_mean, alpha, margin)
                for size in (tile_size, max(a.mean.shape[:2]))]
    verdict = Verdict(UNDECIDED, "", *families, tile_size, alpha, margin)
    bad = int((~(numpy.isfinite(a.mean) & numpy.isfinite(b.mean)).all(axis=-1)).sum())
    if bad:
        verdict.name, verdict.reason = DIFFERENT, f"{bad} pixels are not finite"
        return verdict
    unknown = [p.path for p in (a, b) if p.variance is None]
    verdict.within = float(max(family.within.max() for family in families))
    rejected = verdict.smallest_p <= alpha
    if numpy.all(numpy.abs(a.mean - b.mean) <= FLOAT_ROUNDING * (numpy.abs(a.mean) + numpy.abs(b.mean))):
        verdict.name, verdict.reason, verdict.margin_decides = EQUIVALENT, "all pixels are the same", False
    elif unknown and not exact:
        verdict.noise_known = False
        _judge_without_noise(verdict, unknown, any(p.encoding for p in (a, b)))
    elif verdict.within <= margin:
        verdict.name = EQUIVALENT
        verdict.reason = "every tile's difference lies within the margin" + (
            "; a difference is certain, but smaller" if rejected else "")
    elif rejected:
        verdict.name, verdict.reason = DIFFERENT, "equality is rejected"
    else:
        verdict.reason = "neither a difference nor equivalence is shown"
        verdict.needs = max(1.0, float(max(family.factor.max() for family in families)))
    return verdict


def _judge_without_noise(verdict, unknown, displayed):
    """'Different' is out of reach where a picture's own noise could be the difference. `displayed`: one is a file made to be
    looked at, which is not even equivalent where it lies within the margin."""
    names = " and ".join(unknown)
    verdict.margin_decides = len(unknown) == 1 and not displayed
    if displayed:
        verdict.reason = (f"the noise of {names} is not known, so a difference can be that noise; compare EXR or film files, or give "
                          "--exact if there is none")
    elif verdict.margin_decides and verdict.within <= verdict.margin:
        verdict.name = EQUIVALENT
        verdict.reason = f"every tile lies within the margin of {names} as it stands, whose own noise is not known"
    else:
        verdict.reason = (f"the noise of {names} is not known, so a difference can be that noise; give its second half "
                          "(--halves), a film file or a variance layer, or --exact if it has none")
