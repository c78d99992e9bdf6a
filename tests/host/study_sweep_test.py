# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/study_runs.py and study_results.py without clrt: order of the runs, errors and their sums."""
import os
import sys
import tempfile
import time
import unittest
import unittest.mock

import numpy
import OpenImageIO

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from noisy_pictures import write_exr  # noqa: E402
from clrt_tools import study_pictures, study_results, study_runs  # noqa: E402
from clrt_tools.clrt_choices import Choices  # noqa: E402
from clrt_tools.study_methods import SWITCHES, Method, combinations  # noqa: E402
from clrt_tools.study_runs import Point, Run  # noqa: E402

SOBOL, WHITE = Method("path", "single", "sobol"), Method("path", "single", "independent")


def stats(render):
    return {"seconds": {"load": 0.1, "bvh": 0.2, "compile": 0.3, "first_launch": 0.4, "render": render, "total": 2.0}}


def truth_pixels(truth):
    return truth.shape[0] * truth.shape[1]


class Sweep(unittest.TestCase):
    def test_every_combination_runs_once_a_repeat_and_compiles_anew_once(self):
        points = study_runs.sweep([SOBOL, WHITE], [16, 4], 3)
        self.assertEqual(len(set((p.method, p.spp, p.seed) for p in points)), 2 * 2 * 3)
        self.assertEqual([(p.spp, p.seed) for p in points[:4]], [(4, 1), (4, 1), (16, 1), (16, 1)])
        self.assertEqual([p.method for p in points if p.cold], [SOBOL, WHITE])
        self.assertFalse({p.seed for p in points} & set(study_runs.REFERENCE_SEEDS))

    NAMES = {"integrator": ["path", "whitted"], "precision": ["single", "double"], "sampler": ["independent", "sobol"]}

    def test_of_a_quick_study_changes_one_thing_at_a_time(self):
        one_change = [SOBOL, WHITE, Method("path", "double", "sobol"), Method("whitted", "single", "sobol")]
        self.assertEqual(combinations(self.NAMES, set(), True, SOBOL), one_change)
        every = combinations(self.NAMES, set(), False, SOBOL)
        self.assertEqual((every[:4], len(every), len(set(every))), (one_change, 8, 8))

    def test_combines_a_way_to_find_the_light_only_where_it_is_asked_for(self):
        names = {**self.NAMES, "guide": ["auto", "on", "off"], "adaptive": ["off", "mse", "relative"]}
        default = Method("path", "single", "sobol", guide="auto", adaptive="off")
        methods = combinations(names, set(), False, default)
        self.assertEqual((methods[0], len(methods), len(set(methods))), (default, 8 + 2 + 2, 12))
        self.assertEqual([m.label(default) for m in methods[1:6]],
                         ["independent", "guide on", "guide off", "adaptive mse", "adaptive relative"])
        methods = combinations(names, {"guide"}, False, default)
        self.assertEqual((len(methods), len(set(methods))), (8 * 3 + 2, 26))
        self.assertEqual(len(combinations(names, {"guide"}, True, default)), 1 + 1 + 2 + 2 + 1 + 1)

    def test_a_default_that_is_not_among_the_names_gives_way(self):
        self.assertEqual(combinations({"integrator": ["whitted"], "precision": ["single"], "sampler": ["sobol"]}, set(), True, SOBOL),
                         [Method("whitted", "single", "sobol")])


class AMethod(unittest.TestCase):
    def test_is_said_as_clrt_takes_it(self):
        method = Method("path", "single", "sobol", guide="on", emission_rays="1", adaptive="relative")
        self.assertEqual(method.words(), ["--integrator", "path", "--precision", "single", "--sampler", "sobol", "--guide", "on",
                                          "--emission-rays", "1", "--adaptive=relative"])
        self.assertEqual(Method(adaptive="off").words(), [])
        self.assertEqual(Method(adaptive="on").words(), ["--adaptive"])

    def test_has_a_name_of_its_own(self):
        self.assertEqual(str(Method("path", "single", "sobol", guide="auto", adaptive="off")), "path, single, sobol")
        self.assertEqual(str(Method("path", "single", "sobol", guide="off", light_samples="4", adaptive="mse")),
                         "path, single, sobol, guide off, light samples 4, adaptive mse")

    def test_every_switch_has_its_place_among_the_changes(self):
        self.assertEqual(sorted(switch.rank for switch in SWITCHES.values()), list(range(1, len(SWITCHES) + 1)))


