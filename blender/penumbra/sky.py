# SPDX-License-Identifier: Apache-2.0
"""Blender's world as a dome light, and as the background. Uses only names and values of nodes and images,
not bpy.

An environment's picture is mapped as in Cycles: direction d shows the texel at M d. The picture's middle column is
along +X, its top row along +Z, and -Y is to the right of the middle. M is the matrix of the mapping nodes: a rotation,
possibly with a reflection.
"""

import os
from dataclasses import dataclass

import numpy

from . import exr, graph, texels
from .graph import At, Unknown, find_socket

SAMPLED, EXACT, SEEN = "SAMPLED", "EXACT", "SEEN"
PICTURE = "world.exr"  # name of the picture's file
_LARGEST = 8192  # texels a side, limit of the program


@dataclass
class Sky:
    """Light from all directions: `radiance` times the picture's texels, if there is a picture."""
    radiance: tuple = (0.0, 0.0, 0.0)
    image: object = None    # graph.ImageUse
    pixels: object = None   # linear texels, in place of the image's

    @property
    def is_dark(self):
        return max(self.radiance) <= 0


def may_light(world):
    """Returns whether the world emits light. Called before a render, to name the passes."""
    if world is None:
        return False
    if not world.use_nodes or world.node_tree is None:
        return max(world.color) > 0
    for node in world.node_tree.nodes:
        if node.type == "BACKGROUND":
            color, strength = node.inputs["Color"], node.inputs["Strength"]
            if (color.is_linked or max(color.default_value[:3]) > 0) and (strength.is_linked or strength.default_value > 0):
                return True
    return False


def skies_of(world):
    """Returns the Sky that lights the scene and the Sky that the camera sees. Raises Unknown if a node is not
    evaluated."""
    if not world.use_nodes or world.node_tree is None:
        sky = Sky(tuple(world.color))
        return sky, sky
    output = world.node_tree.get_output_node("CYCLES")
    source = At(output.inputs["Surface"]).source() if output else None
    if source is None:
        return Sky(), Sky()
    node, _, groups = source
    if node.type != "MIX_SHADER":
        sky = _background(source)
        return sky, sky
    share = At(node.inputs[0], groups).source()
    if share is None or share[0].type != "LIGHT_PATH" or share[1].name != "Is Camera Ray":
        raise Unknown(f"the node '{node.name}', which does not separate lighting from what the camera sees (Light Path, Is Camera Ray)")
    return tuple(_background(At(node.inputs[number], groups).source()) for number in (1, 2))


def _background(source):
    if source is None:
        return Sky()
    node, _, groups = source
    if node.type != "BACKGROUND":
        raise Unknown(f"the node '{node.name}'")
    strength = graph.constant(At(node.inputs["Strength"], groups))[0]
    if strength == 0:
        return Sky()
    value = graph.evaluate(At(node.inputs["Color"], groups))
    if value.attribute is not None:
        raise Unknown("a colour attribute")
    if value.image is not None and value.image.node.type != "TEX_ENVIRONMENT":
        raise Unknown(f"the node '{value.image.node.name}', which is not an Environment Texture")
    return Sky(tuple(float(x) * strength for x in value.factor), value.image, value.pixels)


def looked_up(sky):
    """Returns the picture's mapping M, a 3 x 3 matrix of orthogonal rows."""
    node = sky.image.node
    if node.projection != "EQUIRECTANGULAR":
        raise Unknown(f"the node '{node.name}', whose projection is not Equirectangular")
    if graph.is_moved(getattr(node, "texture_mapping", None)):
        raise Unknown(f"the node '{node.name}', which has a texture mapping of its own (use a Mapping node)")
    return _mapped(At(find_socket(node.inputs, "Vector"), sky.image.groups))


def _mapped(at):
    source = at.source()
    if source is None:
        return numpy.eye(3)
    node, output, groups = source
    if node.type == "TEX_COORD" and output.name in ("Generated", "Object") and getattr(node, "object", None) is None:
        return numpy.eye(3)
    if node.type != "MAPPING":
        raise Unknown(f"the node '{node.name}', which places its picture and is not supported")

    def numbers(name, default):
        socket = find_socket(node.inputs, name)
        usable = socket is not None and getattr(socket, "enabled", True)
        return numpy.array(graph.constant(At(socket, groups))) if usable else numpy.array(default)
    place, turn, scale = (numbers(name, default) for name, default in
                          (("Location", (0.0, 0.0, 0.0)), ("Rotation", (0.0, 0.0, 0.0)), ("Scale", (1.0, 1.0, 1.0))))
    if place.any() and node.vector_type in ("POINT", "TEXTURE"):
        raise Unknown(f"the node '{node.name}', which translates its picture (only rotations are supported)")
    lengths = numpy.abs(scale)
    if lengths.min() <= 0 or lengths.max() > lengths.min() * (1 + 1e-5):
        raise Unknown(f"the node '{node.name}', which scales its picture unevenly")
    own = _turned(turn) @ numpy.diag(numpy.sign(scale)) if node.vector_type != "TEXTURE" else \
        numpy.diag(numpy.sign(scale)) @ _turned(turn).T
    return own @ _mapped(At(find_socket(node.inputs, "Vector"), groups))


