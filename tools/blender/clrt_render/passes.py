# SPDX-License-Identifier: Apache-2.0
"""Blender's passes and the layers of clrt that they are."""
import struct

import numpy as np

from .axes import to_blender

MATTE_LAYERS = 3
VECTORS = ("Normal", "Position", "Denoising Normal")  # in world axes


def wanted(scene, view_layer):
    """Rows (pass, channels, kind, layer of --aov) of what a view layer asks for, Combined first."""
    rows = [("Combined", "RGBA", "COLOR", None)]
    for asked, name, channels, kind, layer in (
            (view_layer.use_pass_z, "Depth", "Z", "VALUE", "Z"),
            (view_layer.use_pass_normal, "Normal", "XYZ", "VECTOR", "N"),
            (view_layer.use_pass_position, "Position", "XYZ", "VECTOR", "P"),
            (scene.clrt.use_denoising_data, "Denoising Albedo", "RGB", "COLOR", "denoisingAlbedo"),
            (scene.clrt.use_denoising_data, "Denoising Normal", "XYZ", "VECTOR", "denoisingNormal")):
        if asked:
            rows.append((name, channels, kind, layer))
    for asked, name, layer in ((view_layer.use_pass_cryptomatte_object, "CryptoObject", "cryptoObject"),
                               (view_layer.use_pass_cryptomatte_material, "CryptoMaterial", "cryptoMaterial")):
        if asked:
            rows += [(f"{name}{i:02}", "RGBA", "COLOR", layer) for i in range(MATTE_LAYERS)]
    return rows


def options(rows):
    """clrt's options for these passes."""
    layers = list(dict.fromkeys(row[3] for row in rows if row[3]))
    return ["--exr-names", "blender", "--aov", ",".join(layers) or "none"]


def turn_vectors(layer):
    """Turns the loaded vectors from clrt's axes to Blender's."""
    for one in layer.passes:
        if one.name in VECTORS:
            values = np.empty(len(one.rect) * 3, dtype=np.float32)
            one.rect.foreach_get(values)
            one.rect.foreach_set(to_blender(values.reshape(-1, 3)).ravel())


def matte_attributes(path, view_layer_name):
    """The metadata of mattes in an EXR file, under the names that Blender's compositor looks for."""
    found = {name: text for name, text in _texts(path) if name.startswith("cryptomatte/")}
    return {name: f"{view_layer_name}.{text}" if name.endswith("/name") else text for name, text in found.items()}


def _texts(path):
    """Names and values of the text attributes in an EXR file's header."""
    with open(path, "rb") as file:
        file.read(8)  # magic number and version
        while name := _word(file):
            kind = _word(file)
            value = file.read(struct.unpack("<i", file.read(4))[0])
            if kind == "string":
                yield name, value.decode("utf-8")


def _word(file):
    return b"".join(iter(lambda: file.read(1), b"\0")).decode("utf-8")
