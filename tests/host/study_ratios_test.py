# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/study_ratios.py and study_sentence.py: ratios, times and words from figures whose truth is known."""
import math
import os
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools"))
from clrt_tools import study_page, study_ratios, study_report, study_results, study_sentence  # noqa: E402
from clrt_tools.study_ratios import Interval, OwnSize  # noqa: E402
from clrt_tools.study_methods import Method  # noqa: E402
from clrt_tools.study_runs import Point, Run  # noqa: E402

SOBOL, WHITE = Method("path", "single", "sobol"), Method("path", "single", "independent")
DOUBLE, WHITTED = Method("path", "double", "sobol"), Method("whitted", "single", "sobol")
SHAPE = (60, 80)
PIXELS = SHAPE[0] * SHAPE[1]
REFERENCE = study_results.Reference(numpy.full(SHAPE + (3,), 0.5))


class Figures:
    """Runs of methods whose error and speed are chosen, with noise of their own."""

    def __init__(self, seed=1):
        self.random, self.noise = numpy.random.default_rng(seed), numpy.random.default_rng(-seed % 1000)
        self.runs, self.shared = [], {}

    def add(self, method, counts, error, slope, second, repeats=3, jitter=0.0, own=1.0, like=None, relative=1.0):
        """`error`: relative, of one sample; `second`: of a sample; `like`: a method whose random numbers it shares;
        `relative`: its relative MSE over its MSE."""
        for seed in range(1, repeats + 1):
            for spp in counts:
                deviation = 0.5 * error * spp ** slope
                noise = self.shared[like, seed, spp] if like else self.random.gamma(0.5, 2.0, SHAPE)
                self.shared[method, seed, spp] = noise
                seconds = second * spp * math.exp(jitter * self.random.normal())
                stats = {"seconds": {"load": 0, "bvh": 0, "compile": 0, "first_launch": 0, "render": seconds}, "width": SHAPE[1],
                         "height": SHAPE[0], "spp": spp, "error": {"rel_rmse": own * error * spp ** slope}}
                run = Run(Point(method, spp, seed), "clrt", "", stats, seconds)
                squares = deviation ** 2 * noise
                run.mse = run.relmse = float(squares.mean())
                run.noise_blocks = study_results.block_sums((own * deviation) ** 2 * self.noise.gamma(4, 0.25, SHAPE))
                run.relative_blocks = study_results.block_sums(relative * squares)
                run.blocks, run.rel_rmse = study_results.block_sums(squares), study_results.relative_root(run.mse, REFERENCE)
                self.runs.append(run)
        return self

    def conclude(self, own_runs=(), size=(SHAPE[1], SHAPE[0])):
        return study_report.conclude(self.runs, REFERENCE, {}, list(own_runs), size, [])


class Ratios(unittest.TestCase):
    def test_are_of_equal_samples_even_where_a_method_has_more(self):
        study = Figures().add(SOBOL, (4, 16, 64), 1, -0.5, 0.1).add(WHITE, (4, 16), 2, -0.5, 0.2).conclude()
        ratio = study.ratios[WHITE]
        self.assertEqual(ratio.spp, 16)
        self.assertAlmostEqual(ratio.error.value, 2, delta=0.1)
        self.assertAlmostEqual(ratio.seconds.value, 2, delta=1e-9)
        self.assertAlmostEqual(ratio.cost.value, 8, delta=0.8)
        self.assertTrue(ratio.cost.low < 8 < ratio.cost.high and ratio.cost.high / ratio.cost.low < 1.6, ratio.cost)

    def test_their_intervals_hold_the_truth_in_most_cases(self):
        held = {"error": 0, "seconds": 0, "cost": 0}
        for seed in range(60):
            study = Figures(seed).add(SOBOL, (16,), 1, -0.5, 0.1, 4, 0.1).add(WHITE, (16,), 2, -0.5, 0.15, 4, 0.1).conclude()
            for name, truth in (("error", 2), ("seconds", 1.5), ("cost", 6)):
                interval = getattr(study.ratios[WHITE], name)
                held[name] += interval.low <= truth <= interval.high
        # 95 % of 60 are 57; 51 or fewer have a chance of 1 %.
        self.assertTrue(all(count >= 52 for count in held.values()), held)

    def test_of_methods_that_share_their_noise_are_sharp(self):
        study = Figures().add(SOBOL, (16,), 1, -0.5, 0.1).add(DOUBLE, (16,), 1.0001, -0.5, 0.14, like=SOBOL).conclude()
        self.assertLess(abs(study.ratios[DOUBLE].error.value - 1.0001), 1e-9)
        self.assertLess(study.ratios[DOUBLE].error.high - study.ratios[DOUBLE].error.low, 1e-6)

    def test_are_of_both_squared_errors(self):
        adaptive = Method("path", "single", "sobol", adaptive="relative")
        study = Figures().add(SOBOL, (16,), 1, -0.5, 0.1, 4).add(adaptive, (16,), 2, -0.5, 0.1, 4, relative=0.1).conclude()
        ratio = study.ratios[adaptive]
        self.assertAlmostEqual(ratio.cost.value, 4, delta=0.4)
        self.assertAlmostEqual(ratio.relative_cost.value, 0.4, delta=0.04)
        self.assertTrue(ratio.relative_cost.low < 0.4 < ratio.relative_cost.high, ratio.relative_cost)

    def test_what_a_change_buys_is_the_inverse_of_its_cost(self):
        study = Figures().add(SOBOL, (16,), 1, -0.5, 0.1, 4).add(WHITE, (16,), 2, -0.5, 0.1, 4, relative=4).conclude()
        both = study_page.gains(study, {WHITE: "white"})["white"]
        self.assertAlmostEqual(both[0].value, 1 / 4, delta=0.03)
        self.assertAlmostEqual(both[1].value, 1 / 16, delta=0.01)
        self.assertTrue(all(gain.low < gain.value < gain.high for gain in both), both)

    def test_without_a_pair_of_runs_have_no_interval_of_seconds(self):
        seconds = Figures().add(SOBOL, (16,), 1, -0.5, 0.1, 1).add(WHITE, (16,), 2, -0.5, 0.1, 1).conclude().ratios[WHITE].seconds
        self.assertEqual((seconds.low, seconds.high), (0, math.inf))


