# SPDX-License-Identifier: Apache-2.0
"""Every program as it is installed, end to end and small: from the install tree and from the Debian package, both made
from the build: installed_tools_test.py CMAKE CPACK BUILD-FOLDER."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

CMAKE, CPACK, BUILD = sys.argv[1:4] if len(sys.argv) > 3 else ("cmake", "cpack", "build")
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")
PROGRAMS = ["clrt", "clrt-agree", "clrt-bench", "clrt-compare", "clrt-cycles", "clrt-merge", "clrt-mitsuba", "clrt-slurm", "clrt-stability",
            "clrt-study"]
SECONDS = 300  # a program that takes longer hangs

EQUIVALENT, DIFFERENT, FAILED_CHECK = 0, 1, 4


def environment(prefix):
    """What a user has after the installation: nothing that points to the source or the build."""
    kept = {name: value for name, value in os.environ.items()
            if not name.startswith("CLRT_") and name not in ("LD_LIBRARY_PATH", "PYTHONPATH", "POCL_KERNEL_CACHE")}
    return {**kept, "PATH": os.path.join(prefix, "bin") + os.pathsep + os.environ["PATH"], "CLRT_DEVICE": DEVICE}


def check_run(*command, **settings):
    """Runs a command that prepares the tests."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False, **settings)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


