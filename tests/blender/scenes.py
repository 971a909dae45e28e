# SPDX-License-Identifier: Apache-2.0
"""Small scenes made by script: each shows one feature that an artist sets up in Blender. Run inside Blender.

Each function builds its scene from nothing; `SCENES` has the functions by name.
"""

from math import pi, radians

import bpy
import numpy
from mathutils import Matrix, Vector

SCENES = {}


def scene(build):
    SCENES[build.__name__] = build
    return build


def add(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler, thing.scale = location, [radians(x) for x in rotation], scale
    bpy.context.scene.collection.objects.link(thing)
    return thing


def diffuse(color=(0.8, 0.8, 0.8), name="Diffuse"):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, surface = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*color, 1)
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def emission(color, strength):
    material = bpy.data.materials.new("Emission")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, surface = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeEmission")
    surface.inputs["Color"].default_value = (*color, 1)
    surface.inputs["Strength"].default_value = strength
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def mesh(name, corners, faces, material=None):
    data = bpy.data.meshes.new(name)
    data.from_pydata(corners, [], faces)
    data.materials.append(material or diffuse())
    return data


def quad(name, material=None, half=1.0):
    return mesh(name, [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [(0, 1, 2, 3)], material)


def cube(name, material=None, half=0.5):
    corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh(name, corners, faces, material)


def lamp(kind, location, rotation=(0, 0, 0), scale=(1, 1, 1), name="Key", **values):
    data = bpy.data.lights.new(name, kind)
    for key, value in values.items():
        setattr(data, key, value)
    return add(name, data, location, rotation, scale)


def camera(location=(0, -7, 5), target=(0, 0, 0.3), **values):
    data = bpy.data.cameras.new("Shot")
    data.lens = 40
    for key, value in values.items():
        setattr(data, key, value)
    thing = add("Shot", data, location)
    thing.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = thing
    return thing


def stage(**lens):
    """A floor, a turned cube above it, and a camera."""
    add("Floor", quad("Floor", half=4))
    block = add("Block", cube("Block", diffuse((0.7, 0.5, 0.3))), (0.2, 0, 1), (20, 30, 40))
    camera(**lens)
    return block


@scene
def area_square():
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def area_rectangle():
    stage()
    lamp("AREA", (1, -1, 4), (10, 20, 30), (1, 1.5, 1), energy=300, shape="RECTANGLE", size=1.5, size_y=0.3, color=(1, 0.5, 0.2))


@scene
def area_disk():
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="DISK", size=1.2)


@scene
def area_ellipse():
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 30), (-1, 1.2, 1), energy=300, shape="ELLIPSE", size=1.5, size_y=0.5)


@scene
def sun():
    stage()
    lamp("SUN", (0, 0, 9), (35, 20, 0), energy=3, angle=radians(8))


@scene
def point():
    stage()
    lamp("POINT", (1, -1, 4), energy=500, shadow_soft_size=0.1)


@scene
def spot():
    stage()
    lamp("SPOT", (1, -1, 5), (12, 10, 0), energy=2000, shadow_soft_size=0.08, spot_size=radians(80), spot_blend=0.9)


@scene
def spot_rim():
    """A spot with a hard cone and a large lamp, each point of which has its own cone."""
    add("Floor", quad("Floor", half=4))
    camera()
    lamp("SPOT", (1, -1, 5), (12, 10, 0), energy=2000, shadow_soft_size=0.25, spot_size=radians(35), spot_blend=0.15)


@scene
def spot_wide():
    """A spot that lights nearly half of all directions, and nothing beyond its cone."""
    stage()
    lamp("SPOT", (1, -1, 2.5), (40, 30, 0), energy=1000, shadow_soft_size=0.05, spot_size=radians(175), spot_blend=0.3)


@scene
def emissive_plane():
    stage()
    add("Panel", quad("Panel", emission((1, 0.9, 0.7), 12), 0.5), (0.8, 0, 3), (200, 10, 0))


@scene
def emissive_tube():
    """A closed emissive tube with 12 flat sides."""
    stage()
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.1, depth=2, location=(0, -0.5, 2.5), rotation=(0, pi / 2, 0.4))
    bpy.context.object.name = "Tube"
    bpy.context.object.data.materials.append(emission((0.6, 0.8, 1), 15))


@scene
def emissive_sphere():
    stage()
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=0.3, location=(0.8, -0.6, 3))
    bpy.context.object.name = "Bulb"
    bpy.context.object.data.materials.append(emission((1, 1, 1), 20))


