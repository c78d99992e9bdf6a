# SPDX-License-Identifier: Apache-2.0
"""The pictures on the walls and things of the textured interior, as rows of 8-bit pixels, top row first.

All but the painting and the leaf repeat without a seam. Colours are sRGB, normal maps and bump maps linear.
"""

import math
import random


def noise(columns, rows, seed):
    """Smooth noise in 0..1 over a torus of columns x rows cells: a function of (x, y) in cells."""
    source = random.Random(seed)
    grid = [[source.random() for _ in range(columns)] for _ in range(rows)]

    def at(x, y):
        i, j = math.floor(x), math.floor(y)
        u, v = x - i, y - j
        u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
        row0, row1 = grid[j % rows], grid[(j + 1) % rows]
        low = row0[i % columns] * (1 - u) + row0[(i + 1) % columns] * u
        high = row1[i % columns] * (1 - u) + row1[(i + 1) % columns] * u
        return low * (1 - v) + high * v

    return at


def byte(x):
    return max(0, min(255, round(255 * x)))


def colour(r, g, b, brightness=1.0):
    return (byte(r * brightness), byte(g * brightness), byte(b * brightness))


def mix(a, b, t):
    return tuple(x + t * (y - x) for x, y in zip(a, b))


def picture(width, height, pixel):
    return [[pixel(x, y) for x in range(width)] for y in range(height)]


def wood_floor():
    """Four rows of planks that run along u, each of its own shade, with grain and dark joints."""
    size, plank = 128, 32
    grain, tone = noise(8, 64, 1), noise(64, 64, 2)

    def pixel(x, y):
        row = y // plank
        end = (row * 53) % size
        shade = 0.78 + 0.30 * tone(row * 7.3, 5)
        shade += 0.22 * (grain((x + row * 37) / 16, y / 2) - 0.5)
        if y % plank == 0 or x == end:
            shade *= 0.55
        return colour(0.72, 0.54, 0.38, shade)

    return picture(size, size, pixel)


BRICK_WIDTH, BRICK_HEIGHT, JOINT = 32, 16, 2.5  # pixels


