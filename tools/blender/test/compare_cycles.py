#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders one scene by Cycles and by clrt and compares: where every object is in the picture, and the mean colour of
every material.

    compare_cycles.py FOLDER [still_life|balls [SAMPLES [WIDTH HEIGHT]]]

Needs Python 3.11 with the packages bpy and numpy, and clrt in the variable CLRT or the search path. Leaves both
pictures in the folder. Exit code 1 if an object is elsewhere, or if a colour differs by more than it may."""
import os
import sys

here = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [here, os.path.dirname(here)]

import numpy as np  # noqa: E402 (needs the path above)

import clrt_render  # noqa: E402
import rendering  # noqa: E402
import scenes  # noqa: E402

# Pixels that an object's middle may be off, and the share that its area may: coverage is sampled.
LARGEST_SHIFT, LARGEST_AREA_DIFFERENCE = 0.1, 0.01
LARGEST_DIFFERENCE = 0.02
# Where the two mean different things by the same inputs: the scene "balls".
KNOWN_DIFFERENCES = {
    "velvet": 0.2,   # sheen: Cycles' fibres (LTC) against a Charlie distribution
    "coated": 0.1,   # how much of the base a coat leaves
    "gold": 0.1,     # tangents of anisotropy: of the texture here, around z there
    "grey": 0.03,    # the rim of the spot: glTF's square of a cosine against a smooth step
    "picture": 0.03, # the same, and noise of the glass balls' light
    "glass": 0.03,
    "frosted": 0.04,
}
FEWEST_PIXELS = 30


def middle(coverage):
    rows, columns = np.indices(coverage.shape)
    return np.array([(coverage * columns).sum(), (coverage * rows).sum()]) / coverage.sum()


def compare_places(ours, theirs):
    """Lines and whether all is well."""
    is_well = True
    for name in sorted(set(ours) & set(theirs)):
        a, b = ours[name], theirs[name]
        if min(a.sum(), b.sum()) < FEWEST_PIXELS:
            continue
        shift = np.abs(middle(a) - middle(b)).max()
        area = a.sum() / b.sum() - 1
        well = shift < LARGEST_SHIFT and abs(area) < LARGEST_AREA_DIFFERENCE
        is_well = is_well and well
        print(f"  {name:14s} {b.sum():9.1f} pixels, area {100 * area:+.2f} %, middle off by {shift:.3f} pixels"
              f"{'' if well else '  DIFFERS'}")
    return is_well


def colour(passes):
    return np.dstack([passes["Combined." + c] for c in "RGB"]).astype(float)


def compare_colours(ours, theirs, our_mattes, their_mattes):
    is_well = True
    for name in sorted(set(our_mattes) & set(their_mattes)):
        inside = (our_mattes[name] > 0.999) & (their_mattes[name] > 0.999)
        if inside.sum() < FEWEST_PIXELS:
            continue
        a, b = colour(ours)[inside].mean(axis=0), colour(theirs)[inside].mean(axis=0)
        limit = KNOWN_DIFFERENCES.get(name, LARGEST_DIFFERENCE)
        worst = np.abs(a / b - 1).max()
        is_well = is_well and worst < limit
        print(f"  {name:14s} clrt {a.round(4)}, Cycles {b.round(4)}, ratio {(a / b).round(4)}"
              f"{'' if worst < limit else '  DIFFERS'}")
    return is_well


def compare_albedo(ours, theirs, edges):
    """Of the pixels at edges, where means must be over all samples."""
    a, b = [np.dstack([passes["Denoising Albedo." + c] for c in "RGB"])[edges] for passes in (ours, theirs)]
    print(f"Albedo at {edges.sum()} pixels of edges: root of mean squared difference {np.sqrt(((a - b)**2).mean()):.4f}, "
          f"mean {a.mean():.4f}, Cycles {b.mean():.4f}")


def main():
    folder = sys.argv[1]
    name = sys.argv[2] if len(sys.argv) > 2 else "still_life"
    samples = int(sys.argv[3]) if len(sys.argv) > 3 else 1024
    width, height = [int(x) for x in sys.argv[4:6]] or (160, 120)
    os.makedirs(folder, exist_ok=True)
    clrt_render.register()
    scene = {"still_life": scenes.still_life, "balls": scenes.balls}[name](width, height)
    found = {}
    for engine in ("CLRT", "CYCLES"):
        path = os.path.join(folder, engine.lower() + ".exr")
        found[engine] = rendering.render(scene, engine, path, samples), path
    mattes = {}
    for kind in ("CryptoObject", "CryptoMaterial"):
        for engine, (passes, path) in found.items():
            mattes[kind, engine] = rendering.coverage(passes, kind, rendering.matte_names(path, kind))
    print("Objects, of Cycles' area:")
    places = compare_places(mattes["CryptoObject", "CLRT"], mattes["CryptoObject", "CYCLES"])
    print("Mean colour by material, pixels wholly inside:")
    colours = compare_colours(found["CLRT"][0], found["CYCLES"][0], mattes["CryptoMaterial", "CLRT"],
                              mattes["CryptoMaterial", "CYCLES"])
    things = [share for name, share in mattes["CryptoObject", "CLRT"].items() if name not in scene.objects
              or scene.objects[name].type == "MESH"]
    cover = np.max(things, axis=0)
    compare_albedo(found["CLRT"][0], found["CYCLES"][0], (cover > 0.02) & (cover < 0.98) & (sum(things) > 0.9))
    sys.exit(0 if places and colours else 1)


if __name__ == "__main__":
    main()
