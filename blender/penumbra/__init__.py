# SPDX-License-Identifier: Apache-2.0
"""Penumbra in Blender: exact soft shadows as a render engine. docs/blender.md says what is rendered and what is not."""

bl_info = {
    "name": "Penumbra",
    "description": "Exact soft shadows of area lights",
    "author": "Penumbra's authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "location": "Render Properties > Render Engine > Penumbra",
}


def register():
    import bpy

    from . import bake, engine, panels, serving, settings
    settings.register()
    bpy.utils.register_class(engine.PenumbraEngine)
    bpy.utils.register_class(bake.PENUMBRA_OT_bake)
    panels.register()
    for handlers in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        handlers.append(bpy.app.handlers.persistent(serving.forget))  # kept when another file is opened


def unregister():
    import bpy

    from . import bake, engine, panels, serving, settings
    for handlers in (bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel):
        handlers.remove(serving.forget)
    serving.forget()
    panels.unregister()
    bpy.utils.unregister_class(bake.PENUMBRA_OT_bake)
    bpy.utils.unregister_class(engine.PenumbraEngine)
    settings.unregister()
