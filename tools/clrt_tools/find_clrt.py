# SPDX-License-Identifier: Apache-2.0
"""The clrt that a tool in Python runs."""
import os
import shutil
import subprocess


class NoClrt(Exception):
    """There is none; the message says where it was looked for."""


def find_clrt(given, here):
    """The program asked for, that of this source tree (built once, so that no run pays for it), or the one installed beside.
    `here`: folder of the tool."""
    if given:
        return given
    top = os.path.dirname(here)
    if os.path.isfile(os.path.join(top, "CMakeLists.txt")):
        if subprocess.run([os.path.join(here, "build")], check=False).returncode != 0:
            raise NoClrt("expected tools/build to succeed; its messages are above")
        return os.path.join(top, "build", "src", "clrt")
    beside = os.path.join(here, "clrt")
    found = beside if os.access(beside, os.X_OK) else shutil.which("clrt")
    if not found:
        raise NoClrt("expected clrt beside this program or in PATH, found none; give --clrt PROGRAM")
    return found
