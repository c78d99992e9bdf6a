# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/agreement.py: verdicts and shares from pictures whose truth is known."""
import os
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools"))
from clrt_tools import agreement, picture_file  # noqa: E402

SIZE, SEEDS, NOISE = (24, 32, 3), 12, 0.02
WINDOW = picture_file.Window(0, 0, SIZE[1], SIZE[0], SIZE[1], SIZE[0])


def sample(seed, brightness=1.0, told=1.0, bias=0.0):
    """Grey pictures with noise; `told`: the error that is told over the true one. A `bias` is in the left half alone."""
    random = numpy.random.default_rng(seed)
    truth = numpy.full(SIZE, brightness)
    truth[:, :SIZE[1] // 2] += bias
    values = [truth + NOISE * random.normal(size=SIZE) for _ in range(SEEDS)]
    errors = [(told * NOISE, 0.9 * told * NOISE, 1.1 * told * NOISE)] * SEEDS
    return agreement.Sample([picture_file.Picture("a", WINDOW, value) for value in values], errors)


def verdicts(**samples):
    return {(a, b): result.name for a, b, result in agreement.compare_pairs(samples, 8, 0.01, 0.01)}


class Agreement(unittest.TestCase):
    def test_every_pair_is_compared(self):
        found = verdicts(a=sample(1), b=sample(2), c=sample(3, bias=0.03))
        self.assertEqual(found, {("a", "b"): "equivalent", ("a", "c"): "different", ("b", "c"): "different"})

    def test_what_a_scene_keeps_apart_is_not_compared(self):
        for text, effects, reason in (("light", ("matte", "normal and bump maps", "smooth normals"), "smooth normals"),
                                      ("whitted --min-contribution 0", ("coat", "glossy"), "glossy"),
                                      ("raycast", ("matte", "refraction"), None), ("path", ("glossy", "coat"), None)):
            self.assertEqual(agreement.Participant(text).apart(effects), reason, text)
        for integrator in agreement.APART:
            self.assertIn(integrator, [text.split()[0] for group in agreement.GROUPS for text in group])

    def test_error_bars_are_judged_by_the_other_pictures(self):
        for told, held in ((1.0, SEEDS), (0.8, 0), (1.25, 0)):
            found = agreement.calibrate(sample(4, told=told))
            self.assertEqual((found.held, found.count), (held, SEEDS), told)
            self.assertAlmostEqual(found.told_over_true / told, 1, delta=0.03)

    def test_true_errors_scatter_as_those_around_the_truth(self):
        """The squared error of 12 equal values has a relative variance of 2 / 12; 4000 of them tell it to 2.5 %."""
        random, values, pictures = numpy.random.default_rng(8), 12, 5
        errors = [agreement.true_error(10 + random.normal(size=(pictures, values)), 0) for _ in range(4000)]
        self.assertAlmostEqual(100 * numpy.mean(errors), 1, delta=0.03)
        self.assertAlmostEqual(numpy.var(errors) / numpy.mean(errors) ** 2 * values / 2, 1, delta=0.15)

    def test_what_all_pictures_lack_is_no_fault_of_error_bars(self):
        self.assertEqual(agreement.calibrate(sample(5, bias=0.5)).held, 0)  # the mean that errors are relative to has grown
        biased = sample(5, bias=0.5)
        biased.errors = [tuple(value / 1.25 for value in error) for error in biased.errors]
        self.assertEqual(agreement.calibrate(biased).held, SEEDS)

    def test_pictures_without_error_or_light_are_not_judged(self):
        silent = sample(6)
        silent.errors = [None] * SEEDS
        self.assertIsNone(agreement.calibrate(silent))
        silent.errors = [(0.1, None, None)] * SEEDS  # of too few samples for an interval
        self.assertIsNone(agreement.calibrate(silent))
        black = sample(6)
        for picture in black.pictures:
            picture.mean[:] = 0
        self.assertIsNone(agreement.calibrate(black))

    def test_intervals_are_those_of_tables(self):
        for held, count, low, high in ((0, 10, 0.0, 0.3085), (10, 10, 0.6915, 1.0), (95, 100, 0.8872, 0.9836)):
            found = agreement.Calibration(held, count).interval()
            self.assertAlmostEqual(found[0], low, places=4)
            self.assertAlmostEqual(found[1], high, places=4)

    def test_shares_that_chance_can_explain_are_calibrated(self):
        def is_calibrated(*held):
            scenes = [agreement.Calibration(each, 25) for each in held]
            return agreement.is_calibrated(agreement.pool(scenes), scenes)
        self.assertTrue(is_calibrated(*[24] * 8))
        self.assertFalse(is_calibrated(*[21] * 8))
        self.assertFalse(is_calibrated(*[25] * 40))
        self.assertFalse(is_calibrated(*[24] * 7, 14))


if __name__ == "__main__":
    unittest.main()
