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

SUMMARIES = {"clrt": "render OBJ and glTF scenes on any OpenCL device",
             "clrt-merge": "merge film files of clrt into one picture",
             "clrt-bench": "compare clrt's ray traversal with Embree's",
             "clrt-stability": "run clrt's catalogue of numerically hard cases",
             "clrt-agree": "test whether integrators agree and error bars hold",
             "clrt-compare": "compare two pictures by statistical tests",
             "clrt-cycles": "render a scene of clrt with Blender's Cycles, to compare with",
             "clrt-mitsuba": "render a scene of clrt with Mitsuba 3, to compare with",
             "clrt-slurm": "render one picture on the machines of a Slurm cluster",
             "clrt-study": "measure what accuracy costs in time"}
HEADINGS = {"Example": "EXAMPLE", "Options file": "FILES", "Exit codes": "EXIT STATUS"}


# What the report of a render means, for the page of clrt.
REPORT = [
    ("picture", "The files that were written, width and height in pixels, samples, and what ended the render."),
    ("lost", "Files that could not be written, as on a full disk; the error before the report says why, and the exit code is 1."),
    ("spp", "Samples a pixel: how many paths were traced through each. A pass is one sample of every pixel; a picture always "
            "ends with a whole pass."),
    ("time", "Seconds from the start of the program, and those of rendering alone, without loading and compiling."),
    ("device", "Of several devices (--device A,B): the samples a pixel that each rendered, the seconds it took for them, and "
     "whether it failed. The film is that of one device, to the last bit, where all keep the rules (--list-devices -v). Paths "
     "are not guided; the pilot of --integrator auto runs on the first device."),
    ("error", "How far the picture is from the one that endless rendering would give: the differences of all pixels and "
              "colours are squared, averaged, and the root of that is divided by the picture's mean brightness (radiance), "
              "also known as relative RMSE. A picture with 10 % looks noisy, with 2 % clean, with 0.5 % no noise is left to "
              "see. It is measured, not assumed: the samples of a run are dealt to 4 replicates (--replicates), which are "
              "renders of their own, with random numbers of their own, and the error of their mean follows from how they "
              "differ. The interval is where the error of this very picture is, with a confidence of 95 %."),
    ("relative, absolute", "The error by the other measure. Relative: each difference is divided by the brightness around its "
                           "pixel, tiles of 8 x 8, and by a tenth of the picture's mean where that is more, so that noise in the "
                           "dark counts as it is seen; --adaptive=relative makes it least, and --error then judges by it. "
                           "Absolute: what stands under `error' otherwise."),
    ("chosen", "Where no integrator is named: the one that rendered the picture, and why: what the options or the scene "
               "leave, or the efficiency of each integrator (1 over squared error times work, that of path being 1) by a pilot. "
               "Pilots are coarse pictures of at most 5 % of the work, which is counted in rays, and a thirty-second of the samples "
               "more where one guides bdpt; their samples are dropped, and "
               "the picture is the one that --integrator with this name gives where both guide paths or neither does. Without the "
               "line it is path: the picture takes too few samples for a pilot, is a part (--first-sample), or path finds the light by "
               "itself and there are no caustics to be."),
    ("portals", "Where light samples look for the sky: rectangles in which paths that leave the scene have met nothing, such as windows, "
     "doors and skylights, and the share of the samples that go through them; the others go to bright places of its map. They are "
     "there where pilots found them to at least halve the squared error or, beside other lights, to lower it."),
    ("slabs", "Materials whose facets make plane-parallel slabs, such as panes that have a thickness. Light of sky and suns behind them "
     "goes on in the direction that it had, so it is found by next-event estimation through the glass as through an open window; "
     "what is reflected within the glass is left to paths that meet the light by themselves, and to paths from the light. Integrator path "
     "finds lamps behind them as well: one equation tells in which direction light comes that the glass has shifted. --paths and --aov NAME=EXPR go without either."),
    ("reuse", "Where light comes by detours, paths are expensive and what they find is light for the pixels around as well: what leaves "
     "the second vertex of a path, if that is on a matte surface, is also connected to the first vertices of seven paths of pixels "
     "nearby (multiple importance sampling; without bias). Beside light paths, what these may find too stays its own pixel's. "
     "It is so where pilots tell that it lowers squared error times rays, or by "
     "--path-reuse on. Pixels nearby then have noise in common. Mirrors and clear glass before the first vertex do not count as "
     "vertices."),
    ("lights", "Where there are many lights, and walls between them, which light is sampled is most of the noise. If pilots tell that it "
     "lowers noise times rays, paths take several samples of lights at their first vertex that is no mirror or glass. See "
     "--light-samples."),
    ("outlines", "Where the outline of a light crosses a pixel, whether the ray of a sample meets the light is most of the noise: lamps "
     "are much brighter than what they light. Such pixels take the emission that the camera sees from several camera rays a sample "
     "(--emission-rays). Probes find them, the same whatever the seed; lights of few pixels' size count without. Where at most a "
     "twentieth of the pixels may see mirrors and smooth glass, these rays go on there by up to 8 segments. There is no bias."),
    ("guide", "Which samples paths were guided in, and, with --guide auto, what the guide made of the squared error and the work "
     "of a sample; the cells of space that have learnt, and the memory that they take."),
    ("chains", "Of --integrator mlt: steps of Markov chains in this run, one for every sample of every pixel, or a few more so "
     "that all chains take as many; and how many of the proposals were taken, of small steps and of large ones, which are new "
     "paths. A film that is resumed goes on with new chains."),
    ("adaptive", "What taking samples where the noise is promises, from the film of the first samples: so many times less squared "
                 "error at equal samples. Below 1.1 samples stay even."),
    ("scene", "Pixels that show nothing but what is behind the scene have hardly any noise, and are as many and as bright as "
              "one likes. Where there are such pixels the error is that of the others, over their mean brightness; the line "
              "says how many they are, and the error over all pixels."),
    ("verdict", "Whether the error can be trusted, by one rule. What one replicate alone saw in a pixel, such as a caustic's "
                "bright speck, might as well have been missed, and tells that others were. If that leaves the squared error "
                "uncertain by more than 15 % (one standard error), the verdict is not to trust the error; more samples mend "
                "that. Else it is to trust it, for all light, or for what was sampled where lines below name light that "
                "never was."),
    ("cut", "Paths that ended because --max-depth forbids longer ones, and how much light that takes away at most."),
    ("biased", "With --texture-filter footprint: over which part of a pixel's width textures are averaged in the last samples. That blur "
               "is beside the error, and fades as samples are added."),
    ("not seen", "Light that the integrator cannot find in this scene, in path notation (--paths), and why."),
    ("unmet", "Light that a path finds hardly ever but where it happens to hit a small and bright source, such as what the sun sends through "
              "glass or by a mirror, seen through glass or in a mirror again. Until the first path has hit, all samples agree on a "
              "picture without it. If a hundredth of the scene's mean or more could be missing so, the line says how much at "
              "most, with 95 % confidence, were every surface in between to pass all light on; more samples lower it, and so does "
              "the guide of bdpt, which leads paths to such light. Surfaces of a roughness up to 0.1 count as mirrors and smooth "
              "glass, but not coats and maps. Highlights of small lights in curved mirrors are not spoken of."),
    ("denoised", "With --denoise: what denoising makes of the error, smear included, with 95 % confidence, over all pixels and "
                 "without those that are expected to be the worst. The replicates are two halves; each is denoised by itself "
                 "and judged by the other, so that nothing is judged by the noise that it was made of. 'At most' is said where "
                 "the noise of these samples is larger than the error. What is left as it was are the pixels in which "
                 "smoothing would do more harm than good. The line error stays that of the picture as it was rendered. "
                 "With --denoised-error, how often the picture was denoised on the way, and how long that took."),
    ("price", "What half the error takes: the number of samples, seconds of rendering more, and the error that is reached "
              "there, as a rule within 15 %. Samples are counted where they are even: the replicates times a power of two, "
              "or 3/2 of that. In between a picture can be worse than with fewer samples, since Sobol points fill the unit "
              "cube evenly at powers of two; --error looks and stops at these numbers only, --time at any whole pass."),
    ("target", "What the error that --error asks for takes, where the render ended before it, with an interval of 80 %."),
    ("memory", "The most memory of this computer that was in use; a graphics card has its own."),
    ("left out", "What the picture lacks although the scene has it, because of --effects or of the integrator. Effects that "
                 "are not in the scene are proved absent and change nothing: -v names them, --explain says why."),
    ("bad, cause", "Samples that were not finite, negative or too large count as black and are replayed: the cause is the first "
                   "quantity that went wrong, with the command that shows it."),
    ("missed", "--error or --denoised-error was given and is not reached; the exit code is 5."),
    ("slope (-v)", "How the error falls: a straight line through log error over log samples. Independent samples have -0.5, four "
                   "times the samples for half the error; Sobol points are steeper where light has few edges."),
    ("worst, tails (-v)", "Where the error sits: the worst tile, the share of the noisiest thousandth of the pixels, and what one "
                          "replicate alone saw."),
    ("rays, tree (-v)", "Rays of one sample, millions a second; the tree of boxes that rays are traced through, and its expected "
                        "cost by the surface area heuristic (SAH)."),
]


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


def report_section():
    """The lines of the report and their terms. Scripts are sent to the JSON."""
    out = [".SH REPORT", escaped("After a render, clrt prints what follows; with -v all of it, with -q nothing. The lines are for "
                                 "people and may change: scripts read the file of --stats, whose keys stay.")]
    for name, text in REPORT:
        out += [".TP", f".B {escaped(name)}", escaped(text)]
    return out


def page(command, help_text, version):
    parts = dict(sections(help_text))
    intro = parts[""]
    end = next((i for i, line in enumerate(intro) if not line.strip()), len(intro))
    out = [f'.TH {command.upper()} 1 "" "clrt {version}" "User Commands"', ".SH NAME",
           f"{escaped(command)} \\- {SUMMARIES[command]}", ".SH SYNOPSIS", *usage_lines(command, intro[:end]),
           ".SH DESCRIPTION", *paragraphs(intro[end:]), ".SH OPTIONS"]
    tail = report_section() if command == "clrt" else []
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
