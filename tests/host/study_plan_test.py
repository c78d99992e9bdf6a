# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/study_plan.py: a study keeps within its seconds, on fast and slow machines and on those that get slower."""
import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools"))
from clrt_tools import study_plan  # noqa: E402
from clrt_tools.study_plan import Budget, Speed  # noqa: E402
from clrt_tools.study_methods import Method  # noqa: E402
from clrt_tools.study_runs import Point  # noqa: E402

SOBOL, WHITE = Method("path", "single", "sobol"), Method("path", "single", "independent")
METHODS = [SOBOL, WHITE, Method("path", "double", "sobol"), Method("path", "fast", "sobol")]
OWN = (800, 600)


def plan(samples, overhead=0.3, compiling=2.0, seconds=150, **given):
    return study_plan.choose_plan(Speed(samples, overhead, compiling), seconds, OWN, METHODS, given)


class Planning(unittest.TestCase):
    def test_fits_into_its_share_on_machines_of_every_speed(self):
        for samples in (1e4, 3e4, 1e5, 1e6, 1e7, 1e9):
            for overhead, compiling in ((0.05, 0.5), (0.5, 2), (3, 10)):
                chosen = plan(samples, overhead, compiling)
                expected = chosen.seconds(Speed(samples, overhead, compiling))
                if len(chosen.methods) > 1:
                    self.assertLessEqual(expected, 0.65 * 150, (samples, overhead, compiling))
                self.assertEqual(chosen.methods, METHODS[:len(chosen.methods)], "dropped from the end")

    def test_a_faster_machine_gets_larger_pictures_and_more_samples(self):
        slow, middle, fast = (plan(samples) for samples in (3e5, 1.5e6, 1e8))
        self.assertLess(slow.size[0] * max(slow.counts), middle.size[0] * max(middle.counts))
        self.assertLess(middle.size[0] * max(middle.counts), fast.size[0] * max(fast.counts))
        self.assertEqual((fast.size, max(fast.counts), fast.repeats), ((320, 240), 256, 3))

    def test_what_does_not_fit_is_dropped_and_named(self):
        chosen = plan(1e5, 2.0, 12.0, 60)
        self.assertIn(SOBOL, chosen.methods)
        self.assertLess(len(chosen.methods), len(METHODS))
        for method in METHODS:
            self.assertEqual(method in chosen.methods, str(method) not in "".join(chosen.notes))
        self.assertEqual(plan(1e8).notes, ())

    def test_what_the_user_chose_stays(self):
        chosen = plan(1e5, counts=(8, 32), repeats=2, size=(50, 40), reference_spp=0)
        self.assertEqual((chosen.counts, chosen.repeats, chosen.size, chosen.reference_spp), ((8, 32), 2, (50, 40), 0))

    def test_a_render_of_the_scenes_own_size_is_planned_where_it_fits(self):
        self.assertEqual(plan(1e8).own_spp, 256)
        self.assertIn(plan(2e6).own_spp, (4, 16, 64))
        self.assertIsNone(plan(1e4).own_spp)
        self.assertIsNone(study_plan.choose_plan(Speed(1e8, 0.1, 1), 150, (64, 48), METHODS, {}).own_spp, "the sweep has that size")

    def test_a_shrunk_picture_keeps_its_aspect_and_is_never_larger(self):
        self.assertEqual(study_plan.shrunk((800, 600), 320 * 240), (320, 240))
        self.assertEqual(study_plan.shrunk((64, 48), 320 * 240), (64, 48))


class TheBudget(unittest.TestCase):
    def test_runs_beyond_it_do_not_start(self):
        now = [0.0]
        budget = Budget(100, lambda: now[0])
        self.assertTrue(budget.fits(Point(SOBOL, 4096, 1)))  # nothing is known yet
        budget.note(Point(SOBOL, 16, 1), 9.0, 5.0)
        self.assertTrue(budget.fits(Point(SOBOL, 192, 1)))   # 1.3 times (4 + 60 s)
        self.assertFalse(budget.fits(Point(SOBOL, 256, 1)))  # 1.3 times (4 + 80 s)
        now[0] = 30
        self.assertFalse(budget.fits(Point(SOBOL, 192, 2)))
        self.assertTrue(Budget(None).fits(Point(SOBOL, 4096, 1)))
        self.assertEqual((budget.left(), Budget(None).left()), (70, None))

    def test_compiling_once_is_not_expected_again(self):
        budget = Budget(100, lambda: 40.0)
        budget.note(Point(SOBOL, 4, 1, cold=True), 71.0, 1.0, 68.0)
        budget.start = 0
        self.assertTrue(budget.fits(Point(SOBOL, 4, 2)))     # 40 + 3 s
        self.assertFalse(budget.fits(Point(SOBOL, 256, 2)))  # 40 + 66 s

    def test_a_method_that_never_ran_is_expected_to_compile_and_to_be_as_slow_as_the_slowest(self):
        budget = Budget(100, lambda: 0.0)
        budget.note(Point(SOBOL, 4, 1, cold=True), 13.0, 1.0, 10.0)
        self.assertAlmostEqual(budget.estimate(Point(WHITE, 4, 1)), 13.0)

    def test_a_machine_that_got_slower_is_expected_to_stay_so(self):
        budget = Budget(100, lambda: 0.0)
        budget.note(Point(SOBOL, 16, 1), 10.0, 10.0)
        self.assertTrue(budget.fits(Point(SOBOL, 64, 1)))    # 1.3 times 40 s
        budget.note(Point(WHITE, 16, 1), 25.0, 25.0)
        self.assertFalse(budget.fits(Point(SOBOL, 64, 1)))   # 2.5 times that


if __name__ == "__main__":
    unittest.main()
