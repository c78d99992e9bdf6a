#!/usr/bin/python3 -ISB
# SPDX-License-Identifier: Apache-2.0
"""syntax_only.py FOLDER SOURCES COMPILER ARGUMENTS... -o FILE -c INPUT: the compiler checks its input and makes no code, which
takes three quarters of the time. FILE, empty, says when. SOURCES is the folder of our own headers.

Clang gets the slow ones of the libraries' headers that the input includes, itself or by our headers, precompiled: these and no
others, so that what the input forgets to include stays unknown to it. FOLDER keeps them, a file for each choice of headers."""
import fcntl
import hashlib
import os
import re
import subprocess
import sys

# In the order of inclusion; opencl.h is our own, around the library's.
SLOW_HEADERS = ("device/opencl.h", "filesystem", "fmt/format.h", "nlohmann/json.hpp", "spdlog/spdlog.h", "tbb/parallel_for.h")
INCLUDE = re.compile(r'^ *# *include *[<"]([^>"]+)[>"]', re.MULTILINE)


def included(path, sources, found):
    """Adds the names of all headers that a file includes, itself or by our headers."""
    with open(path, encoding="utf-8") as file:
        names = INCLUDE.findall(file.read())
    for name in names:
        if name not in found:
            found.add(name)
            for folder in (os.path.dirname(path), sources):
                if os.path.exists(os.path.join(folder, name)):
                    included(os.path.join(folder, name), sources, found)
                    break


def is_current(precompiled):
    """It is there and none of its headers is newer."""
    try:
        with open(precompiled + ".d", encoding="utf-8") as file:
            headers = file.read().partition(": ")[2].replace("\\\n", " ").split()
        return all(os.path.getmtime(header) < os.path.getmtime(precompiled) for header in headers)
    except OSError:
        return False


def precompile(folder, headers, command):
    """The precompiled headers' file. Templates that they use are made there, not again for each input. Who needs a file that
    another one makes waits for it: clang refuses one whose text is newer."""
    name = hashlib.sha256("\0".join((*headers, *command)).encode()).hexdigest()[:16]
    text, precompiled = os.path.join(folder, name + ".h"), os.path.join(folder, name + ".pch")
    os.makedirs(folder, exist_ok=True)
    with open(text + ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not is_current(precompiled):
            with open(text, "w", encoding="utf-8") as file:
                file.writelines(f"#include <{header}>\n" for header in headers)
            subprocess.run([*command, "-x", "c++-header", text, "-fpch-instantiate-templates", "-o", precompiled, "-MD",
                            "-MF", precompiled + ".d"], check=True)
    return precompiled


def main(folder, sources, *command):
    output, source = (command[command.index(option) + 1] for option in ("-o", "-c"))
    more = []
    if "clang" in os.path.basename(command[0]):
        found = set()
        included(source, sources, found)
        headers = [header for header in SLOW_HEADERS if header in found]
        if headers:
            plain = command[:min(command.index(option) for option in ("-MD", "-o", "-c") if option in command)]
            more = ["-include-pch", precompile(folder, headers, plain)]
    subprocess.run([*command, "-fsyntax-only", *more], check=True)
    with open(output, "w", encoding="utf-8"):
        pass


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode)
