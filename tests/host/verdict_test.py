# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/verdict.py: its verdicts are wrong no more often than they promise. Simulated pictures, fixed seeds."""
import os
import sys
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from noisy_pictures import noisy_replicates, picture_of  # noqa: E402
from clrt_tools import verdict  # noqa: E402

ALPHA = 0.05
RUNS = 200
# More than 22 of 200 runs happen with probability 2e-4 where each is wrong with probability 5 %.
MOST_WRONG = 22


def truth(height=48, width=48):
    """Bright to dark over a factor of 20, another slope in each channel."""
    x = numpy.linspace(0, 1, width)[None, :, None]
    y = numpy.linspace(0, 1, height)[:, None, None]
    return numpy.exp(-3 * x * numpy.array([1, 0.5, 0.2]) - 0.1 * y)


def pair(seed, deviation, factor=1.0, keep=False, picture=None):
    """Two noisy pictures; the expectation of the first is `factor` times that of the second."""
    random = numpy.random.default_rng(seed)
    expected = truth() if picture is None else picture
    return tuple(picture_of(noisy_replicates(random, expected * f, deviation), keep) for f in (factor, 1.0))


def verdicts(runs, deviation, factor=1.0, keep=False, margin=0.005, picture=None):
    """How often each verdict is given."""
    names = [verdict.judge(*pair(seed, deviation, factor, keep, picture), 16, ALPHA, margin).name for seed in range(runs)]
    return {name: names.count(name) for name in (verdict.DIFFERENT, verdict.EQUIVALENT, verdict.UNDECIDED)}


class EqualPictures(unittest.TestCase):
    def test_are_called_different_in_at_most_alpha_of_the_runs_from_variance_layers(self):
        self.assertLessEqual(verdicts(RUNS, 0.5)[verdict.DIFFERENT], MOST_WRONG)

    def test_are_called_different_in_at_most_alpha_of_the_runs_from_replicates(self):
        self.assertLessEqual(verdicts(RUNS, 0.5, keep=True)[verdict.DIFFERENT], MOST_WRONG)

    def test_have_uniform_p_values_before_the_correction(self):
        # 100 seeds x 9 tiles x 3 channels: the share below 5 % has a standard deviation of 0.4 %.
        for keep in (False, True):
            below = []
            for seed in range(100):
                a, b = (verdict.tile_estimate(p, 16) for p in pair(seed, 0.5, keep=keep))
                variance = a.variance + b.variance
                degrees = variance ** 2 / (a.variance ** 2 / a.degrees + b.variance ** 2 / b.degrees)
                below.append(verdict.two_sided_p((a.mean - b.mean) / numpy.sqrt(variance), degrees) < 0.05)
            self.assertAlmostEqual(float(numpy.mean(below)), 0.05, delta=0.016, msg=f"replicates {keep}")

    def test_with_noise_far_below_the_margin_are_equivalent(self):
        self.assertGreaterEqual(verdicts(40, 0.004)[verdict.EQUIVALENT], 38)

    def test_with_noise_above_the_margin_are_undecided(self):
        self.assertGreaterEqual(verdicts(40, 0.3)[verdict.UNDECIDED], 36)

    def test_become_equivalent_with_the_samples_asked_for(self):
        needs = [verdict.judge(*pair(seed, 0.2), 16, ALPHA).needs for seed in range(20)]
        factor = float(numpy.median([needed for needed in needs if needed is not None]))
        self.assertGreater(factor, 2)
        enough = verdicts(60, 0.2 / numpy.sqrt(factor))[verdict.EQUIVALENT]
        few = verdicts(60, 0.2 / numpy.sqrt(factor / 3))[verdict.EQUIVALENT]
        self.assertGreaterEqual(enough, 40)
        self.assertLess(few, 20)

    def test_of_one_film_are_equivalent_whatever_their_noise(self):
        a, _ = pair(1, 0.5)
        self.assertEqual(verdict.judge(a, a, 16).name, verdict.EQUIVALENT)


