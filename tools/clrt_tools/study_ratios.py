# SPDX-License-Identifier: Apache-2.0
"""What the figures of a study say, each with its 95 % interval: methods against the default at equal samples, and the seconds
that an error costs. Errors of different pixels are independent, so the spread of the errors of a picture's blocks tells how sure
a ratio of errors is (delete-one-block jackknife; Tukey 1958). Where two methods share their random numbers, so do the blocks
their noise, and the interval is as narrow as it should be."""
import dataclasses
import math
from typing import Optional

import numpy
from scipy.special import stdtrit

# Two-sided 95 % of a normal variable, in standard deviations.
NORMAL_95 = 1.96
# Shortest render stage, seconds, whose ratio to another is compared: below it the launch counts for more than the samples.
SHORTEST = 0.1
# Errors of pictures, relative, that people ask for.
TARGETS = (0.10, 0.05, 0.02, 0.01)
# Slope of the error over the samples of white noise, the flattest that is still taken to fall, and the steepest that is taken to
# go on: the rate of points of low discrepancy (Niederreiter 1992); few samples may show a steeper one by chance.
WHITE_SLOPE, FLAT_SLOPE, STEEP_SLOPE = -0.5, -0.2, -1.0
# A method whose squared error is surely more than so many times its own noise simulates something else than the reference.
BEYOND_NOISE = 1.15


@dataclasses.dataclass(frozen=True)
class Interval:
    """A positive number with the ends of its 95 % interval; ends 0 and infinity: not known."""
    value: float
    low: float = 0.0
    high: float = math.inf

    @property
    def includes_one(self):
        return self.low <= 1 <= self.high

    def inverse(self):
        return Interval(1 / self.value, 1 / self.high, 1 / self.low if self.low > 0 else math.inf)


    def root(self):
        return Interval(math.sqrt(self.value), math.sqrt(self.low), math.sqrt(self.high))


def of_logarithm(value, half_width):
    """The interval of exp(value) whose logarithm is known to +- half_width; None: not known."""
    if half_width is None or not math.isfinite(half_width):
        return Interval(math.exp(value))
    return Interval(math.exp(value), math.exp(value - half_width), math.exp(value + half_width))


def half_width(interval):
    """Of its logarithm; infinite where not known."""
    return 0.5 * math.log(interval.high / interval.low) if interval.low > 0 else math.inf


def product(a, b):
    """Of two numbers with independent errors."""
    return of_logarithm(math.log(a.value * b.value), math.hypot(half_width(a), half_width(b)))


def jackknife(statistic, sums):
    """(value, half width of its 95 % interval) of a function of mean squared errors. `sums`: (errors, blocks); blocks count
    alike. Not a number where an error is lost in the reference's noise."""
    total, count = sums.sum(axis=1), sums.shape[1]
    value = statistic(total)
    parts = numpy.array([statistic((total - sums[:, block]) * count / max(count - 1, 1)) for block in range(count)])
    if count < 2 or not numpy.isfinite(parts).all():
        return value, None
    return value, NORMAL_95 * math.sqrt((count - 1) / count * float(((parts - parts.mean()) ** 2).sum()))


def _log(value):
    return math.log(value) if value > 0 else math.nan


@dataclasses.dataclass
class Ratio:
    """A method over the default, both at the same samples a pixel; a rival at about the same seconds."""
    method: object
    spp: object                  # a pixel; of a rival: `its v the default's`
    error: Optional[Interval]    # RMSE over RMSE; None: lost in the reference's noise
    seconds: Interval            # a sample; of a rival: of the picture
    cost: Optional[Interval]     # MSE x seconds: seconds for the same error, where it falls with the root of the samples
    relative_cost: Optional[Interval] = None  # likewise of the relative MSE
    floor: Optional[float] = None  # relative error at which it levels off: it does not simulate what the reference shows


def compare(summaries, default):
    """{method: Ratio} to the default, each at the most samples that both have."""
    ratios = {}
    for method, points in summaries.items():
        own, its = ({s.spp: s for s in summaries[m]} for m in (method, default))
        spp = max(set(own) & set(its), default=None)
        if spp is not None:
            ratios[method] = _ratio(method, own[spp], its[spp], _seconds_ratio(points, summaries[default]))
            ratios[method].floor = floor(points)
    return ratios


def compare_rival(rival, points, default_points):
    """The Ratio of another renderer's pictures to the default's, at the counts of samples that take about the same seconds."""
    its = default_points[-1]
    own = min(points, key=lambda point: abs(_log(point.seconds / its.seconds)))
    ratio = _ratio(rival, own, its, _quotient_of_seconds(own, its))
    ratio.spp, ratio.floor = f"{own.spp} v {its.spp}", floor(points)
    return ratio


def _quotient_of_seconds(own, its):
    """Of two renderers' runs, which did not alternate: Welch's interval of the difference of the mean logarithms."""
    logs = [numpy.log([run.render_seconds for run in summary.runs]) for summary in (own, its)]
    value = float(logs[0].mean() - logs[1].mean())
    if min(len(each) for each in logs) < 2:
        return Interval(math.exp(value))
    squares = [float(each.var(ddof=1)) / len(each) for each in logs]
    if sum(squares) == 0:
        return Interval(math.exp(value), math.exp(value), math.exp(value))
    degrees = sum(squares) ** 2 / sum(square ** 2 / (len(each) - 1) for square, each in zip(squares, logs))
    return of_logarithm(value, float(stdtrit(degrees, 0.975)) * math.sqrt(sum(squares)))


