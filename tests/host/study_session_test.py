# SPDX-License-Identifier: Apache-2.0
"""clrt_tools/study_session.py: quick studies end within their seconds and name what they dropped, on machines of any speed and on
those that get slower. The seconds are those of a simulated clock, so that no test depends on the machine that runs it."""
import os
import sys
import tempfile
import types
import unittest
import unittest.mock

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "..", "tools"), os.path.join(HERE, "..", "support")]
import fake_clrt  # noqa: E402
from clrt_tools.study_methods import Method  # noqa: E402
from clrt_tools.study_plan import Budget  # noqa: E402
from clrt_tools.study_runs import OutOfTime, Runner  # noqa: E402
from clrt_tools.study_session import ProgressLine, Session  # noqa: E402

DEFAULT = Method("path", "single", "sobol")
NAMES = {"integrator": ["path"], "precision": ["single", "double", "fast"], "sampler": ["sobol", "independent"]}


class Machine(Runner):
    """Calls a clrt whose seconds pass by the machine's own clock; `slower` times as many from call number `slow_after` on."""

    def __init__(self, folder, samples_a_second, start, slow_after=1000000, slower=10):
        super().__init__("clrt", "scene.obj", folder)
        self.samples_a_second, self.start, self.slow_after, self.slower = samples_a_second, start, slow_after, slower
        self.now, self.calls = 0.0, 0

    def _call(self, words, seconds):
        self.calls += 1
        slow = self.slower if self.calls > self.slow_after else 1
        end = self.now + seconds

        def pass_time(taken):
            if self.now + taken > end:
                self.now = end
                raise OutOfTime
            self.now += taken

        fake_clrt.render(words, self.samples_a_second / slow, self.start * slow, pass_time)
        return 0, "", 1.0


class Quick(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        silent = unittest.mock.patch.object(ProgressLine, "step", lambda self, text: None)
        silent.start()
        self.addCleanup(silent.stop)

    def study(self, budget, samples, start=0.0, **machine):
        """A study of that many seconds on a machine of that speed: its session, its plan."""
        options = types.SimpleNamespace(names=NAMES, given=set(), quick=True, spp=None, repeats=None, reference=None,
                                        reference_spp=None, extra=(), against=[])
        runner = Machine(self.folder, samples, start, **machine)
        session = Session(options, runner, Budget(budget, lambda: runner.now), DEFAULT)
        plan, own_size = session.plan()
        session.sweep(plan)
        session.own_size_runs(plan, own_size)
        self.assertLessEqual(runner.now, budget)
        return session, plan

    def check_nothing_is_missing_unsaid(self, session, plan):
        """Every run of the plan was made or is counted in a note."""
        planned = len(plan.methods) * len(plan.counts) * plan.repeats
        self.assertEqual(len(session.runs) + len(session.skipped), planned)
        said = f"{len(session.skipped)} of {planned} runs were dropped"
        self.assertEqual(bool(session.skipped), any(note.startswith(said) for note in session.notes), session.notes)

    def test_a_fast_machine_drops_nothing(self):
        session, plan = self.study(150, 4e7)
        self.assertEqual((len(plan.methods), session.skipped), (4, []))
        self.assertNotIn("dropped", "".join(session.notes))

    def test_a_slow_machine_says_what_it_dropped(self):
        session, plan = self.study(30, 1e5, 1.5)
        self.assertRegex("".join(session.notes), "dropped, because there is no time for them: .*path, fast, sobol")
        self.assertIn(DEFAULT, {run.point.method for run in session.runs})
        self.check_nothing_is_missing_unsaid(session, plan)

    def test_a_machine_that_gets_ten_times_slower_in_the_middle_ends_in_time(self):
        session, plan = self.study(30, 1e6, 0.2, slow_after=8)
        self.assertTrue(session.runs and session.skipped)
        self.assertLess(session.budget.elapsed(), 30, "what does not fit does not begin")
        self.check_nothing_is_missing_unsaid(session, plan)

    def test_a_run_that_is_still_going_at_the_end_is_ended_and_counted(self):
        session, plan = self.study(30, 1e6, 0.2, slow_after=10, slower=1000)
        self.assertEqual(session.budget.elapsed(), 30)
        self.assertTrue(session.skipped)
        self.check_nothing_is_missing_unsaid(session, plan)

    def test_ends_in_time_whenever_the_machine_gets_slower(self):
        for samples in (2e5, 1e6, 5e6):
            for slow_after in (5, 8, 12, 20):
                with self.subTest(samples=samples, slow_after=slow_after):
                    session, plan = self.study(30, samples, 0.2, slow_after=slow_after, slower=4)
                    self.check_nothing_is_missing_unsaid(session, plan)


if __name__ == "__main__":
    unittest.main()
