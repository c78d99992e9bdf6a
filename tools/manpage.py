#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Turns `clrt --help` or `clrt-merge --help` into a man page: manpage.py PATH/clrt > clrt.1

Reads the layout of src/app/help_text.cpp: a usage line, a paragraph, then headings that end in ':' at the left edge;
below them entries that start with a dash or a number, whose text begins after two blanks and goes on in lines
further in, or plain text.
"""
import os
import re
import subprocess
import sys

SUMMARIES = {"clrt": "render a Wavefront OBJ on any OpenCL device",
             "clrt-merge": "merge film files of clrt into one picture"}
HEADINGS = {"Example": "EXAMPLE", "Options file": "FILES", "Exit codes": "EXIT STATUS"}


def escaped(text):
    """Text that troff prints as it is: backslashes, dashes, and no leading control character."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def sections(help_text):
    """Yields (heading, lines); the part before the first heading has the heading ''."""
    heading, lines = "", []
    for line in help_text.splitlines():
        if re.fullmatch(r"[A-Z][A-Za-z ]*:", line):
            yield heading, lines
            heading, lines = line[:-1], []
        else:
            lines.append(line)
    yield heading, lines


def entries(lines):
    """Yields (name, text) for every entry of a section of options or exit codes."""
    name, words = "", []
    for line in filter(str.strip, lines):
        start = re.match(r" {2,6}((?:-|\d).*?)  +(\S.*)", line)
        if start:
            if name:
                yield name, " ".join(words)
            name, words = start.group(1), [start.group(2)]
        else:
            words.append(line.strip())
    if name:
        yield name, " ".join(words)


def bold_names(name):
    """Option names in bold, values in italics."""
    parts = re.split(r"(--?[a-z][a-z-]*)", name)
    return "".join(f"\\fB{escaped(p)}\\fR" if p.startswith("-") else
                   re.sub(r"[^\s,=\[\]|:]+", lambda m: f"\\fI{escaped(m.group())}\\fR", p) for p in parts)


def page(command, help_text, version):
    parts = dict(sections(help_text))
    usage = parts[""][0].split(None, 2)[2]
    about = " ".join(" ".join(parts[""][1:]).split())
    out = [f'.TH {command.upper()} 1 "" "{version}" "User Commands"', ".SH NAME",
           f"{escaped(command)} \\- {SUMMARIES[command]}", ".SH SYNOPSIS",
           f".B {escaped(command)}", f"\\fI{escaped(usage)}\\fR", ".SH DESCRIPTION", escaped(about), ".SH OPTIONS"]
    tail = []
    for heading, lines in parts.items():
        if heading in HEADINGS:
            tail += [f".SH {HEADINGS[heading]}"]
            found = list(entries(lines))
            for name, text in found:
                tail += [".TP", f".B {escaped(name)}", escaped(text)]
            if not found and heading == "Example":
                tail += [".nf", *(escaped(line.strip()) for line in lines if line.strip()), ".fi"]
            elif not found:
                tail += [escaped(" ".join(" ".join(lines).split()))]
        elif heading:
            out += [f".SS {heading}"]
            for name, text in entries(lines):
                out += [".TP", bold_names(name), escaped(text)]
    return "\n".join(out + tail) + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: manpage.py PATH/clrt > clrt.1")
    output = [subprocess.run([sys.argv[1], option], check=True, capture_output=True, text=True).stdout
              for option in ("--help", "--version")]
    sys.stdout.write(page(os.path.basename(sys.argv[1]), output[0], output[1].strip()))


if __name__ == "__main__":
    main()