@scene
def camera_shift():
    """Shifts of the lens in a portrait picture, which are counted in its longer side."""
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 72, 112
    stage(shift_x=0.13, shift_y=-0.071)
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def orthographic_shift():
    stage(type="ORTHO", ortho_scale=6, shift_x=-0.09, shift_y=0.05)
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def depth_of_field():
    """Sharp at an object in front of the block; the floor passes through the plane of focus."""
    stage()
    focus = add("Focus", None, (0, -2, 0.5))
    field = bpy.data.cameras["Shot"].dof
    field.use_dof, field.focus_object, field.aperture_fstop, field.aperture_blades = True, focus, 0.05, 0
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def orthographic_depth_of_field():
    stage(type="ORTHO", ortho_scale=6)
    field = bpy.data.cameras["Shot"].dof
    field.use_dof, field.focus_distance, field.aperture_fstop = True, 6.5, 2.0
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


def keyed(owner, path, *values, frames=(1, 8)):
    """Keys a property at these frames, with linear interpolation."""
    for frame, value in zip(frames, values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)
    for curve in owner.id_data.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def in_motion():
    """The stage under its lamp, at frame 4, when the shutter opens for one frame."""
    block = stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1
    scene.cycles.motion_blur_position = "START"
    scene.frame_set(4)
    return block


@scene
def motion_of_a_thing():
    keyed(in_motion(), "location", (-1.5, 0, 1), (3, 0.5, 1.4))


@scene
def motion_of_the_camera():
    in_motion()
    keyed(bpy.context.scene.camera, "location", (-1.5, -7, 5), (2, -7, 4))


@scene
def motion_of_a_mesh():
    """A mesh that a shape key deforms."""
    block = in_motion()
    block.shape_key_add(name="Basis")
    tall = block.shape_key_add(name="Tall")
    for point in tall.data:
        point.co *= 1 + 2 * point.co.z
    keyed(tall, "value", 0, 1)


@scene
def motion_of_a_shining_thing():
    """An emissive panel that moves, and another object that moves, too."""
    keyed(in_motion(), "location", (-0.5, 0, 1), (1, 0.5, 1.2))
    bpy.data.objects.remove(bpy.data.objects["Key"])
    keyed(add("Panel", quad("Panel", emission((1, 0.6, 0.3), 8)), (0, 0, 4), (0, 0, 0), (0.5, 0.5, 1)), "location",
          (-2.5, 0, 4), (3, -1, 3.5))


@scene
def motion_and_lens():
    keyed(in_motion(), "location", (-1.5, 0, 1), (3, 0.5, 1.4))
    field = bpy.data.cameras["Shot"].dof
    field.use_dof, field.focus_distance, field.aperture_fstop, field.aperture_blades = True, 6, 0.1, 0


@scene
def sensor_fit():
    """A lens fitted to the sensor's height, a resolution of 50 %, and a camera with a scale."""
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 240, 160, 50
    stage(sensor_fit="VERTICAL", sensor_height=20, lens=30)
    bpy.context.scene.camera.scale = (2, 2, 2)
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def hidden():
    """An object, a lamp and a collection are hidden in renders; the block's neighbour is hidden only in the
    viewport."""
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)
    add("Hidden", cube("Hidden"), (-1.5, 0, 1)).hide_render = True
    lamp("AREA", (-2, -1, 4), name="Off", energy=500, size=1).hide_render = True
    collection = bpy.data.collections.new("Away")
    bpy.context.scene.collection.children.link(collection)
    collection.hide_render = True
    collection.objects.link(bpy.data.objects.new("Inside", cube("Inside")))
    add("Neighbour", cube("Neighbour"), (1.6, 0.3, 0.6)).hide_viewport = True
    data = bpy.data.cameras.new("Other")  # not the active one
    add("Other", data, (0, 0, 9))


@scene
def shadowless_lamp():
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)
    lamp("POINT", (-2, -1, 3), name="Fill", energy=100, shadow_soft_size=0.1).data.cycles.cast_shadow = False


