# SPDX-License-Identifier: Apache-2.0
"""clrt-slurm without Slurm: ranges of samples, scripts, what a part's film says, what is missing."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
sys.path.insert(0, TOOLS)
from clrt_tools import film_header, slurm_parts, slurm_plan  # noqa: E402


def make_plan(**changes):
    values = {"words": ["a b.obj", "-r", "64x48"], "folder": "/home/x", "clrt": "/opt/clrt/bin/clrt", "version": "clrt 1",
              "ranges": [[0, 32], [32, 64], [64, 96]], "outputs": ["/home/x/p.exr"], "error": "", "checkpoint": "60s"}
    return slurm_plan.Plan(**{**values, **changes})


class Ranges(unittest.TestCase):
    def test_parts_have_all_samples_once_and_are_even(self):
        for spp, tasks in ((64, 4), (4096, 32), (100, 3), (7, 5), (1, 1), (1000, 7)):
            with self.subTest(spp=spp, tasks=tasks):
                parts = slurm_plan.split_samples(spp, tasks)
                self.assertLessEqual(len(parts), tasks)
                self.assertEqual([s for first, end in parts for s in range(first, end)], list(range(spp)))
                self.assertTrue(all(first % slurm_plan.SAMPLE_GROUP == 0 and first < end for first, end in parts))
                lengths = [end - first for first, end in parts[:-1]]
                self.assertLessEqual(max(lengths, default=0) - min(lengths, default=0), slurm_plan.SAMPLE_GROUP)

    def test_texts_join_neighbours(self):
        self.assertEqual(slurm_plan.array_text([7, 0, 2, 1, 3, 3]), "0-3,7")
        self.assertEqual(slurm_plan.array_text([5]), "5")
        self.assertEqual(slurm_plan.range_text([[64, 96], [0, 32], [32, 64], [128, 129]]), "0 to 95, 128 to 128")

    def test_missing_tasks_are_those_without_all_of_their_samples(self):
        plan = make_plan()
        self.assertEqual(slurm_parts.missing_tasks(plan, [[0, 64]]), [2])
        self.assertEqual(slurm_parts.missing_tasks(plan, [[0, 40], [64, 96]]), [1])
        self.assertEqual(slurm_parts.missing_tasks(plan, []), [0, 1, 2])


class Words(unittest.TestCase):
    def test_what_has_no_parts_is_refused_with_the_reason(self):
        for words, reason in ((["--adaptive"], "films of it do not merge"), (["--adaptive=relative"], "films of it"),
                              (["-i", "mlt"], "a step of a chain"), (["-imlt"], "a step of a chain"),
                              (["--integrator=auto"], "pilots"), (["-s64"], "give it to clrt-slurm"),
                              (["--guide", "on"], "need all those before them"), (["-o", "x.png"], "give it to clrt-slurm"),
                              (["--time", "5"], "all of its samples")):
            with self.subTest(words=words), self.assertRaisesRegex(slurm_plan.PlanError, reason):
                slurm_plan.check_words(["a.obj", *words])
        slurm_plan.check_words(["a.obj", "-i", "bdpt", "-r", "64x48", "--seed", "3", "--sampler", "sobol"])

    def test_a_task_renders_its_samples_into_its_part(self):
        command = slurm_plan.clrt_command(make_plan(), "/j", 1, "/t/p.png", False, "4")
        text = " ".join(command)
        for part in ("a b.obj -r 64x48", "--first-sample 32 --spp 32", "--checkpoint /j/part-0001.film,60s", "--guide off",
                     "--threads 4", "--force"):
            self.assertIn(part, text)
        self.assertNotIn("--resume", text)
        resumed = slurm_plan.clrt_command(make_plan(words=["a.obj", "-j", "2"]), "/j", 1, "/t/p.png", True, "4")
        self.assertEqual(resumed[-2:], ["--resume", "/j/part-0001.film"])
        self.assertNotIn("--force", resumed)
        self.assertNotIn("--threads", resumed, "-j is given")


    def test_whole_pictures_may_have_what_parts_may_not(self):
        slurm_plan.check_words(["a.obj", "--adaptive", "-i", "mlt", "--time", "5m", "--guide", "on"], 36)
        for words, reason in ((["--frames", "3"], "give it to clrt-slurm"), (["--checkpoint", "a.film"], "its own"),
                              (["-s64"], "give it to clrt-slurm")):
            with self.subTest(words=words), self.assertRaisesRegex(slurm_plan.PlanError, reason):
                slurm_plan.check_words(["a.obj", *words], 36)

    def test_a_task_renders_its_frame(self):
        plan = make_plan(ranges=slurm_plan.split_frames(3), frames=3, spp=64, error="2%")
        text = " ".join(slurm_plan.frame_command(plan, "/j{1}", 1, "4"))
        for part in ("a b.obj -r 64x48", "--frames 3:2", "--stats /j{{1}}/frame-{frame:4}.json", "-o /home/x/p.exr", "--spp 64",
                     "--error 2%", "--threads 4"):
            self.assertIn(part, text)
        plan.spp, plan.error = 0, ""
        text = " ".join(slurm_plan.frame_command(plan, "/j", 0))
        for word in ("--spp", "--error", "--threads"):
            self.assertNotIn(word, text)


class Scripts(unittest.TestCase):
    def test_the_array_names_tasks_signal_and_requeue(self):
        text = slurm_plan.array_script("/my job/hall", "/opt/clrt-slurm", [0, 1, 2, 9], 4, ["--partition=short"])
        for line in ("#SBATCH --array=0-2,9%4", "#SBATCH --requeue", "#SBATCH --signal=B:USR1@60", "#SBATCH --open-mode=append",
                     "#SBATCH --partition=short", '#SBATCH --output="/my job/hall/task-%a.log"', "#SBATCH --job-name=clrt-hall"):
            self.assertIn(line + "\n", text)
        self.assertTrue(text.endswith("exec /opt/clrt-slurm task --task \"$SLURM_ARRAY_TASK_ID\" '/my job/hall'\n"), text)
        for script in (text, slurm_plan.merge_script("/my job/hall", "/opt/clrt-slurm", [])):
            self.assertEqual(subprocess.run(["sh", "-n"], input=script, text=True, check=False).returncode, 0)

    def test_a_plan_reads_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "job.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(make_plan().text())
            self.assertEqual(slurm_plan.read_plan(path), make_plan())


class Parts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write_part(self, task, ranges, version="1", cut=0):
        text = json.dumps({"identity": {"version": version}, "ranges": ranges}).encode()
        content = film_header.MAGIC + struct.pack("<II", film_header.FORMAT_VERSION, len(text)) + text
        with open(slurm_plan.part_path(self.folder, task), "wb") as file:
            file.write(content[:len(content) - cut])

    def test_a_header_tells_whole_begun_absent_and_damaged(self):
        self.write_part(0, [[0, 32]])
        self.write_part(1, [[32, 40]])
        states = [slurm_parts.look_at(make_plan(), self.folder, task) for task in range(3)]
        self.assertEqual([part.state for part in states], ["whole", "begun", "absent"])
        self.assertEqual(states[1].reason, "8 of 32 spp are there")
        for ranges, cut in (([[0, 32]], 0), ([[32, 64]], 5), ([[32, 96]], 0), ([], 0)):
            self.write_part(1, ranges, cut=cut)
            self.assertEqual(slurm_parts.look_at(make_plan(), self.folder, 1).state, "damaged", (ranges, cut))

    def test_frames_are_there_when_they_are_told_of_unless_stopped(self):
        plan = make_plan(ranges=slurm_plan.split_frames(4), frames=4)
        for frame, text in ((1, '{"stop": {"rule": "spp"}, "error": {"rel_rmse": 0.02}}'),
                            (2, '{"stop": {"rule": "signal"}, "error": {"rel_rmse": 0.5}}'),
                            (3, '{"stop": {"rule": "error"}, "error": {"rel_rmse": null}}'), (4, '{"stop": ')):
            with open(slurm_plan.frame_path(self.folder, frame), "w", encoding="utf-8") as file:
                file.write(text)
        found = slurm_parts.frames_there(plan, self.folder)
        self.assertEqual(found.ranges, [[1, 2], [3, 4]])
        self.assertEqual(found.error, 0.02)
        self.assertEqual([task for task, _ in found.problems], [3])
        self.assertEqual(slurm_parts.missing_tasks(plan, found.ranges), [1, 3])
        self.assertEqual(slurm_plan.range_text(found.ranges), "1 to 1, 3 to 3")

    def test_the_first_field_that_differs_is_named(self):
        self.write_part(0, [[0, 32]])
        self.write_part(1, [[32, 64]], version="2")
        one, two = (slurm_parts.look_at(make_plan(), self.folder, task).identity for task in (0, 1))
        self.assertEqual(slurm_parts.difference(one, two), 'version: expected "1", found "2"')


if __name__ == "__main__":
    unittest.main()
