"""Blender's lamps and cameras in the exchange file's units. Knows their names and values alone, not bpy.

Brightness is that of Cycles, measured (tests/blender/): a point or spot lamp of P watts has P / 4π candela, an area lamp
the radiance P / 4 A, a sun's strength is irradiance.
"""

from math import acos, cos, degrees, pi, sqrt, tan


def emission_of(lamp, losses, name):
    """What a lamp's nodes multiply its power by."""
    if not lamp.use_nodes or lamp.node_tree is None:
        return (1.0, 1.0, 1.0)
    output = lamp.node_tree.get_output_node("CYCLES")
    surface = output.inputs["Surface"] if output else None
    if surface is None or not surface.is_linked:
        return (0.0, 0.0, 0.0)
    node = surface.links[0].from_node
    if node.type != "EMISSION" or node.inputs["Color"].is_linked or node.inputs["Strength"].is_linked:
        losses.refuse("is a lamp with nodes that are not evaluated", name)
        return (1.0, 1.0, 1.0)
    return tuple(x * node.inputs["Strength"].default_value for x in node.inputs["Color"].default_value[:3])


def sun_irradiance(strength, angle):
    """Of what faces a sun of this apparent diameter (radians). Cycles spreads its samples evenly over the disk that
    touches the sphere of directions; each gives the cosine of what it lights."""
    squared = tan(angle / 2) ** 2
    return strength * (2 * (sqrt(1 + squared) - 1) / squared if squared > 1e-8 else 1.0)


def cone_of(lamp):
    """A spot lamp's inner and outer half angle in radians: it falls over `blend` of the cosines, at least 0.001."""
    outer = min(lamp.spot_size / 2, pi / 2)
    return acos(min(cos(outer) + max((1 - cos(outer)) * lamp.spot_blend, 0.001), 1.0)), outer


def size_of(lamp):
    """An area lamp's shape and size across."""
    shape = "ellipse" if lamp.shape in ("DISK", "ELLIPSE") else "rectangle"
    both = lamp.shape in ("RECTANGLE", "ELLIPSE")
    return shape, (lamp.size, lamp.size_y if both else lamp.size)


def radiance_of_area(power, shape, size, scale):
    """`scale`: the lengths of the matrix's first two columns."""
    area = size[0] * scale[0] * size[1] * scale[1] * (pi / 4 if shape == "ellipse" else 1)
    return tuple(x / (4 * area) for x in power) if area > 0 else (0.0, 0.0, 0.0)


def _length(matrix, column):
    return sqrt(sum(matrix[row][column] ** 2 for row in range(3)))


def write_lamp(lamp, name, matrix, glb, losses):
    """Adds a lamp to the file. `matrix`: rows. One that is off, or has no size to be seen by, is none."""
    factor = emission_of(lamp, losses, name)
    power = tuple(lamp.energy * x * y for x, y in zip(lamp.color, factor))
    if min(power) < 0:
        losses.refuse("is a lamp that takes light away", name)
        return
    if max(power) <= 0:
        return
    own = getattr(lamp, "cycles", None)
    if own is not None and getattr(own, "is_portal", False):
        return
    shades = lamp.use_shadow and (own is None or getattr(own, "cast_shadow", True))
    if lamp.type == "AREA":
        shape, size = size_of(lamp)
        if lamp.spread < pi * (1 - 1e-6):
            losses.refuse("is an area lamp whose light is spread less than 180 degrees", name)
        radiance = radiance_of_area(power, shape, size, (_length(matrix, 0), _length(matrix, 1)))
        if max(radiance) > 0:
            glb.area_lamp(name, matrix, shape, size, radiance, shades)
        return
    strength = max(power)
    color = [x / strength for x in power]
    if lamp.type == "SUN":
        glb.lamp(name, matrix, "directional", sun_irradiance(strength, lamp.angle), color,
                 {"angle": degrees(lamp.angle)}, shades)
        return
    radius = lamp.shadow_soft_size
    if radius <= 0:
        radius = 1e-4
        losses.mention("has no radius; taken as 0.0001", name)
    kind, cone = "point", None
    if lamp.type == "SPOT":
        kind, cone = "spot", cone_of(lamp)
        scale = [_length(matrix, column) for column in range(3)]
        if max(scale) > min(scale) * (1 + 1e-5):
            losses.refuse("is a spot lamp scaled to an ellipse", name)
    glb.lamp(name, matrix, kind, strength / (4 * pi), color, {"radius": radius}, shades, cone)


def lens_of(camera, width, height):
    """What glb.camera takes of a lens for a picture of so many pixels: shift, and half_angle or height."""
    wide = width >= height if camera.sensor_fit == "AUTO" else camera.sensor_fit == "HORIZONTAL"
    fitted = width if wide else height  # the side that the sensor, or the scale, is of
    sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    lens = {"shift": (camera.shift_x * fitted / height, camera.shift_y * fitted / height)}
    if camera.type == "ORTHO":
        lens["height"] = camera.ortho_scale * height / fitted
    else:
        lens["half_angle"] = sensor / (2 * camera.lens) * height / fitted
    return lens


def without_scale(matrix):
    """The matrix with columns of length 1: cameras are not stretched."""
    lengths = [_length(matrix, column) or 1.0 for column in range(3)] + [1.0]
    return [[matrix[row][column] / lengths[column] for column in range(4)] for row in range(4)]
