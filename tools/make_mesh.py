#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes an OBJ of about a given number of triangles, to measure loading, tree building and rays.

    tools/make_mesh.py FILE.obj [TRIANGLES]    default 1000000

The mesh is a closed sphere of radius about 1 with bumps of three sizes, in rows of latitude; no material, no normals.
"""

import math
import sys


def row_of_points(latitude, columns):
    """The lines of one ring of vertices; bumps vary with latitude and longitude."""
    up, across = math.sin(latitude), math.cos(latitude)
    waves = [(0.08, 6, math.cos(5 * latitude)), (0.02, 31, math.cos(29 * latitude)),
             (0.004, 170, math.cos(163 * latitude))]
    for k in range(columns):
        longitude = 2 * math.pi * k / columns
        # The bumps fade towards the poles, where a wave around the axis would have no room.
        radius = 1 + across * sum(size * swing * math.sin(count * longitude) for size, count, swing in waves)
        yield "v %.7g %.7g %.7g\n" % (radius * across * math.cos(longitude), radius * up,
                                      -radius * across * math.sin(longitude))


def write_mesh(out, triangles):
    """Writes rings of 2 * rows vertices between two poles; returns the number of triangles, 4 * rows * (rows - 1)."""
    rows = max(2, round((1 + math.sqrt(1 + triangles)) / 2))
    columns = 2 * rows
    out.write("# bumpy sphere\no bumpy_sphere\nv 0 -1 0\nv 0 1 0\n")
    for i in range(1, rows):
        out.writelines(row_of_points(math.pi * (i / rows - 0.5), columns))

    def vertex(row, column):
        return 3 + (row - 1) * columns + column % columns

    last = rows - 1
    for k in range(columns):
        out.write("f 1 %d %d\n" % (vertex(1, k + 1), vertex(1, k)))
        out.write("f 2 %d %d\n" % (vertex(last, k), vertex(last, k + 1)))
    for i in range(1, last):
        for k in range(columns):
            a, b, c, d = vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1), vertex(i + 1, k)
            out.write("f %d %d %d\nf %d %d %d\n" % (a, b, c, a, c, d))
    return 2 * columns * last


def main(arguments):
    if len(arguments) not in (1, 2) or (len(arguments) == 2 and not arguments[1].isdigit()):
        sys.exit("make_mesh.py: expected FILE.obj [TRIANGLES], found: " + " ".join(arguments))
    wanted = int(arguments[1]) if len(arguments) == 2 else 1000000
    with open(arguments[0], "w", buffering=1 << 20) as out:
        print(f"{write_mesh(out, wanted)} triangles in {arguments[0]}")


if __name__ == "__main__":
    main(sys.argv[1:])
