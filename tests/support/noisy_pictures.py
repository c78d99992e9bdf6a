# SPDX-License-Identifier: Apache-2.0
"""Pictures of known expectation and noise, and files of them."""
import json
import os
import struct
import sys

import numpy
import OpenImageIO
import xxhash

sys.dont_write_bytecode = True
TOOLS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools")
sys.path.insert(0, TOOLS)

from clrt_tools.film_header import FORMAT_VERSION  # noqa: E402 (needs the path above)
from clrt_tools.picture_file import Picture, Window  # noqa: E402

REPLICATES = 8


def noisy_replicates(random, truth, deviation, replicates=REPLICATES):
    """Independent pictures (replicates, height, width, 3) with mean `truth`; the noise of a pixel is skewed and heavy-tailed
    as that of path tracing is: gamma distributed with shape 1/2."""
    shape = (replicates,) + truth.shape
    noise = (random.gamma(0.5, 1.0, shape) - 0.5) / numpy.sqrt(0.5)
    return truth * (1 + deviation * numpy.sqrt(replicates) * noise)


def picture_of(replicates, keep=False):
    """The picture of the replicates' mean: like a film file (keep) or like an EXR with a variance layer."""
    count, height, width, _ = replicates.shape
    picture = Picture("test", Window(0, 0, width, height, width, height), replicates.mean(axis=0))
    picture.variance = replicates.var(axis=0, ddof=1) / count
    picture.degrees = count - 1
    picture.replicates = replicates if keep else None
    return picture


def write_exr(path, mean, variance=None, samples=None, attributes=(), origin=(0, 0), full=None):
    """An EXR with the layers that clrt writes."""
    height, width = mean.shape[:2]
    layers, names = [mean], ["R", "G", "B"]
    if samples is not None:
        layers.append(numpy.full((height, width, 1), float(samples)))
        names.append("samples")
    if variance is not None:
        layers.append(variance)
        names += ["variance.R", "variance.G", "variance.B"]
    spec = OpenImageIO.ImageSpec(width, height, len(names), OpenImageIO.FLOAT)
    spec.channelnames = names
    spec.x, spec.y = origin
    spec.full_width, spec.full_height = full or (width, height)
    for name, value in attributes:
        spec.attribute(name, value)
    output = OpenImageIO.ImageOutput.create(path)
    assert output.open(path, spec), output.geterror()
    assert output.write_image(numpy.concatenate(layers, axis=-1).astype(numpy.float32)), output.geterror()
    output.close()


def film_bytes(sums, quantum, ranges, version=FORMAT_VERSION, seed=0, window=None, size=None):
    """A film file as src/film/film_file.h describes it; sums: int64 (replicates, height, width, 3)."""
    replicates, height, width, _ = sums.shape
    header = json.dumps({
        "identity": {"seed": seed, "size": size or [width, height], "window": window or [0, 0, width, height],
                     "quantum": quantum},
        "replicates": replicates, "ranges": ranges}).encode()
    content = b"CLRTFILM" + struct.pack("<II", version, len(header)) + header + sums.astype("<i8").tobytes()
    return content + xxhash.xxh3_128(content).digest()
