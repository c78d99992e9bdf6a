# SPDX-License-Identifier: Apache-2.0
"""Renders the current scene by an engine and reads the passes back."""
import json
import os

import bpy

import exr

PASSES = ("use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_cryptomatte_object",
          "use_pass_cryptomatte_material")


def render(scene, engine, path, samples):
    """All passes by channel; samples are spread evenly over pixels and nothing is smoothed."""
    view_layer = scene.view_layers[0]
    for name in PASSES:
        setattr(view_layer, name, True)
    scene.render.engine = engine
    scene.clrt.use_denoising_data, scene.clrt.samples = True, samples
    view_layer.cycles.denoising_store_passes = True
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = samples, False, False
    cycles.pixel_filter_type = "BOX"
    cycles.sample_clamp_indirect, cycles.blur_glossy = 0, 0
    # Far more than light paths have here: clrt cuts none.
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 64
    image = scene.render.image_settings
    image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return exr.read_exr(path)


def matte_names(path, kind):
    """Id as a float's bits -> name, of a kind such as CryptoObject."""
    found = exr.texts(path)
    keys = [key for key, text in found.items() if key.endswith("/name") and text.endswith(kind)]
    manifest = json.loads(found[os.path.dirname(keys[0]) + "/manifest"])
    return {int(bits, 16): name for name, bits in manifest.items()}


def coverage(passes, kind, names):
    """The coverage of every pixel by name."""
    lower = {name.lower(): values for name, values in passes.items()}
    found = {}
    for layer in range(3):
        for identity, share in (("r", "g"), ("b", "a")):
            bits = lower[f"{kind}{layer:02}.{identity}".lower()].view("<u4")
            values = lower[f"{kind}{layer:02}.{share}".lower()]
            for one, name in names.items():
                if name not in found:
                    found[name] = 0 * values
                found[name][bits == one] += values[bits == one]
    return found
