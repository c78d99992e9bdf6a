# SPDX-License-Identifier: Apache-2.0
"""The version of the programs in Python: that of the source tree they lie in, or the one noted when they were installed."""
import os
import re

FOLDER = os.path.dirname(os.path.realpath(__file__))
INSTALLED = os.path.join(FOLDER, "VERSION")  # tools/CMakeLists.txt writes it
SOURCE = os.path.join(FOLDER, "..", "..", "CMakeLists.txt")


def version():
    """Such as 0.1.0."""
    if os.path.exists(INSTALLED):
        with open(INSTALLED, encoding="utf-8") as file:
            return file.read().strip()
    with open(SOURCE, encoding="utf-8") as file:
        return re.search(r"project\(clrt VERSION ([\d.]+)", file.read()).group(1)
