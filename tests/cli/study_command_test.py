# SPDX-License-Identifier: Apache-2.0
"""The command clrt-study with the built clrt: study_command_test.py PATH/clrt. A tiny scene, two methods."""
import csv
import html.parser
import os
import subprocess
import sys
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
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

    def run_command(self, *arguments):
        done = subprocess.run([sys.executable, os.path.join(TOOLS, "clrt-study"), *arguments], cwd=self.folder,
                              capture_output=True, text=True, timeout=300, check=False)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def study(self, *arguments):
        return self.run_command("scene.obj", "--clrt", CLRT, "-d", DEVICE, "-i", "path", "-p", "single", "-r", "16x12",
                                "--repeats", "2", *arguments)

    def test_makes_a_table_and_a_page_that_needs_no_network(self):
        done = self.study("--spp", "2,4", "--reference-spp", "32", "-o", "page.html", "--", "--exposure", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("[10/10]", done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["page.csv", "page.html", "scene.mtl", "scene.obj"])
        self.check_table()
        self.check_page()

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

    def check_page(self):
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            text = file.read()
        self.assertNotRegex(text, r"https?:|url\((?!#)|@import")
        parts = Parts()
        parts.feed(text)
        for source in parts.sources:
            self.assertRegex(source, r"^(data:image/png;base64,|#)")
        self.assertEqual(parts.tags["svg"], 4)
        self.assertEqual(parts.tags["figure"], 2)
        self.assertEqual(text.count("<tr><td>"), 4)
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

    def test_says_what_it_cannot_do(self):
        for arguments, code in (((), 2), (("none.obj",), 2), (("scene.obj", "--spp", "0"), 2), (("scene.obj", "-i", "none"), 2),
                                (("scene.obj", "-o", "page.txt"), 2), (("scene.obj", "--clrt", "./none"), 1),
                                (("scene.obj", "--clrt", CLRT, "-d", "no such device"), 1)):
            done = self.run_command(*arguments)
            self.assertEqual((done.returncode, bool(done.stderr)), (code, True), arguments)
        self.assertEqual(sorted(os.listdir(self.folder)), ["scene.mtl", "scene.obj"])


if __name__ == "__main__":
    unittest.main()
