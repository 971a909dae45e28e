# SPDX-License-Identifier: Apache-2.0
"""Changes that a dependency graph reports: of a 3D view from update to update, of a shutter from moment to moment."""

import bpy


def key_of(block):
    return block.bl_rna.identifier, block.name_full


class Changes:
    """Changes by kind and name, apart from positions. `all`: it is not known which objects look different."""

    def __init__(self, by_time=False):
        """`by_time`: nothing but the frame changes. Then an object looks different by its geometry, its materials and its data
        alone, of which Blender reports each; of what is keyed it reports everything."""
        self.blocks, self.all, self._by_time = set(), False, by_time

    def note(self, depsgraph):
        """Adds what has changed since the last evaluation. Returns whether anything has, positions included."""
        any_at_all = False
        for update in depsgraph.updates:
            any_at_all, block = True, update.id
            if isinstance(block, (bpy.types.Image, bpy.types.Texture)) or \
                    (isinstance(block, bpy.types.NodeTree) and not block.is_embedded_data):
                self.all = True  # the objects with these materials are unknown here
            elif not isinstance(block, bpy.types.Object) or update.is_updated_geometry or \
                    (update.is_updated_shading and not self._by_time):
                self.blocks.add(key_of(block))
        return any_at_all

    def touch(self, thing, override):
        """Returns whether an object's appearance, apart from its position, has changed. `override`: material of all surfaces, or None."""
        blocks = [thing, thing.data, override, *(slot.material for slot in thing.material_slots)]
        return self.all or any(block is not None and key_of(block) in self.blocks for block in blocks)
