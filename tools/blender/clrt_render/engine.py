# SPDX-License-Identifier: Apache-2.0
"""The render engine: scene -> files -> clrt -> passes."""
import os
import tempfile

import bpy

from . import camera, passes, process, settings, world
from .meshes import SceneFiles

POLL_SECONDS = 0.1
PICTURE_SO_FAR_SECONDS = 5


class ClrtEngine(bpy.types.RenderEngine):
    bl_idname = "CLRT"
    bl_label = "clrt"
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        for name, channels, kind, _layer in passes.wanted(scene, renderlayer):
            self.register_pass(scene, renderlayer, name, len(channels), channels, kind)

    def render(self, depsgraph):
        with tempfile.TemporaryDirectory(prefix="clrt_") as folder:
            try:
                self._render(depsgraph, folder)
            except (ValueError, RuntimeError, OSError) as error:
                # Blender does not outlive the writing of a picture that was never begun.
                self.end_result(self._begin(depsgraph))
                self.report({"ERROR"}, str(error))
                self.error_set(str(error))

    def _render(self, depsgraph, folder):
        rows = passes.wanted(depsgraph.scene, depsgraph.view_layer_eval)
        picture = os.path.join(folder, "picture.exr")
        self.update_stats("", "exporting")
        command = self._command(depsgraph, folder) + passes.options(rows)
        command += ["--output", picture, "--progress", "on", "--save-every", f"{PICTURE_SO_FAR_SECONDS}s"]
        child = process.Child(command)
        self._watch(child, depsgraph, picture)
        complaint = child.complaint()
        if complaint:
            raise RuntimeError(complaint)
        if os.path.exists(picture):
            self._show(depsgraph, picture, is_last=True)

    def _command(self, depsgraph, folder):
        """Writes the scene; the program with its options, but for the output."""
        scene, notes = depsgraph.scene, []
        if not scene.camera:
            raise ValueError("the scene has no camera")
        eye = scene.camera.evaluated_get(depsgraph)
        width, height = self.resolution_x, self.resolution_y
        files = SceneFiles(folder, notes)
        options = files.write(depsgraph)
        options += camera.camera_options(depsgraph, eye, width, height, notes)
        options += world.world_options(scene, folder, notes)
        options += ["--size", f"{width}x{height}", "--studio", "off"]
        if scene.render.use_border:
            options += ["--crop", ",".join(str(side) for side in self._window(scene.render))]
        if scene.render.threads_mode == "FIXED":
            options += ["--threads", str(scene.render.threads)]
        if scene.render.use_motion_blur:
            notes.append("nothing moves while the shutter is open")
        for note in dict.fromkeys(notes):
            self.report({"WARNING"}, note)
        return [settings.program(), "--no-sidecar", files.path] + options + scene.clrt.options()

    def _watch(self, child, depsgraph, picture):
        """Until the child ends: progress, the picture so far, and whether the user cancels."""
        shown = None
        while not child.is_over(POLL_SECONDS):
            for line in child.news():
                self.update_stats("", line)
                fraction = process.fraction_of(line)
                if fraction is not None:
                    self.update_progress(fraction)
            if self.is_cancelled():
                child.stop()
            elif os.path.exists(picture) and shown != (shown := os.stat(picture).st_mtime_ns):
                self._show(depsgraph, picture, is_last=False)

    def is_cancelled(self):
        """Whether the user wants no more."""
        return self.test_break()

    def _window(self, render):
        """Left, top, right and bottom of what is rendered, pixels from the top left."""
        width, height = self.resolution_x, self.resolution_y
        if not render.use_border:
            return 0, 0, width, height
        # Rounded as Blender does, which counts from the bottom.
        return (int(render.border_min_x * width), height - int(render.border_max_y * height),
                int(render.border_max_x * width), height - int(render.border_min_y * height))

    def _begin(self, depsgraph):
        left, top, right, bottom = self._window(depsgraph.scene.render)
        return self.begin_result(0, 0, right - left, bottom - top, layer=depsgraph.view_layer_eval.name)

    def _show(self, depsgraph, picture, is_last):
        """Loads the passes of the file."""
        result = self._begin(depsgraph)
        layer = result.layers[0]
        layer.load_from_file(picture)
        passes.turn_vectors(layer)
        name = layer.name
        self.end_result(result, do_merge_results=is_last)
        for field, text in passes.matte_attributes(picture, name).items():
            self.get_result().stamp_data_add_field(field, text)


def register():
    bpy.utils.register_class(ClrtEngine)


def unregister():
    bpy.utils.unregister_class(ClrtEngine)