@scene
def shadowless_object():
    stage().visible_shadow = False
    add("Other", cube("Other"), (-1.4, 0, 0.8), (10, 20, 30))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def instances():
    """A collection's instances, one of them mirrored, and an array."""
    add("Floor", quad("Floor", half=4))
    camera()
    collection = bpy.data.collections.new("Stone")
    collection.objects.link(bpy.data.objects.new("Stone", cube("Stone", half=0.25)))
    for i, scale in enumerate(((1, 1, 1), (-1, 1.4, 0.7), (0.6, 0.6, 2))):
        empty = add(f"Instance {i}", None, (i - 1.5, 0.5, 0.6), (10 * i, 20, 30), scale)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    row = add("Row", cube("Row", half=0.15), (-1, -1, 0.4))
    array = row.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 4, (2, 0, 0.3)
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def translucent():
    """A pane that lets 70 % of the light through, mixed from two shaders."""
    stage()
    material = diffuse((0.5, 0.6, 0.9), "Pane")
    tree = material.node_tree
    clear, mix = tree.nodes.new("ShaderNodeBsdfTransparent"), tree.nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.3
    surface, output = tree.nodes["Diffuse BSDF"], tree.nodes["Material Output"]
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(surface.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    material.blend_method = "BLEND"
    add("Pane", quad("Pane", material, 0.7), (-1.2, 0, 1.2), (20, 10, 0))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def cut_out():
    """An image's alpha cuts holes in a chequered pane, and the image gives the pane's colours, too. Texels are not
    interpolated, as holes have none."""
    stage()
    image = bpy.data.images.new("Chequers", 4, 4, alpha=True)
    image.pixels = [x for row in range(4) for column in range(4)
                    for x in ((0.9, 0.4, 0.1, 1.0) if (row + column) % 2 else (0.1, 0.4, 0.9, 0.0))]
    image.pack()
    material = diffuse(name="Cut")
    tree = material.node_tree
    picture, clear, mix = (tree.nodes.new(kind) for kind in
                           ("ShaderNodeTexImage", "ShaderNodeBsdfTransparent", "ShaderNodeMixShader"))
    picture.image, picture.interpolation = image, "Closest"
    surface, output = tree.nodes["Diffuse BSDF"], tree.nodes["Material Output"]
    tree.links.new(picture.outputs["Color"], surface.inputs["Color"])
    tree.links.new(picture.outputs["Alpha"], mix.inputs[0])
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(surface.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    material.blend_method = "CLIP"
    data = quad("Cut", material, 0.7)
    places = data.uv_layers.new(name="UVMap").data
    for loop, place in zip(places, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = place
    add("Cut", data, (-1.2, 0, 1.2), (20, 10, 0))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=0.5)


@scene
def curves_and_text():
    add("Floor", quad("Floor", half=4))
    camera()
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "V", 0.1, 1.5
    text.materials.append(diffuse((0.3, 0.7, 0.4)))
    add("Text", text, (-1.5, 0, 0.4), (70, 0, 20))
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.6, location=(0.9, 0, 1), rotation=(0.5, 0.4, 0))
    bpy.context.object.data.bevel_depth = 0.12
    bpy.context.object.data.materials.append(diffuse((0.8, 0.3, 0.3)))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def vertex_colors():
    add("Floor", quad("Floor", half=4))
    camera()
    material = diffuse(name="Painted")
    tree = material.node_tree
    paint = tree.nodes.new("ShaderNodeVertexColor")
    paint.layer_name = "Paint"
    tree.links.new(paint.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    data = cube("Painted", material)
    layer = data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for i, vertex in enumerate(layer.data):
        vertex.color = (0.1 + 0.8 * (i & 1), 0.1 + 0.4 * (i & 2), 0.1 + 0.2 * (i & 4), 1)
    add("Painted", data, (0.2, 0, 1), (20, 30, 40))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


@scene
def many_lamps():
    """Five lamps of different kinds and colours."""
    stage()
    lamp("AREA", (1, -1, 4), (15, 15, 0), name="Area", energy=100, shape="SQUARE", size=1.2, color=(1, 0.5, 0.3))
    lamp("AREA", (-2, 1, 3), (-20, -30, 0), name="Disk", energy=60, shape="DISK", size=0.8, color=(0.3, 1, 0.4))
    lamp("SUN", (0, 0, 9), (-35, 20, 0), name="Sun", energy=0.5, angle=radians(4))
    lamp("POINT", (-1, -2, 3), name="Point", energy=60, shadow_soft_size=0.05, color=(0.3, 0.4, 1))
    add("Panel", quad("Panel", emission((0.7, 0.9, 1), 4), 0.4), (0, 1.2, 2.6), (200, 0, 0))


@scene
def animated():
    """Frame 7 of keyed objects, a bone and a shape key."""
    stage()
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 10
    key = lamp("AREA", (0, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)
    block = bpy.data.objects["Block"]
    for thing, frame, x in ((key, 1, -1), (key, 10, 2), (block, 1, 1), (block, 10, -1)):
        thing.location.x = x
        thing.keyframe_insert("location", frame=frame)
    block.shape_key_add(name="Basis")
    tall = block.shape_key_add(name="Tall")
    for point in tall.data:
        point.co.z *= 1.5
    for frame, value in ((1, 0), (10, 1)):
        tall.value = value
        tall.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(7)


@scene
def monkey():
    """A flat-shaded mesh of several thousand triangles."""
    add("Floor", quad("Floor", half=4))
    camera()
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(0, 0, 1), rotation=(-0.5, 0, 0.3))
    bpy.context.object.modifiers.new("Subdivision", "SUBSURF").render_levels = 1
    bpy.context.object.data.materials.append(diffuse((0.8, 0.6, 0.4)))
    lamp("AREA", (1, -1.5, 4), (20, 15, 0), energy=300, shape="RECTANGLE", size=1.2, size_y=0.6)


@scene
def particles():
    """Objects scattered by a particle system; the emitter itself is not shown."""
    add("Floor", quad("Floor", half=4))
    camera()
    crumb = add("Crumb", cube("Crumb", half=0.5), (0, 0, -5))
    sower = add("Sower", quad("Sower", half=1.5), (0, 0, 0.5))
    sower.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = sower.particle_systems[0].settings
    settings.type, settings.count, settings.render_type = "HAIR", 20, "OBJECT"
    settings.use_advanced_hair = True
    settings.instance_object, settings.particle_size, settings.size_random = crumb, 0.1, 0.5
    sower.show_instancer_for_render = False
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


def scatter(thing, sower, turned=False):
    """Makes geometry nodes that put an object on the corners of a mesh, each turned randomly about Z if wanted."""
    nodes = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    nodes.inputs.new("NodeSocketGeometry", "Geometry"), nodes.outputs.new("NodeSocketGeometry", "Geometry")
    begin, end = nodes.nodes.new("NodeGroupInput"), nodes.nodes.new("NodeGroupOutput")
    what, put = nodes.nodes.new("GeometryNodeObjectInfo"), nodes.nodes.new("GeometryNodeInstanceOnPoints")
    what.inputs["Object"].default_value, what.inputs["As Instance"].default_value = thing, True
    nodes.links.new(begin.outputs[0], put.inputs["Points"])
    nodes.links.new(what.outputs["Geometry"], put.inputs["Instance"])
    nodes.links.new(put.outputs["Instances"], end.inputs[0])
    if turned:
        chance = nodes.nodes.new("FunctionNodeRandomValue")
        chance.data_type = "FLOAT_VECTOR"
        chance.inputs["Min"].default_value, chance.inputs["Max"].default_value = (0, 0, 0), (0, 0, 2 * pi)
        nodes.links.new(chance.outputs["Value"], put.inputs["Rotation"])
    sower.modifiers.new("Scatter", "NODES").node_group = nodes


def scattered():
    """Objects that geometry nodes put on the corners of a mesh; Blender's own glTF exporter leaves them out."""
    add("Floor", quad("Floor", half=4))
    camera()
    crumb = add("Crumb", cube("Crumb", half=0.2), (0, 0, -5))
    scatter(crumb, add("Sower", quad("Sower", half=1.2), (0, 0, 0.5)))
    lamp("AREA", (1, -1, 4), (15, 15, 0), energy=300, shape="SQUARE", size=1.2)


def world(color=(1, 1, 1), strength=1.0):
    """Makes a world with a Background node; returns its node tree and that node."""
    made = bpy.data.worlds.new("Sky")
    bpy.context.scene.world = made
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (*color, 1), strength
    return made.node_tree, background


def environment(width=32):
    """Returns a float picture of the surroundings, with a bright patch, and different in every direction."""
    height = width // 2
    image = bpy.data.images.new("Around", width, height, float_buffer=True)
    x, y = numpy.meshgrid((numpy.arange(width) + 0.5) / width, (numpy.arange(height) + 0.5) / height)
    values = numpy.ones((height, width, 4), numpy.float32)
    values[..., 0], values[..., 1], values[..., 2] = 0.2 + 0.8 * x, 0.2 + 0.5 * y, 0.6 - 0.4 * x * y
    patch = (numpy.abs(x - 0.7) < 0.08) & (numpy.abs(y - 0.7) < 0.1)
    values[patch, :3] = (12, 9, 5)
    image.pixels.foreach_set(values.ravel())
    image.pack()
    return image


def pictured_world(turn=(0, 0, 0), scale=(1, 1, 1), kind="POINT", **values):
    tree, background = world(strength=values.pop("strength", 1.0))
    picture, mapping, place = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexEnvironment", "Mapping", "TexCoord"))
    picture.image = environment()
    mapping.vector_type = kind
    mapping.inputs["Rotation"].default_value, mapping.inputs["Scale"].default_value = turn, scale
    for key, value in values.items():
        setattr(picture, key, value)
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], background.inputs["Color"])
    return tree, background


