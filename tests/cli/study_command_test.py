# SPDX-License-Identifier: Apache-2.0
"""The command clrt-study with the built clrt: study_command_test.py PATH/clrt. A tiny scene, two methods."""
import csv
import html.parser
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
sys.path.insert(0, TOOLS)
from clrt_tools import study_runs  # noqa: E402
from clrt_tools.clrt_choices import Choices  # noqa: E402
from clrt_tools.study_methods import SWITCHES, Method  # noqa: E402

FAKE_CLRT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support", "fake_clrt.py")
CLRT = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")

SCENE = """mtllib scene.mtl
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v -1 -1 1
v 1 -1 1
usemtl matte
f 1 2 3 4
f 1 5 6 2
"""


class Parts(html.parser.HTMLParser):
    """Counts what a page holds."""

    def __init__(self):
        super().__init__()
        self.tags, self.sources = {}, []

    def handle_starttag(self, tag, attributes):
        self.tags[tag] = self.tags.get(tag, 0) + 1
        self.sources += [value for name, value in attributes if name in ("src", "href", "xlink:href") and value]


class StudyCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name, text in (("scene.obj", SCENE), ("scene.mtl", "newmtl matte\nKd 0.7 0.7 0.7\n")):
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                file.write(text)

    def run_command(self, *arguments, **settings):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-study"), *arguments], cwd=self.folder,
                              capture_output=True, text=True, timeout=300, check=False, env={**os.environ, **settings})
        self.assertNotIn("Traceback", done.stderr)
        return done

    def study(self, *arguments):
        return self.run_command("scene.obj", "--clrt", CLRT, "-d", DEVICE, "-i", "path", "-p", "single", "-r", "16x12",
                                "--repeats", "2", *self.usual_ways(arguments), *arguments)

    @staticmethod
    def usual_ways(arguments):
        """Leaves the ways to find the light as they are, but for those that the arguments name."""
        choices = Choices(CLRT)
        return [word for switch in SWITCHES.values()
                if not switch.combined and choices.has(switch.option) and "--" + switch.plural not in arguments
                for word in ("--" + switch.plural, choices.default(switch.option))]

    def test_makes_a_table_and_a_page_that_needs_no_network(self):
        done = self.study("--spp", "2,4", "--reference-spp", "32", "-o", "page.html", "--", "--exposure", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("[10/10]", done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["page.csv", "page.html", "scene.mtl", "scene.obj"])
        self.assertRegex(done.stdout, r"^An error of \d+ % costs .* at 16x12\. .*(Sobol points|white noise|Too few|not told apart)")
        for target in (10, 5, 2, 1):
            self.assertRegex(done.stdout, rf"(?m)^ +{target} %  \S")
        self.check_table()
        self.check_page(done.stdout.splitlines()[0])

    def check_table(self):
        with open(os.path.join(self.folder, "page.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({(r["sampler"], r["spp"], r["seed"]) for r in rows},
                         {(sampler, spp, seed) for sampler in ("sobol", "independent") for spp in "24" for seed in "12"})
        self.assertEqual(len(rows), 8)
        for row in rows:
            self.assertGreater(float(row["render_s"]), 0)
            self.assertGreater(float(row["process_cpu_s"]), 0)
            self.assertTrue(0 < float(row["rel_rmse"]) < 1, row)
            self.assertIn("--exposure 1", row["command"])
        self.assertEqual(sum(int(row["cold"]) for row in rows), 2)

    def check_page(self, headline):
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            text = file.read()
        self.assertNotRegex(text, r"https?:|url\((?!#)|@import")
        parts = Parts()
        parts.feed(text)
        for source in parts.sources:
            self.assertRegex(source, r"^(data:image/png;base64,|#)")
        self.assertEqual(parts.tags["svg"], 4)
        self.assertEqual(parts.tags["figure"], 5)
        self.assertEqual(text.count('<tr class="number">'), 4)
        self.assertEqual(text.count('<tr class="ratio">'), 1)
        # The answer comes first: the sentence, the table of seconds, what each change buys, then everything else.
        order = [text.index(part) for part in (headline, '<table id="times">', 'id="gains-chart"', '<table id="ratios">')]
        self.assertEqual(order, sorted(order))
        self.assertIn("path, single, independent", text)
        self.assertIn("--sampler independent", text)

    def test_reads_a_reference_and_keeps_pictures(self):
        done = self.study("--spp", "4", "--samplers", "sobol", "--repeats", "1", "--reference-spp", "8", "--keep", "kept")
        self.assertEqual(done.returncode, 0, done.stderr)
        kept = os.path.join(self.folder, "kept")
        self.assertIn("reference_a.exr", os.listdir(kept))
        halves = [os.path.join(kept, f"reference_{half}.exr") for half in "ab"]
        done = self.study("--spp", "4", "--samplers", "sobol", "--repeats", "1", "--reference", *halves)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("reference, half", done.stderr)

    def test_a_quick_study_measures_every_method_and_says_what_each_change_buys(self):
        # How it keeps within its seconds: study_session_test, which has a clock of its own.
        done = self.run_command("scene.obj", "--clrt", FAKE_CLRT, "--quick", "--spp", "4,16,64", "--repeats", "1", "-o", "page.html",
                                FAKE_CLRT_SAMPLES="4e6")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(self.folder, "page.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({(row["precision"], row["sampler"]) for row in rows},
                         {("single", "sobol"), ("single", "independent"), ("double", "sobol"), ("fast", "sobol")})
        self.assertRegex(done.stdout, r"Sobol points are \d+ times .* better than white noise; "
                                      r"double precision buys nothing: the same error in \S+ times .* the seconds")

    def test_the_page_says_what_was_dropped(self):
        done = self.run_command("scene.obj", "--clrt", FAKE_CLRT, "--quick", "--budget", "20", "-o", "page.html",
                                FAKE_CLRT_SAMPLES="5e4", FAKE_CLRT_START="1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "note: dropped, because there is no time for them: .*path, fast, sobol")
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            self.assertIn("dropped, because there is no time", file.read())

    def test_measures_a_way_to_find_the_light_where_clrt_takes_it(self):
        done = self.study("--samplers", "sobol", "--adaptive", "off," + Choices(CLRT).names("--adaptive")[1], "--spp", "2,32",
                          "--repeats", "1", "--reference-spp", "32", "-o", "page.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"note: path, single, sobol, adaptive \w+: not with 2 spp\. clrt: error: .*--adaptive")
        with open(os.path.join(self.folder, "page.csv"), newline="", encoding="utf-8") as file:
            rows = {(row["adaptive"], row["spp"]): row["command"] for row in csv.DictReader(file)}
        self.assertEqual(sorted(spp for _, spp in rows), ["2", "32", "32"])
        self.assertEqual(sorted("--adaptive" in command for command in rows.values()), [False, False, True])

    def test_says_which_switch_this_clrt_lacks(self):
        done = self.run_command("scene.obj", "--clrt", FAKE_CLRT, "--guides", "on")
        self.assertEqual(done.returncode, 2)
        self.assertIn("option --guides: expected a clrt that has --guide, found one without", done.stderr)

    def test_says_its_version_and_helps(self):
        done = self.run_command("--version")
        self.assertRegex(done.stdout, r"^clrt-study \d+\.\d+\.\d+\n$")
        page = self.run_command("--help").stdout
        self.assertEqual(re.findall(r"(?m)^([A-Z][a-z ]+):$", page), ["Example", "Arguments", "Options", "Exit codes"])
        self.assertEqual(re.findall(r"(?m)^  (\d+) ", page), ["0", "1", "2", "130"])

    def test_names_the_option_that_was_meant(self):
        self.assertIn("unknown option --quik; the nearest is --quick", self.run_command("--quik").stderr)
        self.assertIn("expected scene.obj, found none", self.run_command().stderr)

    def test_takes_the_names_that_clrt_takes(self):
        choices = Choices(CLRT)
        self.assertEqual(choices.names("--integrator"), ["mlt", "bdpt", "path+light", "path", "light", "distribution", "whitted",
                                                          "raycast", "auto"])
        self.assertEqual(choices.names("--precision"), ["single", "double", "fast"])
        self.assertEqual(choices.names("--sampler"), ["sobol", "independent"])
        self.assertEqual(choices.names("--adaptive")[0], "off")
        default = choices.default_method()
        self.assertEqual((default.integrator, default.precision, default.sampler, default.guide, default.adaptive),
                         ("path", "single", "sobol", "auto", "off"))
        self.assertEqual(study_runs.REFERENCE_METHOD, Method("path", "single", "sobol"))
        for option, found in (("-i", "path,pth"), ("-p", "half"), ("--samplers", "sobol,sobol"), ("--adaptive", "of")):
            done = self.run_command("scene.obj", "--clrt", CLRT, option, found)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, f"option --[a-z-]+: expected a list out of [a-z+, ]+, found '{found}'$")

    def test_says_what_it_cannot_do(self):
        for arguments, code in (((), 2), (("none.obj",), 2), (("scene.obj", "--spp", "0"), 2), (("scene.obj", "--clrt", CLRT, "-i", "none"), 2),
                                (("scene.obj", "-o", "page.txt"), 2), (("scene.obj", "--quik"), 2),
                                (("scene.obj", "--clrt", "./none"), 1),
                                (("scene.obj", "--clrt", CLRT, "-d", "no such device"), 1)):
            done = self.run_command(*arguments)
            self.assertEqual((done.returncode, bool(done.stderr)), (code, True), arguments)
            self.assertRegex(done.stderr.splitlines()[-1], "^clrt-study: error: ", arguments)
        self.assertEqual(sorted(os.listdir(self.folder)), ["scene.mtl", "scene.obj"])


if __name__ == "__main__":
    unittest.main()