class Times(unittest.TestCase):
    def times(self, size=OwnSize(80, 60), **settings):
        study = Figures().add(SOBOL, (4, 16, 64), **{"error": 0.8, "slope": -0.75, "second": 0.1, **settings}).conclude()
        return {time.target: time for time in (study_ratios.time_to(study.summaries[SOBOL], t, size) for t in study_ratios.TARGETS)}

    def test_between_counts_are_measured(self):
        time = self.times()[0.10]  # 16 samples give 10 %
        self.assertEqual(time.kind, study_ratios.MEASURED)
        self.assertAlmostEqual(time.seconds.value / 1.6, 1, delta=0.1)
        self.assertTrue(time.seconds.low < 1.6 < time.seconds.high)

    def test_beyond_the_most_samples_follow_the_measured_slope_and_reach_to_that_of_white_noise(self):
        times = self.times()
        for target in (0.02, 0.01):
            truth = 0.1 * (0.8 / target) ** (1 / 0.75)
            white = 6.4 * (0.8 * 64 ** -0.75 / target) ** 2
            time = times[target]
            self.assertEqual(time.kind, study_ratios.EXTRAPOLATED)
            self.assertAlmostEqual(time.seconds.value / truth, 1, delta=0.2)
            self.assertLess(time.seconds.low, truth)
            self.assertGreater(time.seconds.high, 0.8 * white)

    def test_do_not_follow_a_slope_that_cannot_go_on(self):
        times = self.times(slope=-2.0, error=8)
        self.assertEqual(times[0.01].kind, study_ratios.MEASURED)
        times = self.times(slope=-2.0, error=80)  # 2 % at 64 samples, 1 % at twice as many and no fewer
        self.assertAlmostEqual(times[0.01].seconds.value / 12.8, 1, delta=0.1)

    def test_below_the_fewest_samples_are_an_upper_end(self):
        time = self.times(error=0.1)[0.05]
        self.assertEqual((time.kind, round(time.seconds.value, 9)), (study_ratios.BELOW, 0.4))

    def test_of_a_method_that_levels_off_are_never_reached(self):
        study = Figures().add(WHITTED, (4, 16, 64), 0.4, 0, 0.1, own=0.01).conclude()
        self.assertEqual({time.kind for time in study.times[WHITTED]}, {study_ratios.NEVER})

    def test_of_a_method_that_is_about_to_level_off_are_not_extrapolated_below_its_floor(self):
        # Half of the squared error is noise: the rest stays.
        study = Figures().add(SOBOL, (4, 16), 0.8, -0.5, 0.1).add(WHITTED, (4, 16), 0.8, -0.5, 0.1, own=0.5 ** 0.5).conclude()
        self.assertAlmostEqual(study.ratios[WHITTED].floor, 0.2 * 0.5 ** 0.5, delta=0.01)
        self.assertIsNone(study_ratios.floor(study.summaries[SOBOL]))
        self.assertEqual(study.times[WHITTED][0].kind, study_ratios.NEVER)
        self.assertEqual(study.times[SOBOL][0].kind, study_ratios.EXTRAPOLATED)

    def test_are_carried_over_to_the_scenes_own_size(self):
        scaled = self.times(OwnSize(800, 600, 100, 1.0))[0.10].seconds.value
        self.assertAlmostEqual(scaled, 100 * self.times()[0.10].seconds.value)
        fewer_edges = self.times(OwnSize(800, 600, 100, 0.5))[0.05].seconds.value
        self.assertAlmostEqual(fewer_edges, scaled, delta=0.01 * scaled)

    def test_a_render_of_that_size_tells_how(self):
        figures = Figures().add(SOBOL, (4, 16), 0.8, -0.5, 0.1)
        stats = {"width": 800, "height": 600, "spp": 16, "seconds": {"render": 320.0}, "error": {"rel_rmse": 0.1}}
        size = figures.conclude([Run(Point(SOBOL, 16, 1), "clrt", "", stats, 1.0)], (800, 600)).own_size
        self.assertEqual((size.width, size.height, size.measured), (800, 600, True))
        self.assertAlmostEqual(size.seconds, 200)
        self.assertAlmostEqual(size.error, 0.5)
        guessed = figures.conclude((), (800, 600)).own_size
        self.assertEqual((guessed.seconds, guessed.error, guessed.measured), (100, 1.0, False))


