# SPDX-License-Identifier: Apache-2.0
"""Reads film files, as `clrt --checkpoint` writes them (layout: src/film/film_file.h)."""
import dataclasses

import numpy

from clrt_tools.film_header import MAGIC, FilmError, parse_header

CHECKSUM_BYTES = 16
NODE_BYTES, CELL_BYTES, WEIGHT_BYTES = 4, 534 + 2056, 4


@dataclasses.dataclass
class Film:
    """Means of the replicates that have samples."""
    means: numpy.ndarray  # (replicate, row, column, channel)
    window: tuple         # x0, y0, x1, y1; ends excluded
    size: tuple           # of the whole picture
    samples: int          # a pixel, over all replicates
    seed: str


def is_film(path):
    with open(path, "rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def replicate_samples(ranges, replicates, replicate):
    """Samples of a pixel that fell into a replicate: sample s belongs to replicate s mod replicates."""
    def below(end):
        return (end + replicates - 1 - replicate) // replicates
    return sum(below(end) - below(first) for first, end in ranges)


def read_film(path):
    """Reads and checks it all."""
    with open(path, "rb") as file:
        content = file.read()
    header, start = parse_header(content)
    try:
        identity, count = header["identity"], int(header["replicates"])
        x0, y0, x1, y1 = window = tuple(int(value) for value in identity["window"])
        size = tuple(int(value) for value in identity["size"])
        quantum, ranges = float(identity["quantum"]), [tuple(map(int, pair)) for pair in header["ranges"]]
        seed = str(identity.get("seed", ""))
    except (KeyError, TypeError, ValueError) as error:
        raise FilmError(f"damaged: the header lacks what it must have ({error!r})") from error
    if count < 1 or x1 <= x0 or y1 <= y0 or len(size) != 2 or not ranges:
        raise FilmError("damaged: the header's window, replicates or ranges are impossible")
    shape = (count, y1 - y0, x1 - x0, 3)
    sums = _read_sums(content, start, shape, _guide_bytes(header))
    samples = [replicate_samples(ranges, count, replicate) for replicate in range(count)]
    means = [sums[r] * (quantum / samples[r]) for r in range(count) if samples[r] > 0]
    return Film(numpy.array(means), window, size, sum(samples), seed)


def _guide_bytes(header):
    """Of what the cells of a guided film have learnt, which stands behind the sums (src/film/film_file.h)."""
    guide = header.get("guide", {})
    return (NODE_BYTES * int(guide.get("nodes", 0)) + CELL_BYTES * int(guide.get("cells", 0))
            + WEIGHT_BYTES * int(guide.get("weights", 0)))


def _read_sums(content, start, shape, behind):
    import xxhash
    expected = start + 8 * int(numpy.prod(shape)) + behind + CHECKSUM_BYTES
    if len(content) != expected:
        what = "truncated" if len(content) < expected else "damaged"
        raise FilmError(f"{what}: expected {expected} bytes, found {len(content)}")
    if xxhash.xxh3_128(content[:-CHECKSUM_BYTES]).digest() != content[-CHECKSUM_BYTES:]:
        raise FilmError("damaged: the checksum at its end differs from that of its content")
    return numpy.frombuffer(content, "<i8", int(numpy.prod(shape)), start).reshape(shape)
