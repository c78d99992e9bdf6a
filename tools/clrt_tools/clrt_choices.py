# SPDX-License-Identifier: Apache-2.0
"""The names that an option of clrt takes, asked of the program that will run."""
import re
import subprocess

from clrt_tools.study_runs import RunError


class Choices:
    """The names in the help of options such as --integrator: "path (...), whitted (...) or raycast (...) (default path)"."""

    def __init__(self, program):
        done = subprocess.run([program, "--help"], check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise RunError(f"{program} --help: expected the page of clrt, found exit code {done.returncode}")
        entries = re.split(r"(?m)^ {2,6}(?:-\w, )?(?=--[a-z])", done.stdout)
        self._texts = {entry.split(None, 1)[0]: " ".join(entry.split()[2:]) for entry in entries[1:]}

    def names(self, option):
        """All names, in the order of the help."""
        return re.split(", | or ", re.sub(r" \([^()]*\)", "", self._texts[option]))

    def default(self, option):
        return re.search(r"\(default (\S+)\)", self._texts[option]).group(1)
