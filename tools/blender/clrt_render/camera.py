# SPDX-License-Identifier: Apache-2.0
"""The scene's camera -> clrt's options."""
import math

from .axes import point

MILLIMETRE = 1e-3  # of a lens, in Blender units, as Cycles takes it


def _lens(camera, place, forward, notes):
    """Depth of field."""
    dof = camera.dof
    if not dof.use_dof:
        return []
    distance = dof.focus_distance
    if dof.focus_object:
        distance = (dof.focus_object.matrix_world.translation - place).dot(forward)
    # Cycles: the radius is a half of the focal length over the f-stop; without a focal length, of one unit.
    focal_length = camera.lens * MILLIMETRE if camera.type == "PERSP" else 1
    options = ["--aperture", f"{focal_length / dof.aperture_fstop:.9g}", "--focus", f"{max(distance, 1e-5):.9g}"]
    if dof.aperture_blades >= 3:
        options += ["--blades", str(dof.aperture_blades)]
    if dof.aperture_ratio != 1 or (dof.aperture_blades >= 3 and dof.aperture_rotation != 0):
        notes.append("the lens is neither stretched nor turned")
    return options


def camera_options(depsgraph, camera_object, width, height, notes):
    """Options of the view, shift and depth of field included. Raises ValueError for a panorama."""
    render = depsgraph.scene.render
    camera = camera_object.data
    if camera.type not in ("PERSP", "ORTHO"):
        raise ValueError("expected a perspective or orthographic camera, found " + camera.type)
    if render.pixel_aspect_x != render.pixel_aspect_y:
        notes.append("pixels are square")
    place, turn, _scale = camera_object.matrix_world.decompose()
    forward, up = -turn.to_matrix().col[2], turn.to_matrix().col[1]
    options = ["--eye", point(place), "--at", point(place + forward), "--up", point(up)]
    frustum = camera_object.calc_matrix_camera(depsgraph, x=width, y=height)
    if camera.type == "PERSP":
        options += ["--fov", f"{math.degrees(2 * math.atan(1 / frustum[1][1])):.9g}"]
        shift = frustum[0][2] / 2, frustum[1][2] / 2
    else:
        options += ["--projection", "orthographic", "--ortho-height", f"{2 / frustum[1][1]:.9g}"]
        shift = -frustum[0][3] / 2, -frustum[1][3] / 2
    if shift != (0, 0):
        options += ["--shift", f"{shift[0]:.9g},{shift[1]:.9g}"]
    return options + _lens(camera, place, forward, notes)
