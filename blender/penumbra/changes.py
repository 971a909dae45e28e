# SPDX-License-Identifier: Apache-2.0
"""Changes that a dependency graph reports: between updates of a 3D view, or between moments of an open shutter."""

import bpy


def key_of(block):
    return block.bl_rna.identifier, block.name_full


class Changes:
    """Changed data blocks by kind and name, without changes of positions. `all`: the changed objects are unknown, so
    all count as changed."""

    def __init__(self, by_time=False):
        """`by_time`: only the time changes. An object's appearance then changes only through its geometry, materials
        and data, of which Blender reports each. An update of the object itself does not count: for keyed objects
        Blender reports all kinds."""
        self.blocks, self.all, self._by_time = set(), False, by_time

    def note(self, depsgraph):
        """Adds what has changed since the last evaluation. Returns whether anything has, positions included."""
        any_at_all = False
        for update in depsgraph.updates:
            any_at_all, block = True, update.id
            if isinstance(block, (bpy.types.Image, bpy.types.Texture)) or \
                    (isinstance(block, bpy.types.NodeTree) and not block.is_embedded_data):
                self.all = True  # which objects use these is unknown here
            elif not isinstance(block, bpy.types.Object) or update.is_updated_geometry or \
                    (update.is_updated_shading and not self._by_time):
                self.blocks.add(key_of(block))
        return any_at_all

    def touch(self, thing, override):
        """Returns whether an object's appearance, apart from its position, has changed. `override`: material of all surfaces, or None."""
        blocks = [thing, thing.data, override, *(slot.material for slot in thing.material_slots)]
        return self.all or any(block is not None and key_of(block) in self.blocks for block in blocks)
