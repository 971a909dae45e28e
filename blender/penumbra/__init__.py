"""Penumbra in Blender: exact soft shadows as a render engine. docs/blender.md says what is rendered and what is not."""

bl_info = {
    "name": "Penumbra",
    "description": "Exact soft shadows of area lights",
    "author": "Penumbra's authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "location": "Render Properties > Render Engine > Penumbra",
}


def register():
    import bpy

    from . import engine, panel
    panel.register()
    bpy.utils.register_class(engine.PenumbraEngine)


def unregister():
    import bpy

    from . import engine, panel
    bpy.utils.unregister_class(engine.PenumbraEngine)
    panel.unregister()
