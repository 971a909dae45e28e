# SPDX-License-Identifier: Apache-2.0
"""Blender's lamps and cameras in the exchange file's units. Uses only their names and values, not bpy.

Brightness is that of Cycles, measured (tests/blender/): a point or spot lamp of P watts has P / 4π candela, an area lamp
the radiance P / 4 A, a sun's strength is irradiance.
"""

from math import acos, cos, degrees, pi, radians, sqrt, tan

from . import graph, space

# Suns wider than _WIDEST_SUN are refused. Suns wider than _WIDE_SUN get a warning: on a surface that such a sun shines on at 45 degrees,
# its light is at least 2 % off.
_WIDEST_SUN, _WIDE_SUN = radians(120), radians(90)
# Largest difference in brightness between a lamp's ball and Cycles' disk that is not reported.
_UNSAID = 0.02


def emission_of(lamp, losses, name):
    """Returns the factor by which a lamp's nodes multiply its power."""
    if not lamp.use_nodes or lamp.node_tree is None:
        return (1.0, 1.0, 1.0)
    output = lamp.node_tree.get_output_node("CYCLES")
    surface = output.inputs["Surface"] if output else None
    if surface is None or not surface.is_linked:
        return (0.0, 0.0, 0.0)
    try:
        node, _, groups = graph.At(surface).source()
        if node.type != "EMISSION":
            raise graph.Unknown(f"the node '{node.name}'")
        strength = graph.constant(graph.At(node.inputs["Strength"], groups))[0]
        return tuple(x * strength for x in graph.constant(graph.At(node.inputs["Color"], groups)))
    except graph.Unknown as error:
        losses.refuse(f"is a lamp with {error}, which is not evaluated", name)
        return (1.0, 1.0, 1.0)


def sun_irradiance(strength, angle):
    """Returns Cycles' irradiance of a surface that faces a sun of this strength and apparent diameter (radians). Cycles spreads
    its samples evenly over the disk that touches the sphere of directions, and weights each by the surface's cosine."""
    squared = tan(angle / 2) ** 2
    return strength * (2 * (sqrt(1 + squared) - 1) / squared if squared > 1e-8 else 1.0)


def cone_of(lamp):
    """Returns a spot lamp's inner and outer half angle in radians. Light falls off between the two, whose cosines differ by `spot_blend`
    times 1 minus the outer angle's cosine, at least by 0.001."""
    outer = min(lamp.spot_size / 2, pi / 2)
    return acos(min(cos(outer) + max((1 - cos(outer)) * lamp.spot_blend, 0.001), 1.0)), outer


def size_of(lamp):
    """Returns an area lamp's shape and size across."""
    shape = "ellipse" if lamp.shape in ("DISK", "ELLIPSE") else "rectangle"
    both = lamp.shape in ("RECTANGLE", "ELLIPSE")
    return shape, (lamp.size, lamp.size_y if both else lamp.size)


def radiance_of_area(power, shape, size, sides):
    """Returns the radiance P / 4 A of an area lamp. `sides`: the matrix's first two columns, which need not be at right
    angles."""
    (a, b, c), (d, e, f) = sides
    area = size[0] * size[1] * sqrt((b * f - c * e) ** 2 + (c * d - a * f) ** 2 + (a * e - b * d) ** 2)
    area *= pi / 4 if shape == "ellipse" else 1
    return tuple(x / (4 * area) for x in power) if area > 0 else (0.0, 0.0, 0.0)


def _column(matrix, column):
    return tuple(matrix[row][column] for row in range(3))


def _length(matrix, column):
    return sqrt(sum(x * x for x in _column(matrix, column)))


def is_sheared(matrix):
    """Returns whether the matrix's axes are not at right angles."""
    def cosine(i, j):
        both = _length(matrix, i) * _length(matrix, j)
        return abs(sum(x * y for x, y in zip(_column(matrix, i), _column(matrix, j)))) / both if both > 0 else 0.0
    return max(cosine(0, 1), cosine(1, 2), cosine(2, 0)) > 1e-4


def power_of(lamp):
    """Returns the power in watts, or irradiance of suns; the exposure of newer Blenders is in it."""
    power = lamp.energy * 2 ** getattr(lamp, "exposure", 0.0)
    return tuple(power * x for x in lamp.color)


def is_linked(thing):
    """Returns whether an object lights or shades only some others (light linking, since Blender 4.0)."""
    linking = getattr(thing, "light_linking", None)
    return linking is not None and (linking.receiver_collection is not None or linking.blocker_collection is not None)


class Ball:
    """A lamp with a radius, which is a ball here. `is_disk`: in Cycles the lamp is a disk that faces each receiver; at
    distance d the receiver gets 1 + r² / d² times less light. For spot lamps the program computes that
    (visibility::spot_share)."""

    def __init__(self, name, center, radius, is_disk):
        self.name, self.center, self.radius, self.is_disk = name, center, radius, is_disk


def check_balls(balls, surfaces, losses):
    """Refuses balls that reach one of the `surfaces` (space.Placed), since surfaces inside would be black; mentions
    balls so near to a surface that it is brighter than in Cycles."""
    surfaces = space.Surfaces(surfaces)
    for ball in balls:
        surface, nearest = surfaces.nearest_to(ball.center, 8 * ball.radius)
        if surface is None:
            continue
        name = surface.name
        if nearest <= ball.radius:
            losses.refuse(f"is a lamp whose radius, {ball.radius:.3g}, reaches '{name}', {nearest:.3g} from its middle: surfaces "
                          "inside would be black; make it smaller", ball.name)
        elif ball.is_disk and (ball.radius / nearest) ** 2 > _UNSAID:
            losses.mention(f"is a ball here and a disk in Cycles, and only {nearest:.3g} away from '{name}', with a radius of "
                           f"{ball.radius:.3g}: up to {100 * (ball.radius / nearest) ** 2:.0f} % brighter there", ball.name)