class Bias(unittest.TestCase):
    def test_of_one_percent_everywhere_is_found(self):
        # 2304 pixels of 7 % noise: the picture's mean is known to 0.2 %.
        self.assertGreaterEqual(verdicts(40, 0.07, factor=1.01)[verdict.DIFFERENT], 38)
        self.assertGreaterEqual(verdicts(40, 0.07, factor=1.01, keep=True)[verdict.DIFFERENT], 36)

    def test_in_one_tile_is_found(self):
        for seed in range(20):
            a, b = pair(seed, 0.1)
            a.mean[16:32, 32:48] *= 1.05
            self.assertEqual(verdict.judge(a, b, 16, ALPHA).name, verdict.DIFFERENT)

    def test_below_the_margin_is_equivalent_even_when_it_is_certain(self):
        counts = verdicts(20, 0.0005, factor=1.002)
        self.assertEqual(counts[verdict.EQUIVALENT], 20)
        self.assertIn("certain", verdict.judge(*pair(0, 0.0005, 1.002), 16, ALPHA).reason)

    def test_at_the_margin_is_called_equivalent_in_at_most_alpha_of_the_runs(self):
        # A grey picture: margin 0.5 % + 0.1 %. One tile lies on its bound, the others have next to no noise.
        wrong = 0
        for seed in range(RUNS):
            random = numpy.random.default_rng(seed)
            deviation = numpy.full((48, 48, 1), 1e-4)
            deviation[16:32, 16:32] = 0.02
            grey = numpy.ones((48, 48, 3))
            a, b = (picture_of(noisy_replicates(random, grey, deviation)) for _ in range(2))
            a.mean[16:32, 16:32] *= 1.006
            wrong += verdict.judge(a, b, 16, ALPHA).name == verdict.EQUIVALENT
        self.assertLessEqual(wrong, MOST_WRONG)

    def test_of_a_picture_without_noise_needs_no_statistics(self):
        a, b = (picture_of(numpy.repeat(truth()[None], 2, 0)) for _ in range(2))
        self.assertEqual(verdict.judge(a, b, 16).name, verdict.EQUIVALENT)
        a.mean = a.mean * 1.01
        self.assertEqual(verdict.judge(a, b, 16).name, verdict.DIFFERENT)
        a.mean = b.mean * 1.004
        self.assertEqual(verdict.judge(a, b, 16).name, verdict.EQUIVALENT)


class CorrelatedPixels(unittest.TestCase):
    """Noise that neighbouring pixels share, as splats and filters give: only replicates see it."""

    def pair(self, seed, keep):
        random = numpy.random.default_rng(seed)
        pictures = []
        for _ in range(2):
            blocks = noisy_replicates(random, numpy.ones((8, 8, 3)), 0.1)
            pictures.append(picture_of(numpy.repeat(numpy.repeat(blocks, 8, 1), 8, 2), keep))
        return pictures

    def test_keep_the_promise_with_replicates_alone(self):
        wrong = {keep: sum(verdict.judge(*self.pair(seed, keep), 16, ALPHA).name == verdict.DIFFERENT for seed in range(100))
                 for keep in (False, True)}
        self.assertLessEqual(wrong[True], 13)
        self.assertGreater(wrong[False], 50)


class SmallestMargin(unittest.TestCase):
    def test_is_where_the_verdict_becomes_equivalent(self):
        a, b = pair(7, 0.05)
        within = verdict.judge(a, b, 16, ALPHA).within
        self.assertEqual(verdict.judge(a, b, 16, ALPHA, within * 1.001).name, verdict.EQUIVALENT)
        self.assertNotEqual(verdict.judge(a, b, 16, ALPHA, within * 0.999).name, verdict.EQUIVALENT)
        self.assertNotEqual(verdict.judge(a, b, 16, ALPHA, 0.0).name, verdict.EQUIVALENT)


class UnknownNoise(unittest.TestCase):
    def pictures(self, factor):
        a, b = pair(3, 0.001, factor)
        b.variance = None
        return a, b

    def test_of_one_picture_never_gives_different(self):
        self.assertEqual(verdict.judge(*self.pictures(1.1), 16).name, verdict.UNDECIDED)
        self.assertEqual(verdict.judge(*self.pictures(1.0), 16).name, verdict.EQUIVALENT)

    def test_is_none_where_the_user_says_so(self):
        self.assertEqual(verdict.judge(*self.pictures(1.1), 16, exact=True).name, verdict.DIFFERENT)
        self.assertEqual(verdict.judge(*self.pictures(1.0), 16, exact=True).name, verdict.EQUIVALENT)

    def test_of_both_pictures_leaves_only_equal_pixels(self):
        a, b = self.pictures(1.0)
        a.variance = None
        self.assertEqual(verdict.judge(a, b, 16).name, verdict.UNDECIDED)
        self.assertEqual(verdict.judge(a, a, 16).name, verdict.EQUIVALENT)


class Parts(unittest.TestCase):
    def test_holm_equals_a_worked_example(self):
        numpy.testing.assert_allclose(verdict.holm(numpy.array([[0.01, 0.04], [0.03, 0.005]])),
                                      [[0.03, 0.06], [0.06, 0.02]])
        numpy.testing.assert_allclose(verdict.holm(numpy.array([0.5, 0.6])), [1, 1])

    def test_tiles_at_the_edge_are_smaller(self):
        sums = verdict.tile_sums(numpy.ones((5, 7, 3)), 4)
        numpy.testing.assert_array_equal(sums[..., 0], [[16, 12], [4, 3]])

    def test_students_tail_equals_tables(self):
        # t(0.975) of 7 and 14 degrees of freedom.
        numpy.testing.assert_allclose(verdict.two_sided_p(numpy.array([2.3646, 2.1448]), numpy.array([7.0, 14.0])), 0.05,
                                      rtol=1e-4)

    def test_a_pixel_that_is_not_finite_makes_pictures_different(self):
        a, b = pair(5, 0.004)
        a.mean[3, 4, 1] = numpy.nan
        result = verdict.judge(a, b, 16)
        self.assertEqual((result.name, "1 pixels" in result.reason), (verdict.DIFFERENT, True))


if __name__ == "__main__":
    unittest.main()
