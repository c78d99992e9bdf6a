# SPDX-License-Identifier: Apache-2.0
"""Blender has z up, clrt's maps y: (x, y, z) is (x, z, -y) there. Texts of numbers, exact as floats."""
import numpy as np


def to_clrt(points):
    """Rows of Blender's world -> clrt's."""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return np.column_stack((points[:, 0], points[:, 2], -points[:, 1]))


def to_blender(points):
    """Rows of clrt's world -> Blender's."""
    return np.column_stack((points[:, 0], -points[:, 2], points[:, 1]))


def numbers(values, gap=","):
    """'1,2,3' as options have them."""
    return gap.join(f"{float(value):.9g}" for value in values)


def point(vector):
    """A vector of Blender's world as an option's value."""
    return numbers(to_clrt(tuple(vector))[0])