class TheNamesThatClrtTakes(unittest.TestCase):
    HELP = """Work:
  -i, --integrator NAME        path (all light), or so, or whitted (default path)
      --sampler NAME           sobol or independent (white noise, to
                               compare with) (default sobol)
      --light-sampler NAME     how a light is chosen: tree (by a, or b; `path`
                               alone), mixture (half: half) or power (default
                               tree)
      --guide auto|on|off      learns where light comes from
      --path-reuse auto|on|off  paths that share
      --emission-rays N        camera rays (default 16)
      --light-samples auto|N   samples of lights (default auto)
      --adaptive%s
                               take more samples where it is noisy (default: the same)
"""

    def choices(self, adaptive):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "clrt")
            with open(program, "w", encoding="utf-8") as file:
                file.write(f"#!/bin/sh\ncat <<'END'\n{self.HELP % adaptive}END\n")
            os.chmod(program, 0o755)
            return Choices(program)

    def test_are_read_from_every_form_of_its_help(self):
        choices = self.choices("[=mse|relative]")
        self.assertEqual(choices.names("--light-sampler"), ["tree", "mixture", "power"])
        self.assertEqual(choices.names("--sampler"), ["sobol", "independent"])
        self.assertEqual(choices.names("--guide"), ["auto", "on", "off"])
        self.assertEqual(choices.names("--adaptive"), ["off", "mse", "relative"])
        self.assertEqual(self.choices("").names("--adaptive"), ["off", "on"])
        self.assertEqual([choices.names("--" + name) for name in ("path-reuse", "emission-rays", "light-samples")],
                         [["auto", "off"], ["16", "1"], ["auto", "1"]])
        self.assertEqual(choices.default_method(), Method("path", None, "sobol", "tree", "auto", "auto", "16", "auto", "off"))

    def test_are_numbers_where_the_option_takes_them(self):
        choices = self.choices("")
        self.assertEqual([choices.takes("--light-samples", name) for name in ("auto", "2", "N", "-1")], [True, True, False, False])
        self.assertEqual([choices.takes("--guide", name) for name in ("on", "2")], [True, False])


class Pictures(unittest.TestCase):
    def test_are_exposed_for_the_typical_pixel_and_not_for_the_lamp(self):
        room = numpy.full((20, 20, 3), 0.05)
        self.assertEqual(study_pictures.exposure_for(room), 2)
        room[0, :4] = 100
        room[10:] = 0
        self.assertEqual(study_pictures.exposure_for(room), 2)
        self.assertEqual(study_pictures.exposure_for(numpy.zeros((4, 4, 3))), 0)

    def test_share_one_scale_of_differences(self):
        values = numpy.linspace(-0.09, 0.09, 100)
        self.assertEqual(study_pictures.scale_for(values), 0.1)
        self.assertEqual(study_pictures.scale_for(100 * values), 5.0)


class ARun(unittest.TestCase):
    def test_takes_the_seconds_of_its_pilots_unless_they_compiled(self):
        seconds = [Run(Point(SOBOL, 1, 1, cold), "clrt", "x.exr", {"seconds": {"render": 2.0, **pilots}}, 1.0).render_seconds
                   for cold, pilots in ((False, {"pilots": 0.5}), (True, {"pilots": 9.0}), (False, {}))]
        self.assertEqual(seconds, [2.5, 2.0, 2.0])

    def test_is_ended_when_its_time_is_over(self):
        fake = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support", "fake_clrt.py")
        settings = {"FAKE_CLRT_SAMPLES": "1e9", "FAKE_CLRT_START": "60"}
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, settings):
            runner = study_runs.Runner(fake, "scene.obj", folder)
            begin = time.monotonic()
            with self.assertRaises(study_runs.OutOfTime):
                runner.run("late", Point(SOBOL, 1, 1), (), 1.0)
            self.assertLess(time.monotonic() - begin, 30)


