# SPDX-License-Identifier: Apache-2.0
"""What the user chooses: Scene.clrt, and where the program is (the add-on's preferences)."""
import os
import shlex
import shutil

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

INTEGRATORS = ("path", "path+light", "light", "bdpt", "mlt", "distribution", "whitted", "raycast", "auto")


class ClrtSettings(bpy.types.PropertyGroup):
    integrator: EnumProperty(name="Integrator", default="path", items=[(name, name, "") for name in INTEGRATORS],
                             description="How light is followed; auto chooses for the scene")
    samples: IntProperty(name="Samples", default=64, min=1, soft_max=65536, description="At most so many a pixel")
    use_error: BoolProperty(name="Until an error", description="End as soon as the picture is as exact as asked for")
    error: FloatProperty(name="Error", default=2, min=0.01, max=100, subtype="PERCENTAGE",
                         description="Root of the mean squared error over the mean")
    seconds: FloatProperty(name="Time", default=0, min=0, subtype="TIME_ABSOLUTE", unit="TIME_ABSOLUTE",
                           description="At most so long, without loading; 0: no limit")
    device: StringProperty(name="Device", description="Part of an OpenCL platform's or device's name, cpu or gpu; "
                           "empty: the first GPU, else the CPU")
    seed: IntProperty(name="Seed", default=0, min=0, description="Chooses the noise")
    further: StringProperty(name="Further options", description="As on clrt's command line, such as --max-depth 8")
    use_denoising_data: BoolProperty(name="Denoising Data", description="Passes Denoising Albedo and Denoising Normal, "
                                     "for the compositor's Denoise node")

    def options(self):
        """The chosen ones as clrt's command line has them."""
        result = ["--integrator", self.integrator, "--spp", str(self.samples), "--seed", str(self.seed)]
        if self.use_error:
            result += ["--error", f"{self.error:.6g}%"]
        if self.seconds > 0:
            result += ["--time", f"{self.seconds:.6g}s"]
        if self.device:
            result += ["--device", self.device]
        return result + shlex.split(self.further)


class ClrtPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: StringProperty(name="clrt", subtype="FILE_PATH",
                            description="The program; empty: variable CLRT, else the search path")

    def draw(self, _context):
        self.layout.prop(self, "program")


def program():
    """The path of clrt. Raises FileNotFoundError."""
    addon = bpy.context.preferences.addons.get(__package__)
    chosen = (addon and addon.preferences.program) or os.environ.get("CLRT") or "clrt"
    found = shutil.which(bpy.path.abspath(chosen))
    if not found:
        raise FileNotFoundError(f"'{chosen}' is no program; name clrt in the add-on's preferences or in the "
                                "variable CLRT")
    return found


def register():
    bpy.utils.register_class(ClrtSettings)
    bpy.utils.register_class(ClrtPreferences)
    bpy.types.Scene.clrt = PointerProperty(type=ClrtSettings)


def unregister():
    del bpy.types.Scene.clrt
    bpy.utils.unregister_class(ClrtPreferences)
    bpy.utils.unregister_class(ClrtSettings)
