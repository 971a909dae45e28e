# SPDX-License-Identifier: Apache-2.0
"""Adds motion to a binary glTF file without animations."""

import json
import struct


def add_motion(path, name, moves, place_at=0.5):
    """Adds an animation of one second to the .glb file at `path`: the node of this name moves by `moves` (x, y, z, in
    its parent's axes) at constant speed, and is in its original place after the part `place_at` of the second. A new
    parent node is animated, since an animated node may have no matrix."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20:20 + length]), bytearray(data[28 + length:])
    nodes = document["nodes"]
    node, above = next(i for i, one in enumerate(nodes) if one.get("name") == name), len(nodes)
    for children in (*(one.get("children", []) for one in nodes), *(scene["nodes"] for scene in document["scenes"])):
        children[:] = [above if child == node else child for child in children]
    nodes.append({"name": f"{name} moves", "children": [node]})
    at = len(binary)
    binary += struct.pack("<8f", 0, 1, *(-place_at * step for step in moves), *((1 - place_at) * step for step in moves))
    document["buffers"][0]["byteLength"] = len(binary)
    views, accessors = len(document["bufferViews"]), len(document["accessors"])
    document["bufferViews"] += [{"buffer": 0, "byteOffset": at, "byteLength": 8}, {"buffer": 0, "byteOffset": at + 8, "byteLength": 24}]
    document["accessors"] += [{"bufferView": views, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                              {"bufferView": views + 1, "componentType": 5126, "count": 2, "type": "VEC3"}]
    document["animations"] = [{"channels": [{"sampler": 0, "target": {"node": above, "path": "translation"}}],
                               "samplers": [{"input": accessors, "output": accessors + 1}]}]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text
                     + struct.pack("<II", len(binary), 0x4E4942) + binary)
