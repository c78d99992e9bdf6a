# SPDX-License-Identifier: Apache-2.0
"""clrt as a render engine of Blender: exports the evaluated scene, runs clrt, loads all passes back."""
from . import engine, panels, settings


def register():
    settings.register()
    engine.register()
    panels.register()


def unregister():
    panels.unregister()
    engine.unregister()
    settings.unregister()