class Errors(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.random = numpy.random.default_rng(1)
        self.truth = numpy.full((60, 80, 3), 0.5)

    def noisy(self, name, deviation):
        path = os.path.join(self.folder, name)
        mean = self.truth + self.random.normal(0, deviation, self.truth.shape)
        write_exr(path, mean, numpy.full(mean.shape, deviation ** 2))
        return path

    def run_of(self, name, deviation, seed=1, spp=16, render=2.0):
        return Run(Point(SOBOL, spp, seed), "clrt", self.noisy(name, deviation), stats(render), 1.0)

    def test_are_free_of_the_references_noise(self):
        # Of relMSE only in the numerator: there the reference is the better picture, as it should be.
        run = self.run_of("x.exr", 0.05)
        for files in (["a.exr", "b.exr"], ["a.exr"]):
            for noise, metric, expected in ((0.1, "rel_rmse", 0.05 / 0.5), (0.02, "relmse", 0.05 ** 2 / (1.01 * 0.25))):
                reference = study_results.reference_of_files([self.noisy(name, noise) for name in files])
                study_results.measure(run, reference)
                self.assertAlmostEqual(getattr(run, metric) / expected, 1, delta=0.06, msg=f"{files} {metric}")

    def test_of_another_size_are_refused(self):
        reference = study_results.Reference(numpy.ones((4, 5, 3)))
        with self.assertRaises(ValueError):
            study_results.measure(self.run_of("x.exr", 0.05), reference)

    def test_need_a_reference_of_radiance(self):
        path = os.path.join(self.folder, "a.png")
        image = OpenImageIO.ImageOutput.create(path)
        image.open(path, OpenImageIO.ImageSpec(80, 60, 3, OpenImageIO.UINT8))
        image.write_image(self.truth.astype(numpy.float32))
        image.close()
        with self.assertRaisesRegex(ValueError, "linear radiance"):
            study_results.reference_of_files([path])

    def test_of_repeats_are_averaged_as_squares(self):
        reference = study_results.Reference(self.truth)
        runs = [self.run_of(f"{i}.exr", deviation, i, render=render) for i, deviation, render in
                ((1, 0.03, 1.0), (2, 0.05, 2.0), (3, 0.04, 9.0))]
        for run in runs:
            study_results.measure(run, reference)
        summary, = study_results.summarise(runs, reference)[SOBOL]
        expected = ((0.03 ** 2 + 0.05 ** 2 + 0.04 ** 2) / 3) ** 0.5 / 0.5
        self.assertAlmostEqual(summary.error, expected, delta=0.002)
        self.assertAlmostEqual(summary.low, 0.06, delta=0.002)
        self.assertAlmostEqual(summary.high, 0.1, delta=0.002)
        self.assertEqual((summary.seconds, summary.repeats), (2.0, 3))
        self.assertAlmostEqual(summary.blocks.sum() / truth_pixels(self.truth), summary.error ** 2 * 0.25)

    def test_of_blocks_add_up_to_those_of_the_picture(self):
        run = self.run_of("x.exr", 0.05)
        study_results.measure(run, study_results.Reference(self.truth))
        for blocks, error in ((run.blocks, run.mse), (run.relative_blocks, run.relmse)):
            self.assertAlmostEqual(blocks.sum() / truth_pixels(self.truth) / error, 1)

    def test_below_the_references_noise_have_no_number(self):
        self.assertIsNone(study_results.relative_root(-1e-9, study_results.Reference(self.truth)))


if __name__ == "__main__":
    unittest.main()
