#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Shows that the tests can fail: puts one fault after the other into a copy of the kernels and runs the test that must
catch it.

    tests/render/seeded_faults.py BUILD_FOLDER [NAME...]
    tests/render/seeded_faults.py BUILD_FOLDER --quick

Without names: all faults, each against its whole test program. --quick, which the test suite runs: the faults of QUICK, each
against the one test that catches it, after that test has passed without the fault; and DRAWN of the others, each against
the test of CAUGHT_BY in the same way, else against its test program up to the first test that fails. Those are drawn by a
hash of the kernels: the same for the same kernels, others after every change. With the variable CLRT_TEST_LONG set (the
night tier), all of them. Prints which tests caught each fault; exit code 1 if one was not caught, if its text is no longer
in the kernels, or if the kernels with the fault do not compile."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile

from fault_catchers import CAUGHT_BY, QUICK
from faults import FAULTS

KERNELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "kernels")

# Faults that --quick draws besides. One takes some 15 processor seconds in the mean, and up to 100 where no test of CAUGHT_BY is
# known or that one renders for long.
DRAWN = 5

# Test programs that take minutes: their faults are left to the night tier.
SLOW = ("effect_masks_test",)


def kernels_hash():
    """A hash of all kernel files, names and text."""
    total = hashlib.sha256()
    for folder, folders, files in os.walk(KERNELS):
        folders.sort()
        for name in sorted(files):
            path = os.path.join(folder, name)
            total.update(os.path.relpath(path, KERNELS).encode())
            with open(path, "rb") as source:
                total.update(source.read())
    return total.hexdigest()


def drawn(count):
    """The names of so many faults beside those of QUICK and of slow tests, drawn by the kernels."""
    key = kernels_hash()
    others = [fault[0] for fault in FAULTS if fault[0] not in QUICK and fault[4] not in SLOW]
    return sorted(others, key=lambda name: hashlib.sha256((key + name).encode()).digest())[:count]


class Uncaught(Exception):
    """Why a fault counts as not caught."""


def run_tests(build, program, kernels, tests="*", until_one_fails=False, effects="all"):
    """The names of the tests that passed and of those that failed. `effects` tells whether their scenes are rendered by the
    full program or by the small one of the effects that they need."""
    command = [os.path.join(build, "tests", program), "--gtest_filter=" + tests]
    if until_one_fails:
        command.append("--gtest_fail_fast")
    run = subprocess.run(command, capture_output=True, text=True, errors="replace",
                         env=dict(os.environ, CLRT_TEST_KERNELS=kernels, CLRT_TEST_EFFECTS=effects))
    if "thrown in the test body" in run.stdout:
        raise Uncaught("%s could not run:\n%s" % (program, run.stdout[-2000:]))
    passed, failed = (set(re.findall(r"^\[ *%s *\] ([\w./]+) \(" % word, run.stdout, re.MULTILINE)) for word in ("OK", "FAILED"))
    if run.returncode and not failed:
        failed = {"(ended with %d)" % run.returncode}
    return passed, failed


def plant(kernels, file, text, fault):
    """Puts a fault into the kernels of a folder."""
    path = os.path.join(kernels, file)
    with open(path) as source:
        code = source.read()
    if text not in code:
        raise Uncaught("its text is not in %s any more" % file)
    with open(path, "w") as source:
        source.write(code.replace(text, fault))


def stale():
    """Faults whose text is no longer in the kernels: kernels change, and such a fault would no longer prove anything."""
    def is_there(file, text):
        with open(os.path.join(KERNELS, file)) as source:
            return text in source.read()
    return [name for name, file, text, _, _ in FAULTS if not is_there(file, text)]


def catch(build, fault, tests, until_one_fails):
    """The tests that catch a fault, at least one; `tests` filters them, and then passes without the fault."""
    name, file, text, replacement, program = fault
    with tempfile.TemporaryDirectory() as folder:
        kernels = os.path.join(folder, "kernels")
        shutil.copytree(KERNELS, kernels)
        # The small program with a fault serves one test, the full one many; both with the fault and without.
        effects = "all" if tests == "*" else "needed"
        if tests != "*" and run_tests(build, program, kernels, tests, effects=effects) != ({tests}, set()):
            raise Uncaught("%s does not pass without it" % tests)
        plant(kernels, file, text, replacement)
        failed = run_tests(build, program, kernels, tests, until_one_fails, effects)[1]
    if not failed:
        raise Uncaught("by " + program)
    return sorted(failed)


def main():
    build, wanted = sys.argv[1], sys.argv[2:]
    quick = wanted == ["--quick"]
    if quick:
        wanted = [fault[0] for fault in FAULTS] if "CLRT_TEST_LONG" in os.environ else list(QUICK) + drawn(DRAWN)
        print("%d of %d faults, drawn by the kernels' hash %s" % (len(wanted), len(FAULTS), kernels_hash()[:16]), flush=True)
    uncaught = 0
    for fault in FAULTS:
        name = fault[0]
        if wanted and name not in wanted:
            continue
        try:
            tests = QUICK.get(name) or CAUGHT_BY.get(name) if quick else None
            caught = catch(build, fault, tests or "*", quick)
            more = " and %d more" % (len(caught) - 1) if len(caught) > 1 else ""
            print("%-45s caught by %s%s" % (name, caught[0], more), flush=True)
        except Uncaught as reason:
            print("%-45s NOT CAUGHT: %s" % (name, reason), flush=True)
            uncaught += 1
    for name in stale():
        print("%-45s its text is not in the kernels any more" % name)
        uncaught += 1
    missing = (set(wanted) | set(CAUGHT_BY)) - {fault[0] for fault in FAULTS}
    for name in sorted(missing):
        print("%-45s no fault has this name" % name)
    return 1 if uncaught or missing else 0


if __name__ == "__main__":
    sys.exit(main())