def brick_height(x, y):
    """Height of the brick wall, 0 in the joints and 1 on the bricks, at a pixel of a 128 x 128 map."""
    offset = BRICK_WIDTH / 2 if (int(y) // BRICK_HEIGHT) % 2 else 0
    from_side = min((x + offset) % BRICK_WIDTH, BRICK_WIDTH - (x + offset) % BRICK_WIDTH)
    from_edge = min(y % BRICK_HEIGHT, BRICK_HEIGHT - y % BRICK_HEIGHT)
    t = max(0.0, min(1.0, (min(from_side, from_edge) - 0.5) / JOINT))
    return t * t * (3 - 2 * t)


def brick():
    """Running bond in a pale red."""
    stain, tone = noise(32, 32, 3), noise(64, 64, 4)

    def pixel(x, y):
        h = brick_height(x + 0.5, y + 0.5)
        row = y // BRICK_HEIGHT
        column = (x + (BRICK_WIDTH // 2 if row % 2 else 0)) % 128 // BRICK_WIDTH
        of_brick = mix((0.68, 0.50, 0.43), (0.82, 0.68, 0.60), tone(column * 5.1, row * 3.7))
        shade = 0.9 + 0.2 * stain(x / 4, y / 4)
        return colour(*mix((0.78, 0.75, 0.70), of_brick, h), shade)

    return picture(128, 128, pixel)


def brick_normal():
    """The normal map of brick_height: red along u, green along v (up), blue out of the wall."""
    rough = noise(64, 64, 5)
    depth = 3.0  # pixels from joint to brick

    def height(x, y):
        return depth * brick_height((x + 0.5) % 128, (y + 0.5) % 128) + 0.5 * rough(x / 2, y / 2)

    def pixel(x, y):
        du = (height(x + 1, y) - height(x - 1, y)) / 2
        dv = (height(x, y - 1) - height(x, y + 1)) / 2
        length = math.sqrt(du * du + dv * dv + 1)
        return tuple(byte(0.5 + 0.5 * c / length) for c in (-du, -dv, 1))

    return picture(128, 128, pixel)


def plaster_bump():
    """Heights of a trowelled wall, grey."""
    coarse, fine = noise(8, 16, 6), noise(32, 32, 7)
    return picture(128, 128, lambda x, y: (byte(0.65 * coarse(x / 16, y / 8) + 0.35 * fine(x / 4, y / 4)),))


def wallpaper():
    """Stripes with a row of blossoms."""
    def pixel(x, y):
        base = (0.80, 0.82, 0.74) if (x // 32) % 2 else (0.66, 0.74, 0.68)
        u, v = (x % 32) - 15.5, ((y + (32 if (x // 32) % 2 else 0)) % 64) - 31.5
        radius, angle = math.hypot(u, v), math.atan2(v, u)
        if radius < 8 + 3.5 * math.cos(5 * angle):
            base = mix(base, (0.72, 0.45, 0.40), 0.75)
        if radius < 3:
            base = (0.90, 0.80, 0.45)
        if abs(u) < 0.8 and v > 9:
            base = mix(base, (0.35, 0.50, 0.35), 0.8)
        return colour(*base)

    return picture(64, 64, pixel)


def rug():
    """A border and nested diamonds."""
    wool = noise(64, 64, 8)
    blue, red, cream = (0.16, 0.22, 0.40), (0.55, 0.14, 0.14), (0.82, 0.74, 0.58)

    def pixel(x, y):
        from_edge = min(x, y, 127 - x, 127 - y)
        if from_edge < 4 or 12 <= from_edge < 14:
            base = cream
        elif from_edge < 12:
            base = blue if ((x + y) // 4) % 2 else red
        else:
            ring = int(abs(x - 63.5) + abs(y - 63.5)) // 8
            base = (red, cream, blue, red)[ring % 4]
        return colour(*base, 0.85 + 0.3 * wool(x / 2, y / 2))

    return picture(128, 128, pixel)


def painting():
    """Hills in front of an evening sky."""
    cloud = noise(16, 16, 9)
    width, height = 128, 80
    hills = [(0.60, 0.10, 0.05, (0.38, 0.36, 0.52)), (0.72, 0.07, 0.09, (0.25, 0.32, 0.38)),
             (0.85, 0.05, 0.14, (0.14, 0.22, 0.20))]

    def pixel(x, y):
        s, t = x / width, y / height
        base = mix((0.25, 0.36, 0.62), (0.98, 0.70, 0.42), min(1, t * 1.6))
        base = mix(base, (0.95, 0.80, 0.72), 0.5 * cloud(s * 5, t * 11) ** 2)
        if math.hypot((s - 0.66) * width / height, t - 0.42) < 0.1:
            base = (1.0, 0.93, 0.70)
        for level, swing, frequency, paint in hills:
            if t > level + swing * math.sin(s * 100 * frequency + level * 9) * math.cos(s * 4 + frequency * 30):
                base = paint
        return colour(*base)

    return picture(width, height, pixel)


def leaf():
    """One leaf, its stem at the bottom; alpha is its outline."""
    def pixel(x, y):
        u, v = (x - 31.5) / 32, 1 - (y + 0.5) / 128
        half_width = 0.9 * math.sin(math.pi * min(1, max(0, v - 0.06) / 0.94) ** 0.8) ** 0.8 if v > 0.06 else 0
        inside = abs(u) < max(half_width, 0.05 if v < 0.5 else 0)
        vein = abs(u) < 0.04 or (v + 0.25 * abs(u)) % 0.125 < 0.012
        green = mix((0.20, 0.42, 0.14), (0.32, 0.55, 0.20), 1 - abs(u))
        return colour(*(mix(green, (0.55, 0.68, 0.35), 0.7) if vein else green)) + (255 if inside else 0,)

    return picture(64, 128, pixel)


def sky():
    """A latitude-longitude sky: blue above, pale at the horizon, dark ground, clouds."""
    cloud = noise(16, 16, 11)
    width, height = 64, 32

    def pixel(x, y):
        v = (y + 0.5) / height
        if v > 0.5:
            return colour(0.24, 0.22, 0.20)
        blue = mix((0.36, 0.50, 0.80), (0.80, 0.84, 0.88), (2 * v) ** 2)
        return colour(*mix(blue, (0.95, 0.95, 0.95), 0.6 * cloud(x / 4, y / 2) ** 2))

    return picture(width, height, pixel)
