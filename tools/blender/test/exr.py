# SPDX-License-Identifier: Apache-2.0
"""Reads the uncompressed multi-part OpenEXR files that Blender writes, so that no further package is needed."""
import struct

import numpy as np

UNCOMPRESSED = 0
PIXEL_TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
MULTI_PART = 0x1000


class _Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def bytes(self, count):
        self.at += count
        return self.data[self.at - count:self.at]

    def numbers(self, form):
        return struct.unpack("<" + form, self.bytes(struct.calcsize("<" + form)))

    def word(self):
        end = self.data.index(b"\0", self.at)
        text = self.data[self.at:end].decode()
        self.at = end + 1
        return text


def _header(reader):
    """Attributes of a part; empty after the last one."""
    found = {}
    while name := reader.word():
        reader.word()
        found[name] = reader.bytes(reader.numbers("i")[0])
    return found


def _channels(value):
    reader, found = _Reader(value), []
    while name := reader.word():
        kind = reader.numbers("iiii")[0]
        found.append((name, np.dtype(PIXEL_TYPES[kind])))
    return found


def read_exr(path):
    """Arrays (height, width) by the names of the channels, without the view layer's."""
    with open(path, "rb") as file:
        reader = _Reader(file.read())
    version = reader.numbers("II")[1]
    parts = [_header(reader)]
    while version & MULTI_PART and (header := _header(reader)):
        parts.append(header)
    x0, y0, x1, y1 = struct.unpack("<4i", parts[0]["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    if any(part["compression"][0] != UNCOMPRESSED for part in parts):
        raise ValueError(f"{path}: expected no compression")
    reader.bytes(8 * height * len(parts))  # where rows begin
    layout = [_channels(part["channels"]) for part in parts]
    result = {name.split(".", 1)[1]: np.empty((height, width), dtype) for part in layout for name, dtype in part}
    for _ in range(height * len(parts)):
        part = reader.numbers("i")[0] if version & MULTI_PART else 0
        row, _size = reader.numbers("ii")
        for name, dtype in layout[part]:
            values = np.frombuffer(reader.bytes(dtype.itemsize * width), dtype)
            result[name.split(".", 1)[1]][row - y0] = values
    return result


def texts(path):
    """The text attributes of the first part."""
    with open(path, "rb") as file:
        reader = _Reader(file.read())
    reader.bytes(8)
    found = {}
    while name := reader.word():
        kind, value = reader.word(), reader.bytes(reader.numbers("i")[0])
        if kind == "string":
            found[name] = value.decode()
    return found