class InstalledTools:
    """The tests of one installation below `prefix`."""
    prefix = ""  # set by the classes below

    @classmethod
    def make_scratch(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        return folder.name

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.scene = os.path.join(self.prefix, "share", "clrt", "scenes", "cornell_box", "cornell_box.obj")

    def run_program(self, name, *arguments, code=0):
        """Runs a program by its name alone, as from a shell, and checks its exit code."""
        settings = environment(self.prefix)
        path = shutil.which(name, path=settings["PATH"])
        self.assertEqual(path, os.path.join(self.prefix, "bin", name))
        done = subprocess.run([path, *arguments], cwd=self.folder, env=settings, capture_output=True, text=True,
                              timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, code, f"{name} {' '.join(arguments)}:\n{done.stdout}{done.stderr}")
        return done.stdout

    def read_json(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return json.load(file)

    def test_every_program_is_there_with_its_help_and_man_page(self):
        self.assertEqual(sorted(os.listdir(os.path.join(self.prefix, "bin"))), PROGRAMS, "each has a test below")
        for name in PROGRAMS:
            self.assertIn(name, self.run_program(name, "--help"))
            self.assertTrue(os.path.exists(os.path.join(self.prefix, "share", "man", "man1", name + ".1")), name)

    def test_clrt_renders_what_clrt_merge_adds_up_and_clrt_compare_judges(self):
        def render(name, first, count):
            self.run_program("clrt", self.scene, "-r", "32x24", "--first-sample", str(first), "-s", str(count), "-q",
                             "--checkpoint", name + ".film", "-o", name + ".pfm")
        render("first", 0, 8)
        render("second", 8, 8)
        render("whole", 0, 16)
        self.run_program("clrt-merge", "first.film", "second.film", "-o", "merged.pfm")
        self.run_program("clrt-compare", "--exact", "whole.pfm", "merged.pfm", "--stats", "compare.json",
                         "-o", "difference.png", code=EQUIVALENT)
        self.assertEqual({metric["value"] for metric in self.read_json("compare.json")["metrics"]
                          if metric["name"] != "FLIP"}, {0})
        with open(os.path.join(self.folder, "difference.png"), "rb") as drawing:
            self.assertEqual(drawing.read(4), b"\x89PNG")
        self.run_program("clrt-compare", "--exact", "whole.pfm", "first.pfm", "--margin", "0.001%", code=DIFFERENT)

    def test_clrt_study_measures_the_clrt_beside_it(self):
        self.run_program("clrt-study", self.scene, "-d", DEVICE, "-i", "path", "-p", "single", "--samplers", "sobol",
                         "-r", "16x12", "--spp", "2,4", "--repeats", "1", "--reference-spp", "8", "-o", "page.html")
        with open(os.path.join(self.folder, "page.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["spp"] for row in rows}, {"2", "4"})
        for row in rows:
            self.assertEqual(row["command"].split()[0], os.path.join(self.prefix, "bin", "clrt"))
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            self.assertIn("<svg", file.read())

    def test_what_other_renderers_show_otherwise_is_refused(self):
        glossy = os.path.join(self.prefix, "share", "clrt", "scenes", "glossy_plates", "glossy_plates.obj")
        for program in ("clrt-mitsuba", "clrt-cycles"):
            self.run_program(program, glossy, "-o", "series", code=1)
        self.assertEqual(os.listdir(self.folder), [])

    def test_clrt_bench_compares_with_embree(self):
        self.run_program("clrt-bench", self.scene, "--rays", "4096", "--rounds", "1", "--stats", "bench.json")
        ratios = self.read_json("bench.json")["ratio"]
        self.assertEqual(sorted(ratios), ["diffuse", "mirror", "primary", "shadow"])

    def test_clrt_slurm_renders_a_part_and_tells_what_is_missing(self):
        printed = self.run_program("clrt-slurm", "submit", "job", "-s", "16", "-k", "2", "--dry-run", "--", self.scene, "-r", "32x24")
        self.assertIn("sbatch --parsable ", printed)
        self.run_program("clrt-slurm", "task", "job", "--task", "1")
        self.assertIn("missing  samples 0 to 7: ", self.run_program("clrt-slurm", "status", "job", code=1))

    def test_clrt_stability_runs_a_case_and_times_what_it_is_about(self):
        self.run_program("clrt-stability", "--case", "L06", "--rounds", "1", "--stats", "report.json",
                         "-o", "page.html")
        report = self.read_json("report.json")
        self.assertTrue(report["holds"])
        self.assertEqual([cost["case"] for cost in report["costs"]], ["L06"])
        self.assertGreater(report["costs"][0]["ratio"], 0)
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            self.assertIn("L06 SolidAngle", file.read())

    def test_clrt_stability_takes_the_scenes_that_are_installed(self):
        # Seen from what it says when all of them are empty.
        scenes = os.path.join(self.prefix, "share", "clrt", "scenes")
        kept = shutil.copytree(scenes, os.path.join(self.folder, "scenes"))
        for name in os.listdir(scenes):
            with open(os.path.join(scenes, name, name + ".obj"), "w", encoding="utf-8") as file:
                file.write("v 0 0 0\n")
        try:
            self.run_program("clrt-stability", "--case", "X02", "--no-costs", "--stats", "report.json",
                             code=FAILED_CHECK)
        finally:
            shutil.copytree(kept, scenes, dirs_exist_ok=True)
        self.assertIn(scenes, self.read_json("report.json")["cases"][0]["error"])


class FromTheInstallTree(InstalledTools, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prefix = os.path.realpath(cls.make_scratch())
        check_run(CMAKE, "--install", BUILD, "--prefix", cls.prefix)


@unittest.skipUnless(shutil.which("dpkg-shlibdeps") and shutil.which("file"), "needs dpkg-dev and file")
class FromTheDebianPackage(InstalledTools, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        root = os.path.realpath(cls.make_scratch())
        made = os.path.join(root, "made")
        check_run(CPACK, "-G", "DEB", "--config", os.path.join(BUILD, "CPackConfig.cmake"), "-B", made, cwd=root)
        cls.package, = (os.path.join(made, name) for name in os.listdir(made) if name.endswith(".deb"))
        check_run("dpkg", "-x", cls.package, root)
        cls.prefix = os.path.join(root, "usr")

    def test_it_says_what_it_depends_on(self):
        depends = check_run("dpkg-deb", "-f", self.package, "Depends")
        for library in ("libopenimageio", "ocl-icd-libopencl1", "pocl-opencl-icd"):
            self.assertIn(library, depends)
        recommends = check_run("dpkg-deb", "-f", self.package, "Recommends")
        for library in ("python3-numpy", "python3-matplotlib"):
            self.assertIn(library, recommends)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
