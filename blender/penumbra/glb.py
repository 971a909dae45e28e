# SPDX-License-Identifier: Apache-2.0
"""Writes the scene that the program reads: binary glTF 2.0, with extras for data that glTF does not define
(docs/blender.md).

Independent of Blender. Matrices are sequences of four rows, as Blender's are; lengths and axes are Blender's, and one
node above all others turns Z up into Y up, exactly.
"""

import json
import struct

FLOAT, UNSIGNED, UNSIGNED_BYTE = 5126, 5125, 5121
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_SIZES = {FLOAT: 4, UNSIGNED: 4, UNSIGNED_BYTE: 1}
_Z_UP_TO_Y_UP = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]


def by_columns(matrix):
    """Converts a matrix of rows to glTF's order."""
    return [float(matrix[row][column]) for column in range(4) for row in range(4)]


class Glb:
    """A binary glTF file that grows by additions; `encoded` returns the complete file."""

    def __init__(self):
        self._binary, self.domes = bytearray(), []
        self._beside = None  # name and length of a file with the binary data of meshes and images (without_nodes)
        self._extensions = set()
        self.has_lamps = False
        self._document = {
            "asset": {"version": "2.0", "generator": "Penumbra for Blender"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"name": "Z up", "matrix": _Z_UP_TO_Y_UP, "children": []}],
        }

    def _add(self, kind, entry):
        entries = self._document.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def _view(self, data):
        self._binary += b"\0" * (-len(self._binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)}
        self._binary += data
        return self._add("bufferViews", view)

    def accessor(self, data, shape, component=FLOAT, bounds=None):
        """Adds an accessor. `data`: bytes, little-endian; `shape`: "SCALAR" to "VEC4"; `bounds`: least and greatest
        position."""
        entry = {
            "bufferView": self._view(data),
            "componentType": component,
            "count": len(data) // (_COMPONENTS[shape] * _SIZES[component]),
            "type": shape,
        }
        if bounds is not None:
            entry["min"], entry["max"] = ([float(x) for x in bound] for bound in bounds)
        return self._add("accessors", entry)

    def image(self, name, data, mime):
        return self._add("images", {"name": name, "bufferView": self._view(data), "mimeType": mime})

    def texture(self, image, wrap=10497, nearest=False):
        """Adds a texture. `wrap`: glTF's number of the wrapping mode."""
        filtering = 9728 if nearest else 9729
        sampler = self._add("samplers", {"wrapS": wrap, "wrapT": wrap, "magFilter": filtering})
        return self._add("textures", {"source": image, "sampler": sampler})

    def material(self, name, color, radiance=(0, 0, 0), alpha=1.0, cutoff=None, texture=None, texture_alpha=False):
        """Adds a material. It emits to both sides, as Blender's materials do. `cutoff`: there are holes where alpha
        is below; None: alpha dims light. `texture_alpha`: the texture's alpha is used."""
        surface = {"baseColorFactor": [*color, alpha], "metallicFactor": 0, "roughnessFactor": 1}
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture}
        entry = {"name": name, "pbrMetallicRoughness": surface, "doubleSided": True}
        if cutoff is not None:
            entry["alphaMode"], entry["alphaCutoff"] = "MASK", cutoff
        elif alpha < 1 or texture_alpha:
            entry["alphaMode"] = "BLEND"
        strength = max(radiance)
        if strength > 0:
            entry["emissiveFactor"] = [x / strength for x in radiance]
            entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
            self._extensions.add("KHR_materials_emissive_strength")
        return self._add("materials", entry)

    def mesh(self, name, primitives):
        """Adds a mesh. `primitives`: dictionaries of attributes, indices and material."""
        return self._add("meshes", {"name": name, "primitives": primitives})

    def node(self, name, matrix, extras=None, **what):
        """Adds a node. `what`: its mesh or camera."""
        entry = {"name": name, "matrix": by_columns(matrix), **what}
        if extras:
            entry["extras"] = extras
        number = self._add("nodes", entry)
        self._document["nodes"][0]["children"].append(number)
        return number

    def camera(self, name, matrix, aspect, shift, half_angle=None, height=None, focus=None):
        """Adds a camera: perspective with `half_angle` (its tangent), or orthographic with `height`; both over the
        picture's height, `shift` in heights of the picture. `focus`: radius of the lens and distance at which it is
        sharp."""
        if height is None:
            from math import atan
            lens = {"type": "perspective",
                    "perspective": {"yfov": 2 * atan(half_angle), "aspectRatio": aspect, "znear": 0.01}}
        else:
            lens = {"type": "orthographic",
                    "orthographic": {"xmag": aspect * height / 2, "ymag": height / 2, "znear": 0, "zfar": 1000}}
        extras = {"shift": list(shift)} if any(shift) else {}
        if focus is not None:
            extras.update(aperture=focus[0], focusDistance=focus[1])
        if extras:
            lens["extras"] = extras
        self.node(name, matrix, camera=self._add("cameras", {"name": name, **lens}))

    def lamp(self, name, matrix, kind, intensity, color, sizes, casts_shadow=True, cone=None):
        """Adds a sun ("directional"), a sphere ("point") or a sphere with a cone ("spot"; inner and outer half angle in
        radians). `sizes`: angle (degrees) or radius."""
        self.has_lamps = True
        lamp = {"name": name, "type": kind, "intensity": intensity, "color": list(color), "extras": dict(sizes)}
        if cone is not None:
            lamp["spot"] = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
            lamp["extras"]["smooth"] = 1
        lamps = self._document.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lamps.append(lamp)
        self._extensions.add("KHR_lights_punctual")
        self.node(name, matrix, _shadow(casts_shadow), extensions={"KHR_lights_punctual": {"light": len(lamps) - 1}})

    def area_lamp(self, name, matrix, shape, size, radiance, casts_shadow=True):
        """Adds an area light that shines along −Z of the matrix. `shape`: "rectangle" or "ellipse"."""
        self.has_lamps = True
        extras = {"areaLamp": {"shape": shape, "size": list(size), "radiance": list(radiance)}}
        self.node(name, matrix, {**extras, **_shadow(casts_shadow)})

    def dome(self, name, matrix, radiance, image=None, visible=False, sampled=False):
        """Adds the sky: +Y of the matrix is up, -Z the direction of the picture's middle column; the picture is a
        separate file. `sampled`: evaluated by light samples, not as exact areas."""
        self.has_lamps = True
        self.domes.append((name, matrix, radiance, image, visible, sampled))
        dome = {"radiance": list(radiance), "visible": visible, "sampled": sampled}
        if image is not None:
            dome["image"] = image
        self.node(name, matrix, {"dome": dome})

    def without_nodes(self, beside):
        """Returns a file for another moment of the scene, without nodes, with all meshes, materials and images of this
        one under the same numbers. Their binary data are in a separate file named `beside`, which contains the result
        of `binary`."""
        other = Glb()
        other._extensions, other._beside = set(self._extensions), (beside, len(self._binary))
        for kind in ("accessors", "meshes", "materials", "images", "samplers", "textures"):
            if kind in self._document:
                other._document[kind] = list(self._document[kind])
        other._document["bufferViews"] = [{**view, "buffer": 1} for view in self._document.get("bufferViews", [])]
        return other

    def binary(self):
        return bytes(self._binary)

    def placed(self):
        """Returns nodes, cameras and lights as text, to compare moments; nodes refer to meshes by numbers."""
        return json.dumps([self._document.get(kind) for kind in ("nodes", "cameras", "extensions")])

    def encoded(self):
        document = dict(self._document)
        if self._extensions:
            document["extensionsUsed"] = sorted(self._extensions)
        filling = b"\0" * (-len(self._binary) % 4)
        if self._beside is not None and not self._binary:
            filling = b"\0" * 4  # no buffer is empty
        size = len(self._binary) + len(filling)
        if size:
            document["buffers"] = [{"byteLength": size}]
        if self._beside is not None:
            document["buffers"].append({"uri": self._beside[0], "byteLength": self._beside[1]})
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = [struct.pack("<II", len(text), 0x4E4F534A), text]
        if size:
            chunks += [struct.pack("<II", size, 0x004E4942), self._binary, filling]
        # All chunks are joined at once: each further concatenation would copy a dense mesh again.
        return b"".join([struct.pack("<III", 0x46546C67, 2, 12 + sum(map(len, chunks))), *chunks])


class OfThings(Glb):
    """A file whose nodes each name their Blender object, for `penumbra serve` (docs/serve.md)."""

    def __init__(self):
        super().__init__()
        self.thing = ""  # name of the object that the following nodes belong to
        self._number = 0  # of the last node; makes names unique: only the reader of all things renames equal ones
        self.things, self.shadeless = set(), set()  # things with nodes; things whose lamps cast no shadows

    def node(self, name, matrix, extras=None, **what):
        self.things.add(self.thing)
        self._number += 1
        if "mesh" not in what and (extras or {}).get("castsShadow") is False:
            self.shadeless.add(self.thing)
        return super().node(f"{self.thing}\u241f{self._number}\u241f{name}", matrix, extras, **what)


def _shadow(casts_shadow):
    return {} if casts_shadow else {"castsShadow": False}
