# SPDX-License-Identifier: Apache-2.0
"""Images as files that clrt can open."""
import os
import re

import bpy


def file_of(image, folder):
    """The image's own file, or one in the folder where it is packed, generated or changed."""
    own = bpy.path.abspath(image.filepath_from_user(), library=image.library)
    if image.source == "FILE" and not image.packed_file and not image.is_dirty and os.path.isfile(own):
        return os.path.abspath(own)
    ending, kind = (".exr", "OPEN_EXR") if image.is_float else (".png", "PNG")
    path = os.path.join(folder, re.sub(r"\W", "_", image.name) + ending)
    if not os.path.exists(path):
        copy = image.copy()
        copy.file_format = kind
        copy.save(filepath=path)
        bpy.data.images.remove(copy)
    return path
