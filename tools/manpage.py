#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Turns `PROGRAM --help` into a man page: manpage.py PATH/clrt VERSION > clrt.1

Reads the layout of src/app/help_text.cpp: usage lines, paragraphs (those indented are examples), then headings that end in
':' at the left edge; below them entries whose text begins after two blanks or on the next line and goes on in lines
further in, or plain text. tools/clrt_tools/help_page.py writes the same layout.
"""
import os
import re
import subprocess
import sys

SUMMARIES = {"clrt": "render a Wavefront OBJ on any OpenCL device",
             "clrt-merge": "merge film files of clrt into one picture",
             "clrt-bench": "compare clrt's ray traversal with Embree's",
             "clrt-stability": "run clrt's catalogue of numerically hard cases",
             "clrt-compare": "compare two pictures by statistical tests",
             "clrt-study": "measure what accuracy costs in time"}
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


def entries(heading, lines):
    """Yields (name, text) for every entry of a section of options, arguments or exit codes."""
    begin = r"\S" if heading == "Arguments" else r"-|\d"
    name, words = "", []
    for line in filter(str.strip, lines):
        start = re.match(rf" {{2,6}}((?:{begin}).*?)(?:  +(\S.*)|$)", line)
        if start:
            if name:
                yield name, " ".join(words).strip()
            name, words = start.group(1), [start.group(2) or ""]
        else:
            words.append(line.strip())
    if name:
        yield name, " ".join(words).strip()


def bold_names(name):
    """Option names in bold, values in italics."""
    parts = re.split(r"(--?[a-z][a-z-]*)", name)
    return "".join(f"\\fB{escaped(p)}\\fR" if p.startswith("-") else
                   re.sub(r"[^\s,=\[\]|:{}]+", lambda m: f"\\fI{escaped(m.group())}\\fR", p) for p in parts)


def usage_lines(command, text):
    """A line for each way to call the command, which is bold."""
    out = []
    for line in text:
        words = line.replace("Usage:", "").split(None, 1)
        out += [".br"] if out else []
        out += [f"\\fB{escaped(command)}\\fR {bold_names(words[1])}"]
    return out


def paragraphs(lines):
    """Plain text; what is indented stays as it is."""
    out = []
    for paragraph in "\n".join(lines).strip("\n").split("\n\n"):
        rows = paragraph.splitlines()
        out += [".PP"] if out else []
        out += [".nf", *map(escaped, rows), ".fi"] if rows and rows[0].startswith(" ") else [escaped(" ".join(paragraph.split()))]
    return out


def page(command, help_text, version):
    parts = dict(sections(help_text))
    intro = parts[""]
    end = next((i for i, line in enumerate(intro) if not line.strip()), len(intro))
    out = [f'.TH {command.upper()} 1 "" "clrt {version}" "User Commands"', ".SH NAME",
           f"{escaped(command)} \\- {SUMMARIES[command]}", ".SH SYNOPSIS", *usage_lines(command, intro[:end]),
           ".SH DESCRIPTION", *paragraphs(intro[end:]), ".SH OPTIONS"]
    tail = []
    for heading, lines in parts.items():
        if heading in HEADINGS:
            tail += [f".SH {HEADINGS[heading]}"]
            found = list(entries(heading, lines))
            for name, text in found:
                tail += [".TP", f".B {escaped(name)}", escaped(text)]
            if not found and heading == "Example":
                tail += [".nf", *(escaped(line.strip()) for line in lines if line.strip()), ".fi"]
            elif not found:
                tail += [escaped(" ".join(" ".join(lines).split()))]
        elif heading:
            out += [f".SS {heading}"]
            for name, text in entries(heading, lines):
                out += [".TP", bold_names(name), escaped(text)]
    return "\n".join(out + tail) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: manpage.py PATH/clrt VERSION > clrt.1")
    program, version = sys.argv[1:]
    help_text = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
    sys.stdout.write(page(os.path.basename(program), help_text, version))


if __name__ == "__main__":
    main()
