# SPDX-License-Identifier: Apache-2.0
"""The names that an option of clrt takes, asked of the program that will run."""
import dataclasses
import re
import subprocess

from clrt_tools.study_methods import OFF, ON, SWITCHES, Method
from clrt_tools.study_runs import RunError

SWITCH_OF = {switch.option: switch for switch in SWITCHES.values()}


class Choices:
    """The names in the help of options such as `--sampler NAME  how points are chosen: sobol (...) or independent (default sobol)`,
    `--guide auto|on|off` and `--adaptive[=mse|relative]`."""

    def __init__(self, program):
        done = subprocess.run([program, "--help"], check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise RunError(f"{program} --help: expected the page of clrt, found exit code {done.returncode}")
        entries = re.split(r"(?m)^ {2,6}(?:-\w, )?(?=--[a-z])", done.stdout)
        self._entries = {re.match(r"--[a-z-]+", entry).group(): entry for entry in entries[1:]}

    def has(self, option):
        return option in self._entries

    def names(self, option):
        """What a study compares: the switch's own list, or all names in the order of the help; of an option that stands alone, OFF
        and its names, or OFF and ON."""
        return list(SWITCH_OF[option].tried) or self.known(option)

    def known(self, option):
        """All names in the help, and whether numbers are taken beside them."""
        head = self._entries[option].split(None, 2)
        if SWITCH_OF[option].bare:
            listed = re.fullmatch(r"--[a-z-]+\[=(.+)\]", head[0])
            return [OFF] + (listed.group(1).split("|") if listed else [ON])
        if SWITCH_OF[option].numbers:
            return [name for name in head[1].split("|") if name != "N"] + ["whole numbers"]
        if "|" in head[1]:
            return head[1].split("|")
        listed = re.sub(r" \([^()]*\)", "", " ".join(head[2].split()))
        return re.split(", | or ", listed.split(": ")[-1])

    def takes(self, option, name):
        """Whether it is a name in the help, or a number where the option takes numbers."""
        return SWITCH_OF[option].numbers and name.isdecimal() or name in self.known(option)

    def default(self, option):
        """The name that the help calls so, else the first."""
        if SWITCH_OF[option].bare:
            return OFF
        said = re.search(r"\(default (\w+)", " ".join(self._entries[option].split()))
        return said.group(1) if said else self.names(option)[0]

    def default_method(self):
        """What clrt does without options, by path where it chooses the integrator: a study compares them by name."""
        method = Method(**{field: self.default(switch.option) for field, switch in SWITCHES.items() if self.has(switch.option)})
        return dataclasses.replace(method, integrator="path") if method.integrator == "auto" else method
