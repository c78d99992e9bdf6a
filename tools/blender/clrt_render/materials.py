# SPDX-License-Identifier: Apache-2.0
"""Materials -> MTL with the PBR keys of Blender's own exporter, whose dialect clrt knows by the header."""
import bpy

from . import images
from .axes import numbers
from .nodes import linked_node, value_of

HEADER = f"# Blender {bpy.app.version_string} MTL File: 'None'\n"


class Writer:
    """The statements of one material."""

    def __init__(self, name, folder, notes):
        self.lines, self.name, self.folder, self.notes = [f"newmtl {name}"], name, folder, notes

    def put(self, key, *values):
        self.lines.append(f"{key} {numbers(values, ' ')}")

    def note(self, text):
        self.notes.append(f"material {self.name}: {text}")

    def text(self):
        return "\n".join(self.lines) + "\n"

    def colour(self, key, node, socket, factor=1):
        """A colour, or the image that is linked to it, times a factor."""
        if not self._map(key, node, socket):
            self.put(key, *(factor * c for c in value_of(node, socket)[:3]))
        elif factor != 1:
            self.put(key, *[factor] * 3)

    def number(self, key, node, socket):
        if not self._map(key, node, socket):
            self.put(key, value_of(node, socket))

    def _map(self, key, node, socket):
        source = linked_node(node.inputs[socket])
        if not source:
            return False
        if source.type != "TEX_IMAGE" or not source.image:
            self.note(f"{socket} by a node {source.name} is taken as plain")
            return False
        self.lines.append(f"map_{key} {_mapping(source)}{images.file_of(source.image, self.folder)}")
        return True

    def normal_map(self, node):
        source = linked_node(node.inputs["Normal"])
        if not source:
            return
        image = linked_node(source.inputs["Color"]) if source.type == "NORMAL_MAP" else None
        if not image or image.type != "TEX_IMAGE" or not image.image:
            self.note(f"Normal by a node {source.name} is left out")
            return
        strength = numbers([value_of(source, "Strength")])
        path = images.file_of(image.image, self.folder)
        self.lines.append(f"map_Bump -bm {strength} {_mapping(image)}{path}")


def _mapping(image_node):
    """'-o x y z -s x y z ' of a Mapping node before the image."""
    mapping = linked_node(image_node.inputs["Vector"])
    if not mapping or mapping.type != "MAPPING":
        return ""
    return "".join(f"{key} {numbers(value_of(mapping, socket), ' ')} "
                   for key, socket in (("-o", "Location"), ("-s", "Scale")))


def _principled(node, out):
    out.colour("Kd", node, "Base Color")
    out.number("Pr", node, "Roughness")
    out.number("Pm", node, "Metallic")
    out.put("Ks", *[value_of(node, "Specular IOR Level")] * 3)
    out.put("Ni", value_of(node, "IOR"))
    out.put("Ps", value_of(node, "Sheen Weight"))
    out.put("Pc", 4 * value_of(node, "Coat Weight"))  # the exporter's factor: old clearcoat was a quarter as strong
    out.put("Pcr", value_of(node, "Coat Roughness"))
    out.put("aniso", value_of(node, "Anisotropic"))
    out.put("anisor", value_of(node, "Anisotropic Rotation"))
    transmission = value_of(node, "Transmission Weight")
    if transmission > 0:
        out.put("Tf", *[transmission] * 3)
    strength = value_of(node, "Emission Strength")
    if strength > 0:
        out.colour("Ke", node, "Emission Color", strength)
    out.number("d", node, "Alpha")
    out.normal_map(node)
    for weight in ("Subsurface Weight", "Thin Film Thickness"):
        if value_of(node, weight) > 0:
            out.note(f"{weight} is left out")


def _diffuse(node, out):
    out.colour("Kd", node, "Color")
    out.lines += ["Ks 0 0 0", "illum 1"]


def _glossy(node, out):
    out.colour("Kd", node, "Color")
    out.number("Pr", node, "Roughness")
    out.lines.append("Pm 1")


def _glass(node, out):
    # Cycles tints each crossing by the colour, clrt by the square root of Kd.
    out.put("Kd", *(c * c for c in value_of(node, "Color")[:3]))
    out.number("Pr", node, "Roughness")
    out.put("Ni", value_of(node, "IOR"))
    out.lines += ["Pm 0", "Ks 0.5 0.5 0.5", "Tf 1 1 1"]


def _emission(node, out):
    out.lines += ["Kd 0 0 0", "Ks 0 0 0", "illum 1"]
    out.colour("Ke", node, "Color", value_of(node, "Strength"))


SHADERS = {"BSDF_PRINCIPLED": _principled, "BSDF_DIFFUSE": _diffuse, "BSDF_GLOSSY": _glossy,
           "BSDF_GLASS": _glass, "EMISSION": _emission}


def material_text(material, name, folder, notes):
    """The MTL statements of a material; what they cannot say becomes a note."""
    out = Writer(name, folder, notes)
    output = material.node_tree.get_output_node("ALL") if material and material.node_tree else None
    shader = output and linked_node(output.inputs["Surface"])
    for socket in ("Volume", "Displacement"):
        if output and output.inputs[socket].is_linked:
            out.note(f"{socket} is left out")
    if shader and shader.type in SHADERS:
        SHADERS[shader.type](shader, out)
        return out.text()
    if shader:
        out.note(f"the shader {shader.name} is unknown here: matte in the viewport's colour")
    out.put("Kd", *(material.diffuse_color[:3] if material else (0.8, 0.8, 0.8)))
    out.lines += ["Ks 0 0 0", "illum 1"]
    return out.text()


def emits(material):
    """Whether surfaces of a material give light, as far as this file knows shaders."""
    output = material.node_tree.get_output_node("ALL") if material and material.node_tree else None
    shader = output and linked_node(output.inputs["Surface"])
    if not shader or shader.type not in ("EMISSION", "BSDF_PRINCIPLED"):
        return False
    return value_of(shader, "Strength" if shader.type == "EMISSION" else "Emission Strength") > 0