class Words(unittest.TestCase):
    def headline(self, *methods):
        figures = Figures().add(SOBOL, (4, 16, 64), 0.8, -0.5, 0.1, 4, 0.02)
        for settings in methods:
            figures.add(**{"counts": (4, 16, 64), "slope": -0.5, "second": 0.1, "repeats": 4, "jitter": 0.02, **settings})
        return figures.conclude().headline

    def test_say_the_price_first(self):
        self.assertRegex(self.headline(), r"^An error of 10 % costs 6\.\d s \(\d\.\d - \d.\d s\) at 80x60\.$")

    def test_say_how_much_better_the_better_one_is(self):
        self.assertRegex(self.headline({"method": WHITE, "error": 2}), r"Sobol points are 6\.\d times \([\d.]+ - [\d.]+\) better than "
                                                                       r"white noise\.$")
        self.assertRegex(self.headline({"method": WHITE, "error": 0.4}), "White noise is 4 times .* better than Sobol points")

    def test_judge_a_change_by_the_error_that_it_aims_at(self):
        default, aim = (Method("path", "single", "sobol", adaptive=name) for name in ("off", "relative"))
        figures = Figures().add(default, (4, 16), 0.8, -0.5, 0.1, 4, 0.02).add(aim, (4, 16), 1.6, -0.5, 0.1, 4, 0.02, relative=0.1)
        self.assertRegex(figures.conclude().headline, r"Adaptive sampling for the relative error is 2\.\d times \(.*\) better than "
                                                      r"even sampling\.$")

    def test_say_about_the_same_where_nothing_differs(self):
        self.assertIn("Sobol points and white noise cost about the same", self.headline({"method": WHITE, "error": 0.8}))

    def test_do_not_say_that_of_what_was_hardly_measured(self):
        text = self.headline({"method": WHITE, "error": 0.8, "repeats": 2, "jitter": 1.0})
        self.assertRegex(text, r"were not told apart \([\d.]+ - [\d,.]+ times\)")
        self.assertNotIn("about the same", text)

    def test_say_what_a_precision_buys(self):
        double = {"method": DOUBLE, "error": 0.8, "like": SOBOL}
        self.assertRegex(self.headline({**double, "second": 0.14}), r"Double precision buys nothing: the same error in 1\.4 times "
                                                                    r"\(1\.\d - 1\.\d\) the seconds\.")
        self.assertIn("Double precision buys nothing: the same error in about the same time", self.headline(double))
        uncertain = self.headline({**double, "jitter": 0.3})
        self.assertIn("Double precision buys nothing: the same error in about the same time", uncertain)
        self.assertIn("Double precision takes 0.5 times", self.headline({**double, "second": 0.05}))
        self.assertIn("Double precision gives 0.5 times", self.headline({**double, "error": 0.4}))

    def test_say_that_a_method_leaves_something_out(self):
        self.assertIn("Whitted levels off at 40 %", self.headline({"method": WHITTED, "error": 0.4, "slope": 0, "own": 0.01}))

    def test_mark_what_is_extrapolated(self):
        study = Figures().add(SOBOL, (4, 16), 9, -0.5, 0.1).conclude()
        self.assertRegex(study.headline, r"An error of 5 % costs about [\d.]+ \w+ \(extrapolated, .*\) at 80x60")

    def test_durations_and_numbers_have_two_digits(self):
        self.assertEqual([study_sentence.duration(s) for s in (0.0123, 12.34, 99, 100, 7200, 1e6)],
                         ["0.012 s", "12 s", "99 s", "1.7 min", "2 h", "12 days"])
        self.assertEqual([study_sentence.number(v) for v in (0.123, 1, 9.99, 1234)], ["0.12", "1", "10", "1,200"])
        self.assertEqual(study_sentence.ends(Interval(3, 2, 100), study_sentence.duration), "2 s - 1.7 min")
        self.assertEqual(study_sentence.ends(Interval(3)), "")


if __name__ == "__main__":
    unittest.main()