def _ratio(method, own, its, seconds):
    squared = _quotient(own.blocks, its.blocks)
    relative = _quotient(own.relative_blocks, its.relative_blocks)
    return Ratio(method, own.spp, squared and squared.root(), seconds, squared and product(squared, seconds),
                 relative and product(relative, seconds))


def _quotient(own, its):
    """Of two mean squared errors, from those of the blocks; None where one is lost in the reference's noise."""
    value, width = jackknife(lambda mse: _log(mse[0]) - _log(mse[1]), numpy.array([own, its]))
    return of_logarithm(value, width) if math.isfinite(value) else None


def _seconds_ratio(points, default_points):
    """From pairs of runs of the same seed and samples, which ran one after the other."""
    pairs = [(a.render_seconds, b.render_seconds) for own in points for its in default_points if own.spp == its.spp
             for a in own.runs for b in its.runs if a.point.seed == b.point.seed and min(a.render_seconds, b.render_seconds) > 0]
    long_pairs = [pair for pair in pairs if min(pair) >= SHORTEST]
    logs = numpy.log([a / b for a, b in (long_pairs if len(long_pairs) > 1 else pairs)])
    if logs.size == 0:
        return Interval(1.0)
    if logs.size < 2:
        return Interval(math.exp(logs[0]))
    quantile = float(stdtrit(logs.size - 1, 0.975))
    return of_logarithm(float(logs.mean()), quantile * float(logs.std(ddof=1)) / math.sqrt(logs.size))


def floor(points):
    """The relative error that no number of samples takes away: what is left of the error at most samples without its noise, as
    clrt's variance layers tell it; None where that is not surely there."""
    last = points[-1]
    if not last.error or last.noise_blocks is None or last.noise_blocks.sum() <= 0:
        return None
    value, width = jackknife(lambda squares: _log(squares[0]) - _log(squares[1]), numpy.array([last.blocks, last.noise_blocks]))
    if width is None or value - width <= math.log(BEYOND_NOISE):
        return None
    return last.error * math.sqrt(1 - math.exp(-value))


@dataclasses.dataclass(frozen=True)
class OwnSize:
    """How figures are carried over from the study's pictures to the size that the user asked for."""
    width: int
    height: int
    seconds: float = 1.0  # of a sample a pixel, over those at the study's size
    error: float = 1.0    # at the same samples, over that at the study's size
    measured: bool = True  # by a run of this size; else the number of pixels tells

    def __str__(self):
        return f"{self.width}x{self.height}"


@dataclasses.dataclass(frozen=True)
class TimeTo:
    """Seconds of rendering for an error. `kind`: MEASURED between two counts of samples, EXTRAPOLATED beyond the most, BELOW:
    the fewest samples that were tried suffice, NEVER: the method levels off above it."""
    target: float
    kind: str
    seconds: Optional[Interval] = None


MEASURED, EXTRAPOLATED, BELOW, NEVER = "measured", "extrapolated", "below", "never"


def slope_at_end(logs):
    """Of log error over log samples between the last two counts; `logs`: (log samples, log errors)."""
    (n0, n1), (e0, e1) = logs[0][-2:], logs[1][-2:]
    return (e1 - e0) / (n1 - n0)


def samples_to(target, logs):
    """Logarithm of the samples for a target, along straight lines of log error over log samples."""
    samples, errors = logs
    for index in range(1, len(samples)):
        if errors[index] <= target:
            part = (errors[index - 1] - target) / max(errors[index - 1] - errors[index], 1e-12)
            return samples[index - 1] + max(part, 0.0) * (samples[index] - samples[index - 1])
    slope = min(max(slope_at_end(logs), STEEP_SLOPE), FLAT_SLOPE) if len(samples) > 1 else WHITE_SLOPE
    return samples[-1] + (target - errors[-1]) / slope


def time_to(points, target, size):
    """The TimeTo of a method at the size asked for."""
    points = [point for point in points if point.error]
    if not points:
        return TimeTo(target, NEVER)
    last = points[-1]
    second = last.seconds / last.spp * size.seconds
    if points[0].error * size.error <= target:
        return TimeTo(target, BELOW, Interval(points[0].spp * second))
    reached = last.error * size.error <= target
    if not reached and target < (floor(points) or 0) * size.error:
        return TimeTo(target, NEVER)
    samples, scale = [math.log(point.spp) for point in points], last.error ** 2 / last.blocks.sum() * size.error ** 2
    value, width = jackknife(lambda mse: samples_to(math.log(target), (samples, [0.5 * _log(m * scale) for m in mse])),
                             numpy.array([point.blocks for point in points]))
    seconds = product(of_logarithm(value, width), _spread(last, second))
    if reached:
        return TimeTo(target, MEASURED, seconds)
    # Beyond the most samples the slope may become that of white noise.
    white = last.spp * (last.error * size.error / target) ** (-1 / WHITE_SLOPE) * second
    return TimeTo(target, EXTRAPOLATED, Interval(seconds.value, min(seconds.low, white), max(seconds.high, white)))


def _spread(summary, second):
    """Seconds of a sample with the range of the repeats."""
    return Interval(second, second * summary.seconds_low / summary.seconds, second * summary.seconds_high / summary.seconds)
