# SPDX-License-Identifier: Apache-2.0
"""tools/manpage.py: every program's page has all of its options, and man takes it without a warning. Arguments: programs."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
PROGRAMS = []


def run(*command, **settings):
    return subprocess.run(command, check=True, capture_output=True, text=True, **settings)


def page_of(program):
    return run(sys.executable, os.path.join(ROOT, "tools", "manpage.py"), program, "1.2.3").stdout


class ManPage(unittest.TestCase):
    def test_it_has_every_option_of_the_help(self):
        for program in PROGRAMS:
            page = page_of(program).replace("\\-", "-")
            entries = re.findall(r"^\.TP\n(.*)\n(.*)", page, re.M)
            for option in set(re.findall(r"^ {2,6}(?:-\w(?: \S+)?, )?(--[a-z-]+)", run(program, "--help").stdout, re.M)):
                with self.subTest(program=program, option=option):
                    found = [(re.sub(r"\\f.", "", name), text) for name, text in entries if f"\\fB{option}\\fR" in name]
                    self.assertTrue(found and all(len(name) < 50 and len(text) > 4 for name, text in found), found)

    def test_it_says_name_version_and_exit_codes(self):
        for program in PROGRAMS:
            page = page_of(program)
            with self.subTest(program=program):
                self.assertIn("1.2.3", page.splitlines()[0])
                for section in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS"):
                    self.assertEqual(page.count(f"\n.SH {section}\n"), 1, section)

    def test_it_explains_the_lines_of_the_report(self):
        source = "".join(pathlib.Path(ROOT, "src", name).read_text(encoding="utf-8") for name in
                         ("run/report_text.cpp", "run/denoising.cpp", "render/error_text.cpp", "render/cut_paths.cpp", "paths/blind_spots.cpp"))
        labels = {label.strip() for label in re.findall(r'"([a-z][a-z ]{7} )\S', source) if re.match(r"[a-z ]{8} ", label)}
        self.assertTrue({"picture", "error", "verdict", "price", "left out", "not seen", "tails"} <= labels, labels)
        page = next(page_of(program) for program in PROGRAMS if os.path.basename(program) == "clrt")
        report = page[page.index(".SH REPORT"):]
        for label in labels - {"by", "stages", "checked", "absent", "paths", "forecast", "measured", "lacks up", "half the"}:
            with self.subTest(label=label):
                self.assertRegex(report, rf"\.B (.*, )?{label}(,| |\n)")
        for term in ("RMSE", "replicate", "interval", "spp", "slope", "pass"):
            self.assertIn(term, report)

    @unittest.skipUnless(shutil.which("groff"), "needs groff")
    def test_groff_takes_it_without_a_warning(self):
        for program in PROGRAMS:
            result = run("groff", "-man", "-Tutf8", "-ww", "-z", input=page_of(program))
            self.assertEqual(result.stderr, "", program)


if __name__ == "__main__":
    PROGRAMS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
