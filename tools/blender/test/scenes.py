# SPDX-License-Identifier: Apache-2.0
"""A scene that both renderers can mean the same by: a room of boxes and balls, matte, rough, of metal and of
glass, lit by an area lamp, a bulb, a sun and a sky, seen by a shifted camera."""
import math

import bpy


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy.context.scene


def principled(name, **inputs):
    """A material with these inputs of the Principled BSDF."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = (*value, 1) if isinstance(value, tuple) else value
    return material


def matte(name, colour):
    """A material of a Diffuse BSDF."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (*colour, 1)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def add(operator, name, material, **keywords):
    """An object by one of bpy.ops.mesh."""
    operator(**keywords)
    own = bpy.context.object
    own.name = name
    own.data.materials.append(material)
    return own


def lamp(scene, name, kind, place, energy, **attributes):
    light = bpy.data.lights.new(name, kind)
    light.energy = energy
    for key, value in attributes.items():
        setattr(light, key, value)
    own = bpy.data.objects.new(name, light)
    own.location = place
    scene.collection.objects.link(own)
    return own


def set_camera(scene, place=(5, -7, 3.5), turn=(72, 0, 34), **attributes):
    data = bpy.data.cameras.new("camera")
    for key, value in attributes.items():
        setattr(data, key, value)
    own = bpy.data.objects.new("camera", data)
    own.location = place
    own.rotation_euler = [math.radians(degrees) for degrees in turn]
    scene.collection.objects.link(own)
    scene.camera = own
    return own


def set_sky(scene, colour, strength):
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*colour, 1)
    background.inputs["Strength"].default_value = strength


def ball(name, material, place, radius):
    own = add(bpy.ops.mesh.primitive_uv_sphere_add, name, material, location=place, radius=radius, segments=48,
              ring_count=24)
    bpy.ops.object.shade_smooth()
    return own


def checked(name):
    """A material of a picture, packed into the Blender file."""
    material = principled(name, Roughness=0.6)
    image = bpy.data.images.new(name, 64, 64)
    image.generated_type = "COLOR_GRID"
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.links.new(node.outputs["Color"],
                                 material.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    return material


def _room(width, height):
    scene = clear()
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    return scene


def _row_of_balls():
    """Materials of many lobes in a row, before a wall with a picture."""
    add(bpy.ops.mesh.primitive_plane_add, "wall", checked("picture"), size=6, location=(0, 3, 2),
        rotation=(math.pi / 2, 0, 0))
    for i, material in enumerate((
            principled("glass", Base_Color=(0.9, 0.95, 1.0), Transmission_Weight=1.0, Roughness=0.0, IOR=1.45),
            principled("frosted", Base_Color=(1.0, 1.0, 1.0), Transmission_Weight=1.0, Roughness=0.4),
            principled("coated", Base_Color=(0.6, 0.05, 0.05), Coat_Weight=1.0, Roughness=0.5),
            principled("velvet", Base_Color=(0.1, 0.1, 0.4), Sheen_Weight=0.5, Roughness=0.8),
            principled("gold", Base_Color=(1.0, 0.77, 0.34), Metallic=1.0, Roughness=0.2, Anisotropic=0.5),
            principled("rough", Base_Color=(0.8, 0.8, 0.8), Roughness=1.0))):
        ball(material.name + " ball", material, (1.1 * i - 2.75, 0.3 * (i % 2), 0.5), 0.5)


def balls(width=160, height=120):
    """The row of balls under a spot and a panel."""
    scene = _room(width, height)
    add(bpy.ops.mesh.primitive_plane_add, "floor", matte("grey", (0.5, 0.5, 0.5)), size=40)
    _row_of_balls()
    spot = lamp(scene, "spot", "SPOT", (-3, -3, 4), 600, spot_size=math.radians(50), spot_blend=0.2, shadow_soft_size=0)
    spot.rotation_euler = (0.75, 0, -0.6)
    panel = lamp(scene, "panel", "AREA", (3, -4, 6), 500, shape="SQUARE", size=2)
    panel.rotation_euler = (0.6, 0, 0.5)
    set_sky(scene, (1, 1, 1), 0.2)
    set_camera(scene, (0, -8, 2.5), (78, 0, 0), lens=40)
    return scene


def obj_balls(width=160, height=120):
    """The row of balls as an OBJ can have it: the panel is a mesh that shines; sun, sky and camera are options of clrt."""
    scene = _room(width, height)
    add(bpy.ops.mesh.primitive_plane_add, "floor", principled("grey", Base_Color=(0.5, 0.5, 0.5), Roughness=1.0,
                                                              Specular_IOR_Level=0.0), size=40)
    _row_of_balls()
    panel = add(bpy.ops.mesh.primitive_plane_add, "panel",
                principled("panel", Base_Color=(0.0, 0.0, 0.0), Specular_IOR_Level=0.0, Emission_Color=(1.0, 0.9, 0.8),
                           Emission_Strength=12.0), size=2, location=(3, -4, 6))
    panel.rotation_euler = (0.6 + math.pi, 0, 0.5)
    lamp(scene, "sun", "SUN", (0, 0, 9), 1, angle=math.radians(4)).rotation_euler = (0.7, 0.5, 0)
    set_sky(scene, (1, 1, 1), 0.2)
    set_camera(scene, (0, -8, 2.5), (78, 0, 0), lens=40)
    return scene


def still_life(width=160, height=120):
    """Everything at once."""
    scene = _room(width, height)
    mesh = bpy.ops.mesh
    add(mesh.primitive_plane_add, "floor", matte("grey", (0.5, 0.5, 0.5)), size=40)
    add(mesh.primitive_cube_add, "red box", matte("red", (0.7, 0.1, 0.05)), size=1.4, location=(-1.6, 0.8, 0.7),
        rotation=(0, 0, 0.5))
    ball("green ball", matte("green", (0.1, 0.5, 0.15)), (0.2, 1.6, 0.8), 0.8)
    ball("metal ball", principled("metal", Base_Color=(0.9, 0.6, 0.3), Metallic=1.0, Roughness=0.3), (1.7, 0.2, 0.7), 0.7)
    ball("plastic ball", principled("plastic", Base_Color=(0.1, 0.2, 0.7), Roughness=0.5), (-0.2, -0.6, 0.6), 0.6)
    twin = bpy.data.objects.new("twin box", bpy.data.objects["red box"].data)
    twin.location, twin.scale, twin.rotation_euler = (2.6, 2.2, 0.7), (-1, 1, 1.6), (0, 0, 1)
    scene.collection.objects.link(twin)
    panel = lamp(scene, "panel", "AREA", (-2, -3, 5), 400, shape="RECTANGLE", size=2, size_y=1)
    panel.rotation_euler = (0.6, -0.3, 0.2)
    bulb = lamp(scene, "bulb", "POINT", (3, -1.5, 3), 120, shadow_soft_size=0.2, color=(1, 0.8, 0.6))
    bulb.visible_camera = True
    lamp(scene, "sun", "SUN", (0, 0, 9), 1, angle=math.radians(2)).rotation_euler = (0.7, 0.5, 0)
    set_sky(scene, (0.5, 0.7, 1), 0.3)
    set_camera(scene, lens=35, shift_x=0.06, shift_y=-0.04)
    return scene
