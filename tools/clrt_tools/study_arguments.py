# SPDX-License-Identifier: Apache-2.0
"""The command line of clrt-study."""
import argparse
import os

from clrt_tools.help_page import CommandLine
from clrt_tools.study_methods import SWITCHES

QUICK_SECONDS = 150  # of the 3 minutes that --help promises; the rest is for the page
LARGEST_COUNT = 2 ** 32 - 1  # of samples that clrt takes

PURPOSE = """Measures what accuracy costs: renders a scene with every combination of integrator, precision, sampler and number of
samples, and with the other ways to find the light one by one, compares the pictures with a reference, and says in a sentence and
a table how many seconds an error of 10, 5, 2 and 1 % costs and what each change buys. Writes one HTML page that opens without a
network, and a table of all runs (CSV). Options after -- go to clrt as they are."""
EXAMPLES = ("clrt-study scene.obj --quick",
            "clrt-study scene.obj -i path,whitted --spp 16,64,256 --repeats 5 -o room.html -- --exposure 1")
EXIT_CODES = ((0, "the page and the table are written"),
              (1, "no render succeeded, clrt is missing, or a file cannot be read or written"),
              (2, "wrong command line"),
              (130, "stopped by Ctrl-C; nothing is written"))


def _names(text):
    """The names in a list such as path,whitted; check_names() looks at them."""
    return text.split(",")


def _counts(text):
    values = text.split(",")
    if not all(value.isdecimal() and 0 < int(value) <= LARGEST_COUNT for value in values):
        raise argparse.ArgumentTypeError(f"expected whole numbers from 1 such as 4,16,64, found '{text}'")
    return sorted({int(value) for value in values})


def _count(text):
    values = _counts(text)
    if len(values) != 1:
        raise argparse.ArgumentTypeError(f"expected one whole number, found '{text}'")
    return values[0]


def _command_line():
    line = CommandLine("clrt-study", " ".join(PURPOSE.split()), EXAMPLES, EXIT_CODES)
    add = line.add_argument
    add("scene", metavar="scene.obj", help="the scene")
    add("--quick", action="store_true",
        help="at most 3 minutes: measures the machine's speed first and chooses a smaller picture, samples and repeats that fit; "
             "only the default and one change at a time; what does not fit is dropped and named")
    for field, switch in SWITCHES.items():
        add(*filter(None, (switch.short, "--" + switch.plural)), dest=field, type=_names, metavar="LIST", help=switch.about)
    add("-s", "--spp", type=_counts, metavar="LIST",
        help="samples a pixel (default 4,16,64,256; quick: as many of 4,16,64,256 as fit)")
    add("--repeats", type=_count, metavar="N", help="runs of each combination, with seeds 1 to N (default 3; quick: 1 to 3)")
    add("-r", "--size", metavar="WxH", help="size that the seconds are for (default: the scene's own)")
    add("-d", "--device", metavar="NAME", help="as for clrt")
    add("--reference", nargs="+", metavar="FILE",
        help="one picture, or two independent halves (default: renders both, path, single, sobol)")
    add("--against", metavar="DIR", action="append", default=[],
        help="another renderer's pictures of the scene, drawn and compared beside clrt's: a folder of EXR files and series.json, as "
             "clrt-mitsuba and clrt-cycles write them; their size is that of the study; repeatable")
    add("--reference-spp", type=_count, metavar="N", help="samples of both halves (default 16 times the most; quick: 8 times)")
    add("--budget", type=_count, metavar="SECONDS",
        help="all renders end within so many seconds of wall time; what does not fit is dropped and named (default: no limit; "
             f"quick: {QUICK_SECONDS})")
    add("-o", "--output", metavar="FILE.html", help="page (default STEM-study.html); the table goes to FILE.csv")
    add("--keep", metavar="DIR", help="keep pictures and statistics of all runs here")
    add("--clrt", metavar="PROGRAM", help="(default: the clrt beside this program)")
    line.add_help_and_version()
    return line


def parse_arguments(words):
    """The options; ends the program with a message where they are wrong."""
    words, extra = (words[:words.index("--")], words[words.index("--") + 1:]) if "--" in words else (words, [])
    line = _command_line()
    options = line.parse_args(words)
    options.extra = tuple(extra)
    if options.reference and len(options.reference) > 2:
        line.error("option --reference: expected one picture or two halves")
    options.given = {field for field in SWITCHES if getattr(options, field)}
    options.integrator = options.integrator or (["path"] if options.quick else ["path", "whitted"])
    options.budget = options.budget or (QUICK_SECONDS if options.quick else None)
    stem = os.path.splitext(os.path.basename(options.scene))[0]
    options.output = options.output or f"{stem}-study.html"
    if not options.output.endswith(".html"):
        line.error(f"option --output: expected a file name that ends in .html, found '{options.output}'")
    if not os.path.isfile(options.scene):
        line.error(f"{options.scene}: expected a scene, found no file")
    return options


def check_names(options, choices):
    """Says what is wrong with the lists of names, given those that clrt takes, or nothing; fills in `names`, the list of each
    switch that this clrt has."""
    options.names = {}
    for field, switch in SWITCHES.items():
        given = getattr(options, field)
        if not choices.has(switch.option):
            if given:
                return f"option --{switch.plural}: expected a clrt that has {switch.option}, found one without"
            continue
        if given and (not all(choices.takes(switch.option, name) for name in given) or len(set(given)) != len(given)):
            return (f"option --{switch.plural}: expected a list out of {', '.join(choices.known(switch.option))}, "
                    f"found '{','.join(given)}'")
        options.names[field] = given or choices.names(switch.option)
    return ""
