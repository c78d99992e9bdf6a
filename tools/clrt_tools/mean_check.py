# SPDX-License-Identifier: Apache-2.0
"""Whether two renderers show the same scene: the means of their pictures, with how well they are known."""
import dataclasses
import math
import statistics

# Means that differ by less than this, relative, are taken as equal; and how many standard errors make a larger difference sure.
SAME, SURELY = 0.003, 4.0


@dataclasses.dataclass(frozen=True)
class MeanCheck:
    """`difference` of the second's mean from the first's, relative, and its standard error."""
    difference: float
    error: float

    @property
    def differs(self):
        return abs(self.difference) > max(SAME, SURELY * self.error)

    def __str__(self):
        return f"{100 * self.difference:+.2f} % +- {100 * self.error:.2f} %"


def compare_means(first, second):
    """Of the means of independent pictures, two or more each."""
    means = [statistics.fmean(values) for values in (first, second)]
    squares = [statistics.variance(values) / len(values) for values in (first, second)]
    if means[0] <= 0:
        raise ValueError("expected a picture that is not black, found a black one")
    return MeanCheck(means[1] / means[0] - 1, math.sqrt(sum(squares)) / means[0])
