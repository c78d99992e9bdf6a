# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/metrics.py and the readers: closed forms on tiny pictures."""
import os
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from noisy_pictures import film_bytes, noisy_replicates, picture_of, write_exr  # noqa: E402
from clrt_tools import film_file, metrics, picture_file  # noqa: E402


def value(name, a, b):
    """One metric of two pictures of one pixel row."""
    pictures = [numpy.array(p, float).reshape(1, -1, 3) for p in (a, b)]
    return {metric.name: metric.value for metric in metrics.all_metrics(*pictures)}[name]


class Metrics(unittest.TestCase):
    # Two pixels: one is off by 0.1 in red, the other has twice the radiance.
    A = [[0.3, 0.2, 0.2], [1.0, 1.0, 1.0]]
    B = [[0.2, 0.2, 0.2], [0.5, 0.5, 0.5]]

    def test_equal_their_formulas(self):
        self.assertAlmostEqual(value("RMSE", self.A, self.B), ((0.1 ** 2 + 3 * 0.5 ** 2) / 6) ** 0.5)
        self.assertAlmostEqual(value("rel. RMSE", self.A, self.B), ((0.1 ** 2 + 3 * 0.5 ** 2) / 6) ** 0.5 / 0.35)
        small = 0.035 ** 2
        self.assertAlmostEqual(value("relMSE", self.A, self.B), (0.01 / (0.04 + small) + 3 * 0.25 / (0.25 + small)) / 6)
        self.assertAlmostEqual(value("MAPE", self.A, self.B), (0.1 / 0.21 + 3 * 0.5 / 0.51) / 6)
        self.assertAlmostEqual(value("SMAPE", self.A, self.B), (2 * 0.1 / 0.51 + 3 * 2 * 0.5 / 1.51) / 6)
        self.assertAlmostEqual(value("bias", self.A, self.B), 3.7 / 2.1 - 1)

    def test_the_relative_squared_error_does_not_know_the_unit_of_light(self):
        a, b = (1024 * numpy.array(picture) for picture in (self.A, self.B))
        self.assertAlmostEqual(value("relMSE", a, b), value("relMSE", self.A, self.B))
        self.assertEqual(value("relMSE", [[1, 1, 1]], [[0, 0, 0]]), 1)

    def test_are_not_relative_to_a_black_picture(self):
        black = [[0, 0, 0]]
        self.assertIsNone(value("rel. RMSE", [[1, 1, 1]], black))
        self.assertAlmostEqual(value("RMSE", [[1, 1, 1]], black), 1)

    def test_are_those_of_the_finite_pixels(self):
        self.assertAlmostEqual(value("RMSE", [[numpy.nan, 0, 0], [1, 1, 1]], [[0, 0, 0], [0, 0, 0]]), 1)
        self.assertEqual(metrics.all_metrics(numpy.full((1, 1, 3), numpy.inf), numpy.zeros((1, 1, 3))), [])

    def test_halves_take_the_references_noise_out(self):
        random = numpy.random.default_rng(1)
        truth = numpy.full((200, 200, 3), 0.7)
        x, first, second = (noisy_replicates(random, truth, d, 1)[0] for d in (0.1, 0.2, 0.2))
        self.assertAlmostEqual(metrics.squared_error_without_noise(x, first, second) / 0.07 ** 2, 1, delta=0.05)

    def test_halves_tell_the_noise_of_their_mean(self):
        random = numpy.random.default_rng(3)
        halves = [noisy_replicates(random, numpy.ones((200, 200, 3)), 0.2, 1)[0] for _ in range(2)]
        joined = picture_file.join_halves(*(picture_of(numpy.array([half, half])) for half in halves))
        self.assertAlmostEqual(joined.variance.mean() / joined.mean.var(), 1, delta=0.05)
        self.assertAlmostEqual(joined.variance.mean() / (0.5 * 0.2 ** 2), 1, delta=0.05)

    def test_the_noise_alone_is_what_equal_pictures_differ_by(self):
        random = numpy.random.default_rng(2)
        a, b = (picture_of(noisy_replicates(random, numpy.ones((100, 100, 3)), 0.1)) for _ in range(2))
        rmse = value("RMSE", a.mean, b.mean)
        self.assertAlmostEqual(metrics.noise_rmse((a.variance, b.variance)) / rmse, 1, delta=0.02)
        self.assertIsNone(metrics.noise_rmse((a.variance, None)))


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "picture")

    def test_exr_layers_and_metadata_are_read(self):
        mean = numpy.random.default_rng(1).random((3, 4, 3)).astype(numpy.float32)
        write_exr(self.path + ".exr", mean, 0.5 * mean, 64, [("clrt.seed", "7"), ("clrt.replicates", "16")], (5, 6), (20, 30))
        picture = picture_file.read_picture(self.path + ".exr")
        numpy.testing.assert_array_equal(picture.mean, mean)
        numpy.testing.assert_array_equal(picture.variance, 0.5 * mean)
        self.assertEqual((picture.samples, picture.seed, picture.degrees), (64, "7", 15))
        self.assertEqual(str(picture.window), "4x3 from 5,6 of 20x30")

    def test_few_samples_mean_few_degrees_of_freedom(self):
        write_exr(self.path + ".exr", numpy.ones((2, 2, 3)), numpy.ones((2, 2, 3)), 3)
        self.assertEqual(picture_file.read_picture(self.path + ".exr").degrees, 2)

    def test_film_sums_become_replicates(self):
        # Samples 1..9 of 4 replicates: replicate 1 has samples 1, 5, 9, the others two each.
        sums = numpy.arange(4 * 2 * 3 * 3).reshape(4, 2, 3, 3) * 1000 - 5
        with open(self.path, "wb") as file:
            file.write(film_bytes(sums, 2.0 ** -10, [[1, 10]], seed=3, window=[1, 2, 4, 4], size=[8, 8]))
        picture = picture_file.read_picture(self.path)
        expected = sums * 2.0 ** -10 / numpy.array([2, 3, 2, 2])[:, None, None, None]
        numpy.testing.assert_allclose(picture.replicates, expected, rtol=1e-15)
        numpy.testing.assert_allclose(picture.mean, expected.mean(axis=0), rtol=1e-15)
        self.assertEqual((picture.samples, picture.seed, str(picture.window)), (9, "3", "3x2 from 1,2 of 8x8"))

    def test_replicates_without_samples_are_left_out(self):
        self.assertEqual([film_file.replicate_samples([(0, 2), (8, 9)], 4, r) for r in range(4)], [2, 1, 0, 0])
        with open(self.path, "wb") as file:
            file.write(film_bytes(numpy.ones((4, 1, 1, 3), int), 1.0, [[0, 2], [8, 9]]))
        self.assertEqual(len(picture_file.read_picture(self.path).replicates), 2)

    def test_damaged_films_say_what_is_wrong(self):
        good = film_bytes(numpy.ones((2, 4, 4, 3), int), 1.0, [[0, 2]])
        flipped = bytearray(good)
        flipped[-100] ^= 1
        cases = [(good[:10], "truncated"), (good[:-9], "truncated"), (good + b"x", "damaged"), (bytes(flipped), "checksum"),
                 (film_bytes(numpy.ones((2, 4, 4, 3), int), 1.0, [[0, 2]], version=1), "version 3, found 1"),
                 (good.replace(b"quantum", b"quantus"), "quantum")]
        for content, words in cases:
            with open(self.path, "wb") as file:
                file.write(content)
            with self.assertRaises(picture_file.UnreadableFile) as raised:
                picture_file.read_picture(self.path)
            self.assertIn(words, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
