# SPDX-License-Identifier: Apache-2.0
"""The command clrt-compare: exit codes, what it prints and writes, odd files."""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy
import OpenImageIO

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from noisy_pictures import TOOLS, film_bytes, noisy_replicates, picture_of, write_exr  # noqa: E402

EQUIVALENT, DIFFERENT, USAGE, UNDECIDED = 0, 1, 2, 5
SIZE = (48, 64, 3)


class CompareCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def exr(self, name, level=1.0, deviation=0.01, seed=0, layers=True):
        """Writes a grey picture with noise."""
        random = numpy.random.default_rng(seed)
        picture = picture_of(noisy_replicates(random, numpy.full(SIZE, level), deviation))
        write_exr(self.path(name), picture.mean, picture.variance if layers else None, 64 if layers else None)
        return self.path(name)

    def display(self, name, values):
        """Writes encoded values (height, width, channels) of 0 to 1 as an 8-bit file."""
        spec = OpenImageIO.ImageSpec(values.shape[1], values.shape[0], values.shape[2], OpenImageIO.UINT8)
        spec.attribute("CompressionQuality", 100)
        spec.attribute("oiio:UnassociatedAlpha", 1)
        output = OpenImageIO.ImageOutput.create(self.path(name))
        self.assertTrue(output.open(self.path(name), spec), output.geterror())
        output.write_image(values.astype(numpy.float32))
        output.close()
        return self.path(name)

    def film(self, name, level, seed):
        random = numpy.random.default_rng(seed)
        sums = numpy.rint(noisy_replicates(random, numpy.full(SIZE, level), 0.01) * 8 * 2 ** 20).astype(int)
        with open(self.path(name), "wb") as file:
            file.write(film_bytes(sums, 2.0 ** -20, [[0, 64]], seed=seed))
        return self.path(name)

    def run_command(self, *arguments):
        """Returns exit code, stdout, stderr."""
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-compare"), *arguments], cwd=self.folder,
                              capture_output=True, text=True, timeout=120, check=False)
        self.assertNotIn("Traceback", done.stderr)
        return done.returncode, done.stdout, done.stderr

    def test_verdicts_are_exit_codes(self):
        a = self.exr("a.exr")
        for level, deviation, margin, code, word in ((1, 0.01, "2%", EQUIVALENT, "equivalent within 2 %"),
                                                     (1.1, 0.01, "2%", DIFFERENT, "different"),
                                                     (1, 0.5, "0.002", UNDECIDED, "undecided")):
            found, out, _ = self.run_command(a, self.exr("b.exr", level, deviation, 1), "--margin", margin)
            self.assertEqual(found, code, out)
            self.assertIn("verdict   " + word, out)
            self.assertIn("mean (a-b)^2 / (b^2 + (0.1 mean b)^2)", out)
            self.assertIn("pixels taken as independent", out)

    def test_films_bring_their_replicates(self):
        a, b, c = (self.film(name, level, seed) for name, level, seed in (("a", 1, 1), ("b", 1, 2), ("c", 1.05, 3)))
        found, out, _ = self.run_command(a, b, "--margin", "3%")
        self.assertEqual(found, EQUIVALENT, out)
        self.assertIn("spread of 8 replicates", out)
        self.assertEqual(self.run_command(a, c)[0], DIFFERENT)
        # A film and an EXR of the same picture.
        self.assertEqual(self.run_command(a, self.exr("a.exr", seed=9), "--margin", "3%")[0], EQUIVALENT)

    def test_a_reference_without_noise_layer_needs_its_other_half(self):
        a = self.exr("a.exr", 1.05)
        first, second = (self.exr(f"r{seed}.exr", seed=seed, layers=False) for seed in (1, 2))
        code, out, _ = self.run_command(a, first)
        self.assertEqual((code, "--halves" in out), (UNDECIDED, True), out)
        code, out, _ = self.run_command(a, first, "--halves", second)
        self.assertEqual((code, "sqrt(mean (a-b1)(a-b2))" in out), (DIFFERENT, True), out)
        self.assertEqual(self.run_command(a, first, "--exact")[0], DIFFERENT)
        self.assertEqual(self.run_command(self.exr("c.exr", seed=7), first, "--halves", second, "--margin", "3%")[0], EQUIVALENT)

    def test_json_has_the_numbers_and_the_verdict(self):
        a, b = self.exr("a.exr"), self.exr("b.exr", 1.1, seed=1)
        for option in ("--stats", "--json"):
            self.assertEqual(self.run_command(a, b, option, "out.json")[0], DIFFERENT)
            with open(self.path("out.json"), encoding="utf-8") as file:
                content = json.load(file)
            self.assertEqual(content["verdict"], "different")
            values = {metric["name"]: metric["value"] for metric in content["metrics"]}
            self.assertAlmostEqual(values["bias"], 1 / 1.1 - 1, places=3)
            self.assertEqual(content["tiles"], [2, 2])
            self.assertLess(content["smallest_p"], 0.01)
            self.assertEqual(content["rejected_tiles"], 4)

    def numbers(self, *arguments):
        """(exit code, JSON, stdout)."""
        code, out, error = self.run_command(*arguments, "--stats", "out.json")
        self.assertEqual(error, "")
        with open(self.path("out.json"), encoding="utf-8") as file:
            return code, json.load(file), out

    def test_8_bit_pictures_give_metrics_of_decoded_values_and_no_verdict(self):
        grey = numpy.full(SIZE, 0.5)
        a, b = self.display("a.png", grey), self.display("b.png", grey + 0.1)
        code, content, out = self.numbers(a, b)
        self.assertEqual((code, content["verdict"]), (UNDECIDED, "undecided"), out)

        def decoded(encoded):
            return ((round(255 * encoded) / 255 + 0.055) / 1.055) ** 2.4
        values = {metric["name"]: metric["value"] for metric in content["metrics"]}
        self.assertAlmostEqual(values["RMSE"], decoded(0.6) - decoded(0.5), places=5)
        self.assertEqual(content["a"]["encoding"], "8-bit, decoded as sRGB")
        for words in ("clipping", "tone curve", "quantised", "EXR"):
            self.assertIn(words, out)
        self.assertNotIn("--margin", out)
        self.assertEqual(self.run_command(a, b, "--exact")[0], DIFFERENT)
        self.assertEqual(self.run_command(a, b, "--exact", "--margin", "50%")[0], EQUIVALENT)

    def test_the_same_8_bit_pictures_are_the_same(self):
        values = numpy.random.default_rng(1).random(SIZE)
        code, _, out = self.numbers(self.display("a.png", values), self.display("b.tif", values))
        self.assertEqual((code, "the same" in out), (EQUIVALENT, True), out)

    def test_8_bit_files_of_all_kinds_are_read(self):
        # Grey is red, green and blue; what is transparent lies over black, by linear coverage.
        grey = self.display("grey.png", numpy.full(SIZE[:2] + (1,), 0.5))
        rgba = self.display("rgba.png", numpy.concatenate([numpy.full(SIZE, 0.5), numpy.full(SIZE[:2] + (1,), 0.2)], axis=-1))
        jpeg = self.display("a.jpg", numpy.full(SIZE, 0.5))
        self.assertEqual(self.run_command(grey, jpeg)[0], EQUIVALENT)
        values = {m["name"]: m["value"] for m in self.numbers(rgba, grey)[1]["metrics"]}
        self.assertAlmostEqual(values["bias"], -0.8, places=3)

    def test_an_8_bit_picture_is_no_half_and_no_equivalent_of_a_float_one(self):
        level = ((128 / 255 + 0.055) / 1.055) ** 2.4
        png, exr = self.display("a.png", numpy.full(SIZE, 128 / 255)), self.exr("a.exr", level, 1e-4)
        code, out, _ = self.run_command(exr, png)
        self.assertEqual((code, "hint" in out, "compare EXR or film files" in out.splitlines()[-1]), (UNDECIDED, False, True), out)
        code, _, error = self.run_command(exr, png, "--halves", png)
        self.assertEqual((code, "--halves" in error), (USAGE, True), error)

    def test_hints_at_the_margin_that_would_decide(self):
        a = self.exr("a.exr")
        for level, deviation, margin in ((1, 0.2, "0.2%"), (1.05, 0.01, "0.5%"), (1, 0.01, "30%")):
            b = self.exr("b.exr", level, deviation, 1)
            code, out, _ = self.run_command(a, b, "--margin", margin)
            hint = re.search(r"(?m)^hint .*--margin ([\d.]+)%", out)
            self.assertTrue(hint, out)
            if margin != "30%":
                self.assertNotEqual(code, EQUIVALENT)
            self.assertEqual(self.run_command(a, b, "--margin", hint.group(1) + "%")[0], EQUIVALENT, out)
            self.assertNotEqual(self.run_command(a, b, "--margin", f"{0.8 * float(hint.group(1)):g}%")[0], EQUIVALENT, out)
        self.assertNotIn("hint", self.run_command(a, a)[1])

    def test_says_its_version_and_helps(self):
        self.assertRegex(self.run_command("--version")[1], r"^clrt-compare \d+\.\d+\.\d+\n$")
        page = self.run_command("--help")[1]
        self.assertEqual(re.findall(r"(?m)^([A-Z][a-z ]+):$", page), ["Example", "Arguments", "Options", "Exit codes"])
        self.assertEqual(re.findall(r"(?m)^  (\d+) ", page), ["0", "1", "5", "2"])
        self.assertIn("nearest is --margin", self.run_command("--margn", "1%")[2])

    def test_the_drawing_is_written_whole(self):
        a, b = self.exr("a.exr"), self.exr("b.exr", 1.1, seed=1)
        for show in ("signed", "error"):
            self.run_command(a, b, "-o", "difference.png", "--show", show)
            with open(self.path("difference.png"), "rb") as file:
                content = file.read()
            self.assertTrue(content.startswith(b"\x89PNG") and content.rstrip().endswith(b"IEND\xaeB`\x82"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.exr", "b.exr", "difference.png"])

    def test_sizes_and_crops_must_agree(self):
        a = self.exr("a.exr")
        write_exr(self.path("small.exr"), numpy.ones((4, 5, 3)))
        write_exr(self.path("crop.exr"), numpy.ones(SIZE), origin=(1, 2), full=(100, 100))
        for other, words in (("small.exr", "5x4"), ("crop.exr", "64x48 from 1,2 of 100x100")):
            code, _, error = self.run_command(a, other)
            self.assertEqual(code, USAGE)
            self.assertTrue(words in error and "64x48" in error and a in error and other in error, error)

    def test_odd_files_are_named(self):
        a = self.exr("a.exr")
        with open(a, "rb") as file:
            content = file.read()
        odd = {"cut.exr": content[:len(content) // 2], "empty.exr": b"", "text.exr": b"no picture\n",
               "start.exr": b"CLRTFILM", "ppm.ppm": b"P6 1 1 255\nabc"}
        for name, data in odd.items():
            with open(self.path(name), "wb") as file:
                file.write(data)
        for name in [*odd, "missing.exr", "."]:
            code, out, error = self.run_command(a, name)
            self.assertEqual((code, out), (USAGE, ""), name)
            self.assertIn(name, error)
            self.assertEqual(error.count("\n"), 1, error)

    def test_non_finite_pixels_are_a_failure(self):
        mean = numpy.ones(SIZE)
        mean[3, 4] = numpy.nan
        write_exr(self.path("nan.exr"), mean, 1e-6 * numpy.ones(SIZE), 64)
        code, out, _ = self.run_command("nan.exr", self.exr("a.exr"), "--margin", "50%", "-o", "d.png", "--stats", "s.json")
        self.assertEqual((code, "1 pixels are not finite" in out), (DIFFERENT, True), out)

    def test_inputs_are_never_replaced(self):
        grey = numpy.full(SIZE, 0.5)
        a, b = self.display("a.png", grey), self.display("b.png", grey)
        link = os.path.join(os.path.dirname(a), "link.png")
        os.symlink(a, link)
        with open(a, "rb") as file:
            before = file.read()
        for option in ("--stats", "-o"):
            code, _, err = self.run_command(a, b, option, link)
            self.assertEqual(code, 2)
            self.assertIn("would replace", err)
        with open(a, "rb") as file:
            self.assertEqual(file.read(), before)

    def test_wrong_options_are_usage_errors(self):
        a = self.exr("a.exr")
        for arguments in ((), (a,), (a, a, "--margin", "x"), (a, a, "--margin=-1"), (a, a, "--alpha", "0"),
                          (a, a, "--tile", "0"), (a, a, "--scale", "nan"), (a, a, "--unknown"), (a, a, "-o", "d.xyz")):
            code, _, error = self.run_command(*arguments)
            self.assertEqual((code, bool(error)), (USAGE, True), arguments)
            self.assertTrue(error.startswith("clrt-compare: error: ") and error.count("\n") == 1, error)
        self.assertEqual(self.run_command("--help")[0], 0)


if __name__ == "__main__":
    unittest.main()