def write_lamp(lamp, name, matrix, glb, losses):
    """Adds a lamp to the file, unless it sends no light. `matrix`: rows. Returns its Balls."""
    factor = emission_of(lamp, losses, name)
    power = tuple(x * y for x, y in zip(power_of(lamp), factor))
    if min(power) < 0:
        losses.refuse("is a lamp with a negative power", name)
        return []
    if max(power) <= 0:
        return []
    own = getattr(lamp, "cycles", None)
    if own is not None and getattr(own, "is_portal", False):
        return []
    if not getattr(lamp, "normalize", True):
        losses.refuse("is a lamp whose power is not normalized by its size", name)
    if getattr(lamp, "use_temperature", False):
        losses.refuse("is a lamp whose colour is a temperature; use a Blackbody node, or set the colour", name)
    shades = lamp.use_shadow and (own is None or getattr(own, "cast_shadow", True))
    if lamp.type == "AREA":
        _write_area(lamp, name, matrix, power, glb, losses, shades)
        return []
    strength = max(power)
    color = [x / strength for x in power]
    if lamp.type == "SUN":
        if lamp.angle > _WIDEST_SUN * (1 + 1e-6):
            losses.refuse("is a sun wider than 120 degrees, whose light Cycles does not spread evenly over directions", name)
        elif lamp.angle > _WIDE_SUN * (1 + 1e-6):
            losses.mention("is a sun wider than 90 degrees: on surfaces that do not face it directly, it may be "
                           "2 % darker than in Cycles at 45 degrees and 8 % at 60", name)
        glb.lamp(name, matrix, "directional", sun_irradiance(strength, lamp.angle), color,
                 {"angle": degrees(lamp.angle)}, shades)
        return []
    radius = lamp.shadow_soft_size
    if radius <= 0:
        radius = 1e-4
        losses.mention("has no radius; 0.0001 is used", name)
    kind, cone = "point", None
    if lamp.type == "SPOT":
        kind, cone = "spot", cone_of(lamp)
        scale = [_length(matrix, column) for column in range(3)]
        if max(scale) > min(scale) * (1 + 1e-5):
            losses.refuse("is a spot lamp scaled to an ellipse", name)
    glb.lamp(name, matrix, kind, strength / (4 * pi), color, {"radius": radius}, shades, cone)
    is_disk = kind == "point" and getattr(lamp, "use_soft_falloff", True)
    return [Ball(name, [matrix[row][3] for row in range(3)], radius, is_disk)]


def _write_area(lamp, name, matrix, power, glb, losses, shades):
    shape, size = size_of(lamp)
    if lamp.spread < pi * (1 - 1e-6):
        losses.refuse("is an area lamp whose light is spread less than 180 degrees", name)
    radiance = radiance_of_area(power, shape, size, (_column(matrix, 0), _column(matrix, 1)))
    if max(radiance) <= 0:
        return
    if is_sheared(matrix):
        losses.mention("is an area lamp that is sheared (by a parent with uneven scale): its power is right, and its shape is as in the viewport; in Cycles it may be different", name)
    glb.area_lamp(name, matrix, shape, size, radiance, shades)


def lens_of(camera, region):
    """Returns glb.camera's arguments of a lens for a frames.Region: shift, and half_angle or height."""
    width, height = region.whole
    wide = width >= height if camera.sensor_fit == "AUTO" else camera.sensor_fit == "HORIZONTAL"
    fitted = width if wide else height  # the side that the sensor, or the scale, applies to
    sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    rows = region.size[1]
    lens = {"shift": tuple(shift * fitted / rows + away
                           for shift, away in zip((camera.shift_x, camera.shift_y), region.shift_of_middle()))}
    if camera.type == "ORTHO":
        lens["height"] = camera.ortho_scale * rows / fitted
    else:
        lens["half_angle"] = sensor / (2 * camera.lens) * rows / fitted
    return lens


def focus_of(camera, matrix):
    """Returns the radius of the camera's lens and the focus distance, as in Cycles; None: everything is sharp.
    `matrix`: the camera object's, without scale."""
    lens, field = camera.data, camera.data.dof
    if not field.use_dof:
        return None
    focal_length = 1.0 if lens.type == "ORTHO" else lens.lens / 1000
    distance = field.focus_distance
    if field.focus_object is not None:
        away = [field.focus_object.matrix_world[row][3] - matrix[row][3] for row in range(3)]
        distance = abs(sum(a * b for a, b in zip(away, _column(matrix, 2))))
    radius = focal_length / (2 * field.aperture_fstop)
    return (radius, max(distance, 1e-5)) if radius > 0 else None


def has_blades(field):
    return field.aperture_blades >= 3 or field.aperture_ratio != 1


def without_scale(matrix):
    """Returns the matrix with columns of length 1: cameras are not stretched."""
    lengths = [_length(matrix, column) or 1.0 for column in range(3)] + [1.0]
    return [[matrix[row][column] / lengths[column] for column in range(4)] for row in range(4)]