def _turned(angles):
    """Returns the matrix of rotations about X, then Y, then Z."""
    (a, b, c), (sa, sb, sc) = numpy.cos(angles), numpy.sin(angles)
    about_x = numpy.array(((1, 0, 0), (0, a, -sa), (0, sa, a)))
    about_y = numpy.array(((b, 0, sb), (0, 1, 0), (-sb, 0, b)))
    about_z = numpy.array(((c, -sc, 0), (sc, c, 0), (0, 0, 1)))
    return about_z @ about_y @ about_x


def placed(matrix):
    """Returns the matrix, as rows, of the node of a dome whose picture is mapped by `matrix` (in the node +Y is up, -Z
    the middle column), and whether the picture must be mirrored."""
    mirrored = numpy.linalg.det(matrix) < 0
    if mirrored:
        matrix = numpy.diag((1.0, -1.0, 1.0)) @ matrix
    columns = matrix.T @ numpy.array(((0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    rows = numpy.eye(4)
    rows[:3, :3] = columns
    return rows.tolist(), mirrored


def picture(sky, mirrored):
    """Returns the picture's texels: height x width x 3, linear, first row at the top."""
    values = sky.pixels if sky.pixels is not None else texels.linear(sky.image.node)
    while max(values.shape[:2]) > _LARGEST:
        rows, columns = (side // 2 * 2 for side in values.shape[:2])
        values = values[:rows, :columns].reshape(rows // 2, 2, columns // 2, 2, 3).mean(axis=(1, 3))
    values = numpy.maximum(values, 0)
    return values[:, ::-1] if mirrored else values


def write(world, name, wanted, is_seen, glb, path, losses):
    """Adds the dome to the file, and writes its picture, if it has one, to `path` in the same folder. `wanted`:
    SAMPLED, EXACT or SEEN; `is_seen`: the film shows the world. Returns the colour that must still be composited behind
    everything."""
    try:
        if world.use_nodes and world.node_tree is not None:
            output = world.node_tree.get_output_node("CYCLES")
            if output and output.inputs["Volume"].is_linked:
                losses.refuse("is a world with a volume, which is not rendered", name)
        lights, seen = skies_of(world)
        visibility = getattr(world, "cycles_visibility", None)
        if not getattr(visibility, "diffuse", True):
            lights = Sky()
        if not getattr(visibility, "camera", True) or not is_seen:
            seen = Sky()
        for sky in (lights, seen):
            if sky.image is not None and not texels.knows_space(sky.image.node.image):
                space = sky.image.node.image.colorspace_settings.name
                losses.refuse(f"is a world with a picture in the colour space {space}, which is not known", name)
        if wanted == SEEN and not lights.is_dark:
            losses.mention("is a world whose light is left out (World, Surface, Light)", name)
        if wanted == SEEN and lights is not seen:
            lights = Sky()
        return _write(lights, seen, name, wanted, glb, path, losses)
    except Unknown as error:
        losses.refuse(f"is a world made by {error}, which is not evaluated; render it with a panoramic camera of Cycles into a "
                      "picture, and make that an Environment Texture (left out, it is black and lights nothing)", name)
    except OSError as error:
        losses.refuse(f"is a world with a picture that cannot be read ({error})", name)
    return (0.0, 0.0, 0.0)


def _write(lights, seen, name, wanted, glb, path, losses):
    if min(*lights.radiance, *seen.radiance) < 0:
        losses.refuse("is a world with a colour below 0", name)
        return (0.0, 0.0, 0.0)
    if seen.image is not None and (seen is not lights or wanted == SEEN):
        raise Unknown("a picture that only the camera sees")
    if not lights.is_dark and wanted != SEEN:
        if lights.image is None:
            file, matrix = None, numpy.eye(4).tolist()
        else:
            matrix, mirrored = placed(looked_up(lights))
            file = _save(picture(lights, mirrored), path)
        glb.dome(name, matrix, lights.radiance, file, seen.image is not None, wanted == SAMPLED)
    return seen.radiance if seen.image is None else (0.0, 0.0, 0.0)


def _save(values, path):
    """Writes a picture's file. A program that reads meanwhile gets either the complete earlier file or the complete new one.
    Returns the file's name."""
    with open(path + ".part", "wb") as out:
        out.write(exr.encoded({letter: values[..., number] for number, letter in enumerate("RGB")}))
    os.replace(path + ".part", path)
    return os.path.basename(path)
