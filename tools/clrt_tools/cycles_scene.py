# SPDX-License-Identifier: Apache-2.0
"""A PlainScene in Blender's words (https://docs.blender.org/api), for Cycles."""
import itertools
import math

from clrt_tools import plain_scene

# More bounces than paths of light survive: the most that Cycles takes.
MOST_BOUNCES = 1024
BOUNCES = ("max", "diffuse", "glossy", "transmission")


def build_scene(bpy, scene, width, height):
    """Makes it the only scene of Blender, returns that. `bpy`: the module."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    found = bpy.context.scene
    found.render.engine = "CYCLES"
    found.render.resolution_x, found.render.resolution_y, found.render.resolution_percentage = width, height, 100
    _see_all(found, scene)
    _add_camera(bpy, found, scene, width, height)
    _add_sky(bpy, found, scene.sky)
    if scene.sun:
        _add_sun(bpy, found, *scene.sun)
    materials = {name: _material(bpy, name, material) for name, material in scene.materials.items()}
    for (name, smooth), triangles in scene.triangles.items():
        _add_mesh(bpy, found, name, triangles, smooth, materials[name])
    return found


def _see_all(found, scene):
    """Has Cycles cut no light, and pixels weigh their square evenly, as in clrt."""
    cycles = found.cycles
    depth, = scene.numbers("--max-depth", (MOST_BOUNCES + 1,))
    for kind in BOUNCES:
        setattr(cycles, "max_bounces" if kind == "max" else kind + "_bounces", min(int(depth) - 1, MOST_BOUNCES))
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    cycles.use_adaptive_sampling = cycles.use_denoising = False


def _add(bpy, found, name, data, matrix=None):
    thing = bpy.data.objects.new(name, data)
    found.collection.objects.link(thing)
    if matrix:
        thing.matrix_world = matrix
    return thing


def _looking(origin, direction, up):
    """The columns of the matrix of what looks along -z, as Blender's cameras and lights do."""
    back = plain_scene.unit([-part for part in direction])
    right = plain_scene.unit(plain_scene.cross(up, back))
    return [(*right, 0), (*plain_scene.cross(back, right), 0), (*back, 0), (*origin, 1)]


def _add_camera(bpy, found, scene, width, height):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle_y = math.radians(scene.field_of_view(width, height))
    data.clip_start, data.clip_end = 1e-6, 1e6
    eye, at = scene.numbers("--eye"), scene.numbers("--at")
    found.camera = _add(bpy, found, "camera", data, _looking(eye, [a - e for a, e in zip(at, eye)], scene.up))


def _add_sky(bpy, found, radiance):
    found.world = bpy.data.worlds.new("sky")
    found.world.use_nodes = True
    found.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*radiance, 1)


def _add_sun(bpy, found, towards, irradiance):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.angle = max(irradiance), 0
    data.color = [part / max(irradiance) for part in irradiance]
    across = (0, 1, 0) if abs(towards[1]) < max(map(abs, towards)) else (1, 0, 0)
    _add(bpy, found, "sun", data, _looking((0, 0, 0), [-part for part in towards], across))


def _material(bpy, name, material):
    """Matte surfaces and mirrors have two sides, as in clrt; lights shine on their front."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    surface = tree.nodes.new({"matte": "ShaderNodeBsdfDiffuse", "mirror": "ShaderNodeBsdfAnisotropic",
                              "glass": "ShaderNodeBsdfGlass"}[material.kind])
    surface.inputs["Color"].default_value = (*material.colour, 1)
    surface.inputs["Roughness"].default_value = 0
    if material.kind == "glass":
        surface.inputs["IOR"].default_value = material.ior
    shader = surface.outputs["BSDF"]
    if sum(material.emission):
        shader = _add_emission(tree, shader, material.emission)
        made.cycles.emission_sampling = "FRONT"
    tree.links.new(shader, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def _add_emission(tree, shader, radiance):
    """The shader with light from its front."""
    def link(a, b):
        tree.links.new(a, b)

    side, front = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMath")
    emission, both = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeAddShader")
    front.operation = "SUBTRACT"
    front.inputs[0].default_value = 1
    link(side.outputs["Backfacing"], front.inputs[1])
    emission.inputs["Color"].default_value = (*radiance, 1)
    link(front.outputs["Value"], emission.inputs["Strength"])
    link(shader, both.inputs[0])
    link(emission.outputs["Emission"], both.inputs[1])
    return both.outputs["Shader"]


def _add_mesh(bpy, found, name, triangles, smooth, material):
    corners = list(itertools.chain.from_iterable(triangles))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([point for point, _ in corners], [], [(k, k + 1, k + 2) for k in range(0, len(corners), 3)])
    mesh.materials.append(material)
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(triangles))
    if smooth:
        mesh.normals_split_custom_set([normal for _, normal in corners])
    _add(bpy, found, name, mesh)