@scene
def world_color():
    """A world of constant radiance, lit in closed form."""
    stage()
    world((0.3, 0.5, 0.9), 1.5)
    bpy.context.scene.penumbra.world = "EXACT"


@scene
def world_color_counted():
    stage()
    world((0.3, 0.5, 0.9), 1.5)


@scene
def world_and_lamp():
    area_square()
    world((0.2, 0.3, 0.4), 2)


@scene
def world_picture():
    stage()
    pictured_world()


@scene
def world_picture_exact():
    """A world with a picture that is constant in each of its texels, lit in closed form."""
    stage()
    pictured_world((0.4, -0.3, 2.1), strength=2, interpolation="Closest")
    bpy.context.scene.penumbra.world = "EXACT"


@scene
def world_picture_turned():
    stage()
    pictured_world((0.4, -0.3, 2.1), strength=2)


@scene
def world_picture_texture_mapping():
    stage()
    pictured_world((-0.2, 0.5, 1.1), (2, 2, 2), "TEXTURE", interpolation="Closest")


@scene
def world_picture_mirrored():
    stage()
    pictured_world((0.1, 0, 0.7), (-1, 1, 1))


@scene
def world_camera_apart():
    """A world whose light differs from what the camera sees."""
    stage()
    tree, background = world((0.9, 0.7, 0.5))
    seen, mix, path = (tree.nodes.new(f"ShaderNode{name}") for name in ("Background", "MixShader", "LightPath"))
    seen.inputs["Color"].default_value = (0, 1, 0, 1)
    for number, source in enumerate((path.outputs["Is Camera Ray"], background.outputs[0], seen.outputs[0])):
        tree.links.new(source, mix.inputs[number])
    tree.links.new(mix.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_WORLD").inputs["Surface"])
    bpy.context.scene.penumbra.world = "EXACT"


@scene
def world_and_translucent():
    """A pane in front of the sky and the floor."""
    translucent()
    world((0.3, 0.5, 0.9), 1.5)


def tree(leaves=750):
    """A trunk of six sides, and a crown of square leaves, two triangles each."""
    random = numpy.random.default_rng(11)
    ring = [(numpy.cos(turn), numpy.sin(turn)) for turn in numpy.arange(6) * pi / 3]
    corners = [(0.06 * x, 0.06 * y, 0) for x, y in ring] + [(0.02 * x, 0.02 * y, 1.4) for x, y in ring]
    faces = [(i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6)]
    for _ in range(leaves):
        place = random.normal(size=3)
        place *= random.uniform(0.4, 1) / numpy.linalg.norm(place)
        across, along = random.normal(size=(2, 3))
        across /= numpy.linalg.norm(across)
        along = numpy.cross(across, along)
        along /= numpy.linalg.norm(along)
        middle = numpy.array((0, 0, 1.2)) + place * (0.45, 0.45, 0.8)
        faces.append(tuple(range(len(corners), len(corners) + 4)))
        corners += [tuple(middle + 0.06 * (s * across + t * along)) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    data = mesh("Tree", corners, faces, diffuse((0.3, 0.2, 0.1), "Bark"))
    data.materials.append(diffuse((0.25, 0.5, 0.15), "Leaf"))
    data.polygons.foreach_set("material_index", [0] * 6 + [1] * leaves)
    return data


@scene
def forest():
    """A glade, and around it about 450 trees of 1512 triangles under a sun and the sky: too many to be copied without
    need."""
    add("Floor", quad("Floor", diffuse((0.5, 0.5, 0.45)), half=24))
    camera((2, -17, 9), (0, -7, 0))
    random = numpy.random.default_rng(5)
    places = [(1.4 * (i % 22 - 10.5) + x, 1.4 * (i // 22 - 10.5) + y, 0) for i, (x, y) in enumerate(random.uniform(-0.6, 0.6, (484, 2)))]
    places = [place for place in places if place[0] ** 2 + (place[1] + 8) ** 2 > 4.5 ** 2]
    ground = bpy.data.meshes.new("Places")
    ground.from_pydata(places, [], [])
    scatter(add("Tree", tree(), (0, 0, -5)), add("Places", ground), turned=True)
    lamp("SUN", (0, 0, 9), (-35, 30, 0), name="Sun", energy=2, angle=radians(2))
    world((0.4, 0.6, 1), 0.4)
