# SPDX-License-Identifier: Apache-2.0
"""The command clrt-slurm with the built clrt and a sbatch that runs its scripts at once: slurm_command_test.py PATH/clrt.
tools/slurm/test has Slurm itself."""
import hashlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
sys.path.insert(0, TOOLS)
from clrt_tools import film_header, slurm_plan  # noqa: E402

CLRT = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")

# Runs every task of an array, last first, then the script without one; SKIP names tasks that a machine loses.
SBATCH = r"""#!/usr/bin/python3
import os, re, subprocess, sys
script = sys.argv[-1]
with open(script) as file:
    array = re.search(r"--array=([\d,-]+)", file.read())
tasks = [int(task) for part in array.group(1).split(",") for task in
         range(int(part.split("-")[0]), int(part.split("-")[-1]) + 1)] if array else [None]
for task in reversed(tasks):
    if str(task) in os.environ.get("SKIP", "").split():
        continue
    log = open(os.path.join(os.path.dirname(script), f"task-{task}.log" if array else "merge.log"), "a")
    subprocess.run(["sh", script], env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)}, stdout=log, stderr=log)
print("7")
"""


class SlurmCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("sbatch", SBATCH)
        os.chmod(self.path("sbatch"), 0o755)
        self.write("a.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n")

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def run_program(self, *command, **variables):
        environment = {**os.environ, "CLRT_DEVICE": DEVICE, "PATH": self.folder + os.pathsep + os.environ["PATH"], **variables}
        return subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, check=False, timeout=300)

    def slurm(self, *arguments, **variables):
        return self.run_program(sys.executable, os.path.join(TOOLS, "clrt-slurm"), *arguments, **variables)

    def submit(self, *arguments, **variables):
        done = self.slurm("submit", "job", "-s", "32", "-k", "4", "--clrt", CLRT, *arguments, "--", "a.obj", "-r", "16x12",
                          **variables)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def sums(self, path):
        with open(self.path(path), "rb") as file:
            content = file.read()
        header, start = film_header.parse_header(content)
        return header["ranges"], hashlib.md5(content[start:-16]).hexdigest()

    def test_the_array_makes_the_film_of_one_run(self):
        self.submit(SKIP="1 2")
        told = self.slurm("status", "job")
        self.assertEqual(told.returncode, 1)
        self.assertIn("parts    2 of 4 are there, samples 0 to 7, 24 to 31", told.stdout)
        self.assertIn("missing  samples 8 to 23: ", told.stdout)
        self.assertIn("--array=1-2)", told.stdout)
        self.assertTrue(os.path.exists(self.path("job/picture.exr")), "the picture so far")
        # A part that is cut off does not count, nor one that is another scene's.
        os.truncate(self.path("job/part-0003.film"), os.path.getsize(self.path("job/part-0003.film")) - 9)
        os.remove(self.path("job/sum.film"))
        self.assertRegex(self.slurm("status", "job").stdout, "part 3 +is left out: .*truncated")
        self.assertIn("3 tasks, samples 8 to 31", self.slurm("submit", "job").stdout)
        self.assertIn("4 of 4 are there", self.read("job/merge.log"))
        self.assertEqual(self.slurm("status", "job").returncode, 0)
        self.assertIn("nothing is submitted", self.slurm("submit", "job").stdout)
        one = self.run_program(CLRT, "a.obj", "-r", "16x12", "-s", "32", "--guide", "off", "--checkpoint", "one.film")
        self.assertEqual(one.returncode, 0, one.stderr)
        self.assertEqual(self.sums("job/sum.film"), self.sums("one.film"))
        # Whole parts are not rendered again.
        again = self.slurm("task", "job", "--task", "1")
        self.assertEqual((again.returncode, again.stdout), (0, "part 1: whole\n"))

    def test_the_rest_is_not_rendered_when_the_error_is_reached(self):
        self.write("scancel", "#!/bin/sh\n")
        self.submit("--error", "100%")
        self.assertIn("--error is reached", self.read("job/task-3.log"))
        self.assertIn("nothing is left to render", self.read("job/task-0.log"))
        told = self.slurm("status", "job")
        self.assertEqual(told.returncode, 0)
        self.assertIn("reached  --error 100%", told.stdout)

    def test_frames_are_those_of_one_run(self):
        words = ("a.obj", "-r", "16x12", "--env", "1,1,1")
        done = self.slurm("submit", "turn", "--frames", "3", "-s", "8", "-o", "t.exr", "--clrt", CLRT, "--", *words, SKIP="1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("3 tasks, frames 1 to 3", done.stdout)
        told = self.slurm("status", "turn")
        self.assertEqual(told.returncode, 1)
        self.assertIn("parts    2 of 3 are there, frames 1 to 1, 3 to 3", told.stdout)
        self.assertIn("missing  frames 2 to 2: ", told.stdout)
        os.utime(self.path("t-0001.exr"), (1, 1))
        self.assertIn("1 tasks, frames 2 to 2", self.slurm("submit", "turn").stdout)
        self.assertEqual(self.slurm("status", "turn").returncode, 0)
        self.assertIn("all frames are there", self.slurm("submit", "turn").stdout)
        self.assertEqual(self.slurm("task", "turn", "--task", "0").stdout, "frame 1: is there\n")
        self.assertEqual(os.stat(self.path("t-0001.exr")).st_mtime, 1, "it is not rendered again")
        one = self.run_program(CLRT, *words, "-s", "8", "--frames", "3", "-o", "one.exr")
        self.assertEqual(one.returncode, 0, one.stderr)
        for frame in range(1, 4):
            pixels = [self.pixels(f"{name}-{frame:04}.exr") for name in ("one", "t")]
            self.assertEqual(*pixels)

    def pixels(self, name):
        import OpenImageIO
        image = OpenImageIO.ImageBuf(self.path(name))
        return image.get_pixels(OpenImageIO.FLOAT)[..., :3].tobytes()

    def task_with_signal(self, number):
        """A task that gets a signal when it has saved its film; returns it and what scontrol was asked."""
        self.write("scontrol", '#!/bin/sh\necho "$@" >> "$0.log"\n')
        os.chmod(self.path("scontrol"), 0o755)
        done = self.slurm("submit", "job", "-s", "2000000", "-k", "1", "--checkpoint", "0.2s", "--clrt", CLRT, "--dry-run", "--",
                          "a.obj", "-r", "16x12", "--env", "1,1,1")
        self.assertEqual(done.returncode, 0, done.stderr)
        environment = {**os.environ, "CLRT_DEVICE": DEVICE, "PATH": self.folder + os.pathsep + os.environ["PATH"],
                       "SLURM_JOB_ID": "17"}
        command = [sys.executable, os.path.join(TOOLS, "clrt-slurm"), "task", "job", "--task", "0"]
        with subprocess.Popen(command, cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True) as task:
            for _ in range(1000):
                if os.path.exists(self.path("job/part-0000.film")):
                    break
                time.sleep(0.05)
            task.send_signal(number)
            text = task.communicate(timeout=100)[0]
        asked = self.read("scontrol.log") if os.path.exists(self.path("scontrol.log")) else ""
        return task.returncode, text, asked

    def test_a_task_whose_time_is_over_saves_its_film_and_is_requeued(self):
        code, text, asked = self.task_with_signal(signal.SIGUSR1)
        self.assertEqual(code, 143, text)
        self.assertIn("part 0: its time is over, it is requeued", text)
        self.assertEqual(asked, "requeue 17\n")
        self.assertGreater(self.sums("job/part-0000.film")[0][0][1], 0)

    def test_a_task_that_is_cancelled_is_not(self):
        code, text, asked = self.task_with_signal(signal.SIGTERM)
        self.assertEqual((code, asked), (143, ""), text)
        self.assertGreater(self.sums("job/part-0000.film")[0][0][1], 0)

    def test_another_version_is_refused_before_it_renders(self):
        self.submit("--dry-run")
        plan = slurm_plan.read_plan(self.path("job/job.json"))
        plan.version = "clrt 0.0.9"
        self.write("job/job.json", plan.text())
        done = self.slurm("task", "job", "--task", "0")
        self.assertEqual(done.returncode, 1)
        self.assertIn("expected clrt 0.0.9", done.stderr)
        self.assertFalse(os.path.exists(self.path("job/part-0000.film")))

    def test_wrong_command_lines_say_what_to_do(self):
        for arguments, message in (
                (("submit", "job", "-s", "8"), "expected a scene behind --"),
                (("submit", "job", "--", "a.obj"), "expected --spp"),
                (("submit", "job", "-s", "8", "--", "a.obj", "--adaptive"), "films of it do not merge"),
                (("submit", "job", "--frames", "3", "-k", "2", "--", "a.obj"), "a task is a frame"),
                (("submit", "job", "-s", "8", "--error", "x", "--", "a.obj"), "expected an error above 0"),
                (("status", "job"), "expected the folder of a job"), (("render", "job"), "invalid choice")):
            done = self.slurm(arguments[0], "--clrt", CLRT, *arguments[1:])
            self.assertEqual(done.returncode, 2, arguments)
            self.assertRegex(done.stderr, re.escape(message))
            self.assertEqual(done.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
