# SPDX-License-Identifier: Apache-2.0
"""A PlainScene in Mitsuba 3's words (https://mitsuba.readthedocs.io), for mitsuba.load_dict()."""
import os

# Segments of clrt's paths from which roulette may end them where no option says, the same in Mitsuba.
ROULETTE_DEPTH = 5
ENDLESS = -1  # Mitsuba's word for no limit


def scene_dictionary(scene, width, height, sampler, folder, look_at):
    """What mitsuba.load_dict() takes; meshes are written into `folder` as OBJ files. `look_at(origin, target, up)`: Mitsuba's
    transform."""
    depth, = scene.numbers("--max-depth", (ENDLESS,))
    roulette, = scene.numbers("--roulette-depth", (ROULETTE_DEPTH,))
    words = {"type": "scene",
             "integrator": {"type": "path", "max_depth": int(depth), "rr_depth": int(roulette)},
             "sensor": {"type": "perspective", "fov_axis": "y", "fov": scene.field_of_view(width, height),
                        "to_world": look_at(list(scene.numbers("--eye")), list(scene.numbers("--at")), list(scene.up)),
                        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
                        "sampler": {"type": sampler}}}
    if sum(scene.sky):
        words["sky"] = {"type": "constant", "radiance": _rgb(scene.sky)}
    if scene.sun:
        towards, irradiance = scene.sun
        words["sun"] = {"type": "directional", "direction": [-part for part in towards], "irradiance": _rgb(irradiance)}
    for index, ((name, smooth), triangles) in enumerate(scene.triangles.items()):
        path = os.path.join(folder, f"mesh_{index}.obj")
        write_mesh(path, triangles, smooth)
        words[f"mesh_{index}"] = {"type": "obj", "filename": path, "face_normals": not smooth, **_surface(scene.materials[name])}
    return words


def _rgb(colour):
    return {"type": "rgb", "value": list(colour)}


def _surface(material):
    """BSDF and emitter. Matte surfaces and mirrors have two sides, as in clrt; lights shine on their front."""
    if material.kind == "glass":
        surface = {"bsdf": {"type": "dielectric", "int_ior": material.ior, "ext_ior": 1.0}}
    elif material.kind == "mirror":
        surface = {"bsdf": {"type": "twosided", "side": {"type": "conductor", "material": "none",
                                                        "specular_reflectance": _rgb(material.colour)}}}
    else:
        surface = {"bsdf": {"type": "twosided", "side": {"type": "diffuse", "reflectance": _rgb(material.colour)}}}
    if sum(material.emission):
        surface["emitter"] = {"type": "area", "radiance": _rgb(material.emission)}
    return surface


def write_mesh(path, triangles, smooth):
    """An OBJ file of triangles whose corners are all their own."""
    lines = []
    for corners in triangles:
        for point, normal in corners:
            lines.append("v {!r} {!r} {!r}".format(*point))
            if smooth:
                lines.append("vn {!r} {!r} {!r}".format(*normal))
    for k in range(1, 3 * len(triangles) + 1, 3):
        lines.append("f " + " ".join(f"{i}//{i}" if smooth else f"{i}" for i in (k, k + 1, k + 2)))
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
