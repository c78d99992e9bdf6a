# SPDX-License-Identifier: Apache-2.0
"""Where the user finds the settings."""
import bpy

from .engine import ClrtEngine

# Blender's own panels that are for engines without settings of their own, and say nothing here.
NOT_OURS = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_freestyle", "RENDER_PT_simplify"}
# Those of EEVEE that hold for us: lamps, surfaces, world, passes, depth of field.
SHARED = {"DATA_PT_EEVEE_light", "EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_context_material",
          "EEVEE_WORLD_PT_surface", "VIEWLAYER_PT_eevee_next_layer_passes_data", "VIEWLAYER_PT_layer_passes_cryptomatte",
          "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture"}


class _Panel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ClrtEngine.bl_idname}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def rows(self, owner, *names):
        self.layout.use_property_split = True
        for name in names:
            self.layout.prop(owner, name)


class CLRT_PT_sampling(_Panel):
    bl_label = "Sampling"
    bl_context = "render"

    def draw(self, context):
        chosen = context.scene.clrt
        self.rows(chosen, "integrator", "samples", "use_error")
        if chosen.use_error:
            self.rows(chosen, "error")
        self.rows(chosen, "seconds", "seed")


class CLRT_PT_device(_Panel):
    bl_label = "Device"
    bl_context = "render"

    def draw(self, context):
        self.rows(context.scene.clrt, "device", "further")


class CLRT_PT_passes(_Panel):
    bl_label = "clrt passes"
    bl_context = "view_layer"

    def draw(self, context):
        self.rows(context.view_layer, "use_pass_z", "use_pass_normal", "use_pass_position",
                  "use_pass_cryptomatte_object", "use_pass_cryptomatte_material")
        self.rows(context.scene.clrt, "use_denoising_data")


PANELS = (CLRT_PT_sampling, CLRT_PT_device, CLRT_PT_passes)


def _shared_panels():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", set())
        if ("BLENDER_RENDER" in engines and panel.__name__ not in NOT_OURS) or panel.__name__ in SHARED:
            yield engines


def register():
    for panel in PANELS:
        bpy.utils.register_class(panel)
    for engines in _shared_panels():
        engines.add(ClrtEngine.bl_idname)


def unregister():
    for engines in _shared_panels():
        engines.discard(ClrtEngine.bl_idname)
    for panel in reversed(PANELS):
        bpy.utils.unregister_class(panel)
