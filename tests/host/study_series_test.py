# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/study_series.py: another renderer's pictures, as they are read and as they are compared."""
import json
import os
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from noisy_pictures import write_exr  # noqa: E402
from clrt_tools import study_page, study_report, study_results  # noqa: E402
from clrt_tools.mean_check import compare_means  # noqa: E402
from clrt_tools.picture_file import UnreadableFile  # noqa: E402
from clrt_tools.study_methods import Method  # noqa: E402
from clrt_tools.study_runs import Point, Run  # noqa: E402
from clrt_tools.study_series import SeriesError, read_all_series, read_series  # noqa: E402

SHAPE = (60, 80, 3)
TRUTH = 0.5
SOBOL = Method("path", "single", "sobol")
REFERENCE = study_results.Reference(numpy.full(SHAPE, TRUTH))


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.random = numpy.random.default_rng(1)

    def picture(self, name, error=0.1, truth=TRUTH, shape=SHAPE):
        write_exr(os.path.join(self.folder, name), truth * (1 + self.random.normal(0, error, shape)))
        return name

    def write(self, content):
        with open(os.path.join(self.folder, "series.json"), "w", encoding="utf-8") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))

    def write_series(self, counts=(4, 16), error=1.0, second=0.1, truth=TRUTH):
        """`error`: relative, of one sample; `second`: of a sample."""
        self.write({"name": "Rival 1.0", "pictures": [
            {"file": self.picture(f"{spp}_{seed}.exr", error * spp ** -0.5, truth), "spp": spp, "seed": seed,
             "seconds": spp * second * (1 + 0.01 * seed)} for spp in counts for seed in (1, 2, 3)]})


class Reading(Folder):
    def test_takes_pictures_with_their_seconds(self):
        self.write_series()
        series = read_series(self.folder)
        self.assertEqual((str(series.rival), series.size, len(series.runs)), ("Rival 1.0", (80, 60), 6))
        self.assertAlmostEqual(series.runs[0].render_seconds, 0.404)
        self.assertIsNone(series.runs[0].cpu_seconds)

    def test_names_the_file_what_was_expected_and_what_was_found(self):
        good = {"file": self.picture("a.exr"), "spp": 4, "seed": 1, "seconds": 0.5}
        other = {**good, "seed": 2, "file": self.picture("b.exr", shape=(30, 40, 3))}
        for content, expected in (
                ("{", "series.json: expected JSON, found: "), ([], 'series.json: expected {"name"'),
                ({"name": "x", "pictures": []}, "expected one picture or more, found none"),
                ({"name": "x", "pictures": [{**good, "spp": "4"}]}, "picture 1: expected \"spp\", a number of at least 1, found '4'"),
                ({"name": "x", "pictures": [{**good, "seconds": 0}]}, 'picture 1: expected "seconds", a number of at least 1e-09, found 0'),
                ({"name": "x", "pictures": [good, {"spp": 4}]}, 'picture 2: expected "file", a file name, found None'),
                ({"name": "x", "pictures": [good, good]}, "expected one picture for each spp and seed, found two"),
                ({"name": "x", "pictures": [good, other]}, "b.exr: expected 80x60 pixels like .*a.exr, found 40x30")):
            self.write(content)
            with self.subTest(expected=expected), self.assertRaisesRegex(SeriesError, expected):
                read_series(self.folder)
        self.write({"name": "x", "pictures": [{**good, "file": "none.exr"}]})
        with self.assertRaisesRegex(UnreadableFile, "none.exr: expected a picture, found none"):
            read_series(self.folder)
        with self.assertRaisesRegex(SeriesError, "none.*series.json: expected the list of another renderer's pictures, found none"):
            read_series(os.path.join(self.folder, "none"))


    def test_of_several_renderers_needs_one_size_and_different_names(self):
        self.write_series()
        self.assertEqual(len(read_all_series([self.folder], "80x60")), 1)
        self.assertEqual(read_all_series([], "80x60"), [])
        with self.assertRaisesRegex(SeriesError, "expected pictures of 40x30, found 80x60"):
            read_all_series([self.folder], "40x30")
        with self.assertRaisesRegex(SeriesError, "expected renderers of different names, found Rival 1.0 twice"):
            read_all_series([self.folder, self.folder], None)


class Comparing(Folder):
    def runs(self, counts, error, second):
        """Of clrt."""
        made = []
        for spp in counts:
            for seed in (1, 2, 3):
                seconds = {"load": 0, "bvh": 0, "compile": 0, "first_launch": 0, "render": spp * second * (1 + 0.01 * seed)}
                stats = {"seconds": seconds, "width": SHAPE[1], "height": SHAPE[0], "spp": spp}
                path = os.path.join(self.folder, self.picture(f"own_{spp}_{seed}.exr", error * spp ** -0.5))
                made.append(Run(Point(SOBOL, spp, seed), "clrt", path, stats, 1.0))
        return made

    def conclude(self, **rival):
        self.write_series(**rival)
        series, runs = read_series(self.folder), self.runs((4, 16), 1.0, 0.1)
        for run in runs + series.runs:
            study_results.measure(run, REFERENCE)
        return series, study_report.conclude(runs, REFERENCE, {}, [], SHAPE[1::-1], [], [series])

    def test_is_at_about_the_same_seconds(self):
        # Half the error at the same samples, five times the seconds of a sample: 1.25 times the cost.
        series, study = self.conclude(counts=(3, 16), error=0.5, second=0.5)
        ratio = study.ratios[series.rival]
        self.assertEqual(ratio.spp, "3 v 16")
        self.assertAlmostEqual(ratio.cost.value, 1.25, delta=0.15)
        self.assertTrue(ratio.cost.low < 1.25 < ratio.cost.high and ratio.cost.high / ratio.cost.low < 1.5, ratio.cost)
        self.assertAlmostEqual(ratio.relative_cost.value, ratio.cost.value, delta=0.01)
        self.assertAlmostEqual(study.times[series.rival][0].seconds.value, 25 * 0.5, delta=2)  # 10 % takes 25 samples

    def test_is_said_and_drawn(self):
        series, study = self.conclude(error=3.0)
        self.assertRegex(study.headline, r"clrt's default and Rival 1\.0: [89](\.\d)? times \(.*\) its accuracy a second by the squared "
                                         r"error, \S+ times \(.*\) its accuracy a second by the relative squared error\.$")
        gains = study_page.gains(study, {series.rival: "Rival 1.0"})["Rival 1.0"]
        self.assertAlmostEqual(gains[0].value, 1 / 9, delta=0.02)

    def test_warns_of_another_scene(self):
        self.assertEqual(self.conclude()[0].brightness_note(), "")
        note = self.conclude(truth=1.1 * TRUTH, error=0.1)[1].notes[0]
        self.assertRegex(note, "^Rival 1.0: its pictures are 1?[09].[0-9] % brighter than the reference: it renders another scene")

    def test_of_means_knows_how_well_they_are_known(self):
        self.assertFalse(compare_means([1.0, 1.1, 0.9], [1.05, 0.95, 1.08]).differs)
        self.assertTrue(compare_means([1.0, 1.001, 0.999], [1.02, 1.021, 1.019]).differs)
        self.assertEqual(str(compare_means([1.0, 1.0], [1.001, 1.001])), "+0.10 % +- 0.00 %")
        self.assertFalse(compare_means([1.0, 1.0], [1.001, 1.001]).differs, "nobody sees that")
        with self.assertRaises(ValueError):
            compare_means([0, 0], [1, 1])


if __name__ == "__main__":
    unittest.main()
