# SPDX-License-Identifier: Apache-2.0
"""The world -> clrt's environment."""
import math

from . import images
from .axes import numbers
from .nodes import linked_node, value_of


def _background(world):
    """The background node that the world's output shows, or None."""
    if not world or not world.node_tree:
        return None
    output = world.node_tree.get_output_node("ALL")
    node = output and linked_node(output.inputs["Surface"])
    return node if node and node.type == "BACKGROUND" else None


def _rotation_degrees(environment):
    """The turn of a lat-long picture about the vertical, by a Mapping node before it."""
    mapping = linked_node(environment.inputs["Vector"])
    if not mapping or mapping.type != "MAPPING":
        return 0
    return math.degrees(value_of(mapping, "Rotation")[2])


def world_options(scene, folder, notes):
    """Options of the environment, and of what the camera sees of it. There always is one: no default lights."""
    options = ["--background", "transparent"] if scene.render.film_transparent else []
    background = _background(scene.world)
    if not background:
        colour = scene.world.color if scene.world else (0, 0, 0)
        return options + ["--env", numbers(colour)]
    strength = value_of(background, "Strength")
    node = linked_node(background.inputs["Color"])
    if node and node.type == "TEX_ENVIRONMENT" and node.image:
        options += ["--env", images.file_of(node.image, folder), "--env-scale", f"{strength:.9g}"]
        return options + ["--env-rotate", f"{-_rotation_degrees(node):.9g}"]
    if node:
        notes.append(f"the world's colour by a node {node.name} is taken as plain")
    return options + ["--env", numbers(strength * c for c in value_of(background, "Color")[:3])]
