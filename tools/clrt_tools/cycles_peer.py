# SPDX-License-Identifier: Apache-2.0
"""Blender's Cycles as a renderer to compare with."""
import contextlib
import os
import shutil

from clrt_tools.cycles_scene import build_scene
from clrt_tools.peer_series import Peer, PeerScene, missing_package


class CyclesScene(PeerScene):
    """A scene in Blender, which `built` is. `bpy`: the module. Pictures are EXR files in `folder`."""

    def __init__(self, bpy, built, title, folder, threads=None):
        self.bpy, self.built, self.title, self.folder = bpy, built, title, folder
        self.count = 0
        built.render.threads_mode = "FIXED" if threads else "AUTO"
        if threads:
            built.render.threads = threads
        image = built.render.image_settings
        if hasattr(image, "media_type"):  # from Blender 5 on
            image.media_type = "IMAGE"
        image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"

    def warm_up(self, spp):
        """Loads what Cycles loads once; samples need nothing more."""
        self.render(1, 0)

    def render(self, spp, seed):
        self.built.cycles.samples, self.built.cycles.seed = spp, seed
        self.count += 1
        path = self.built.render.filepath = os.path.join(self.folder, f"{self.count}.exr")
        with _silent():
            self.bpy.ops.render.render(write_still=True)
        return path

    def write(self, picture, path):
        shutil.copyfile(picture, path)

    def mean(self, picture):
        import numpy
        image = self.bpy.data.images.load(picture)
        try:
            image.colorspace_settings.name = "Non-Color"
            return float(numpy.array(image.pixels[:]).reshape(-1, image.channels)[:, :3].mean())
        finally:
            self.bpy.data.images.remove(image)

    def mean_of_file(self, path):
        return self.mean(path)


@contextlib.contextmanager
def _silent():
    """Without the lines that Blender prints of every sample."""
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(nothing)
        os.close(kept)


class Cycles(Peer):
    """The program clrt-cycles."""
    program, name, packages = "clrt-cycles", "Blender's Cycles", "bpy and numpy"

    def add_options(self, add):
        add("--guiding", action="store_true", help="path guiding (default: without, as in Blender)")
        add("--no-light-tree", action="store_true", help="lights are chosen by power (default: by the light tree, as in Blender)")

    def open(self, scene, options, folder):
        try:
            import bpy
            import numpy  # noqa: F401 (CyclesScene.mean needs it)
        except ImportError as error:
            raise missing_package(error, self.packages) from error
        with _silent():
            built = build_scene(bpy, scene, *options.size)
        built.cycles.use_guiding, built.cycles.use_light_tree = options.guiding, not options.no_light_tree
        title = "Cycles " + bpy.app.version_string + (", guiding" if options.guiding else "")
        if options.no_light_tree:
            title += ", no light tree"
        return CyclesScene(bpy, built, title, folder, options.threads)
