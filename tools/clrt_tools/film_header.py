# SPDX-License-Identifier: Apache-2.0
"""The header of a film file, as `clrt --checkpoint` writes it (layout: src/film/film_file.h)."""
import json
import struct

MAGIC = b"CLRTFILM"
FORMAT_VERSION = 3
FRONT_BYTES = len(MAGIC) + 8


class FilmError(Exception):
    """A film file that cannot be used: what was expected, what was found."""


def parse_header(content):
    """The header of a file's content, or of its beginning, and where the sums start."""
    if len(content) < FRONT_BYTES:
        raise FilmError(f"truncated: expected {FRONT_BYTES} bytes or more, found {len(content)}")
    if not content.startswith(MAGIC):
        raise FilmError("expected a film file, found something else")
    version, length = struct.unpack_from("<II", content, len(MAGIC))
    if version != FORMAT_VERSION:
        raise FilmError(f"expected a film file of format version {FORMAT_VERSION}, found {version}")
    start = FRONT_BYTES + length
    if len(content) < start:
        raise FilmError(f"truncated: expected {start} bytes or more, found {len(content)}")
    try:
        return json.loads(content[FRONT_BYTES:start].decode()), start
    except ValueError as error:
        raise FilmError("damaged: the header is no JSON") from error


def read_header(path):
    """The header of a file, without its sums. Raises FilmError and OSError."""
    with open(path, "rb") as file:
        front = file.read(FRONT_BYTES)
        length = struct.unpack_from("<I", front, len(MAGIC) + 4)[0] if len(front) == FRONT_BYTES else 0
        return parse_header(front + file.read(length))[0]
