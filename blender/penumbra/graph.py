# SPDX-License-Identifier: Apache-2.0
"""Node trees: finds the source of a socket through reroutes, muted nodes and groups, and evaluates numbers and colours
that are constant or depend on one image. Uses only names and values of nodes, not bpy."""

import math

import numpy

from . import spectrum, texels


class Unknown(Exception):
    """Raised for a node that is not evaluated; its text names the node."""


def find_socket(sockets, *names):
    """Returns the first socket with one of the names, or None. Compares identifiers first: Blender does not rename or translate them."""
    for name in names:
        for socket in sockets:
            if getattr(socket, "identifier", None) == name:
                return socket
        for socket in sockets:
            if getattr(socket, "name", None) == name:
                return socket
        if name in sockets:
            return sockets[name]
    return None


def is_moved(mapping):
    return mapping is not None and (any(mapping.translation) or any(mapping.rotation) or any(x != 1 for x in mapping.scale))


class At:
    """A socket in its tree. `groups`: the group nodes that contain the tree, outermost first."""

    def __init__(self, socket, groups=()):
        self.socket, self.groups = socket, groups

    def source(self):
        """Returns the source of the socket as (node, output, groups). If there is none, returns None and sets `end` to
        the socket whose own value is used."""
        at = self
        while True:
            if not at.socket.is_linked:
                self.end = at.socket
                return None
            link = at.socket.links[0]
            node, output, groups = link.from_node, link.from_socket, at.groups
            if getattr(node, "mute", False):
                inner = next((one for one in node.internal_links if one.to_socket == output), None)
                if inner is None:
                    raise Unknown(f"the muted node '{node.name}'")
                at = At(inner.from_socket, groups)
            elif node.type == "REROUTE":
                at = At(node.inputs[0], groups)
            elif node.type == "GROUP":
                end = _group_output(node)
                at = At(_like(end.inputs, output, node), groups + (node,))
            elif node.type == "GROUP_INPUT" and groups:
                at = At(_like(groups[-1].inputs, output, node), groups[:-1])
            else:
                return node, output, groups


def _group_output(node):
    ends = [one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT"] if node.node_tree else []
    active = [one for one in ends if getattr(one, "is_active_output", True)]
    if not active:
        raise Unknown(f"the node group '{node.name}', which has no output")
    return active[0]


def _like(sockets, socket, node):
    """Returns the matching socket on the other side of a group."""
    for one in sockets:
        if one.identifier == socket.identifier:
            return one
    raise Unknown(f"the node group '{node.name}'")


class Value:
    """Colour of three channels: `factor` times the image's colour (linear; or `pixels`, if computed) and the
    attribute's."""

    def __init__(self, factor=(1.0, 1.0, 1.0), image=None, attribute=None, pixels=None):
        self.factor = numpy.broadcast_to(numpy.asarray(factor, numpy.float64), (3,))
        self.image, self.attribute, self.pixels = image, attribute, pixels

    @property
    def is_constant(self):
        return self.image is None and self.attribute is None

    def array(self):
        """Returns the three channels: one colour, or one for each texel."""
        if self.attribute is not None:
            raise Unknown("a colour attribute that is not multiplied")
        if self.image is None:
            return self.factor
        return (self.pixels if self.pixels is not None else texels.linear(self.image.node)) * self.factor

    def times(self, other):
        if (self.image and other.image) or (self.attribute is not None and other.attribute is not None):
            return None
        image = self if self.image else other
        return Value(self.factor * other.factor, image.image, self.attribute if self.attribute is not None else other.attribute,
                     image.pixels)


class ImageUse:
    """An image node, and the groups that contain it."""

    def __init__(self, node, groups):
        self.node, self.groups = node, groups

    def is_like(self, other):
        return self.node == other.node and self.groups == other.groups


def evaluate(at):
    """Returns the Value of a colour, vector or number input. Raises Unknown if a node is not evaluated."""
    source = at.source()
    if source is None:
        value = at.end.default_value
        return Value(value[:3] if hasattr(value, "__len__") else value)
    node, output, groups = source
    if node.type == "RGB":
        return Value(node.outputs[0].default_value[:3])
    if node.type == "VALUE":
        return Value(node.outputs[0].default_value)
    if node.type in ("TEX_IMAGE", "TEX_ENVIRONMENT") and node.image is not None and output.name == "Color":
        return Value(image=ImageUse(node, groups))
    if node.type == "VERTEX_COLOR" and output.name == "Color":
        return Value(attribute=node.layer_name)
    if node.type == "ATTRIBUTE" and output.name == "Color" and getattr(node, "attribute_type", "GEOMETRY") == "GEOMETRY":
        return Value(attribute=node.attribute_name)
    rule = _RULES.get(node.type)
    if rule is None:
        raise Unknown(f"the node '{node.name}'")
    return rule(node, output, groups)


def constant(at):
    """Returns three numbers. Raises Unknown if they differ from place to place."""
    value = evaluate(at)
    if not value.is_constant:
        raise Unknown("an image" if value.image else "a colour attribute")
    return tuple(float(x) for x in value.factor)


def _in(node, groups, *names):
    socket = find_socket(node.inputs, *names) if isinstance(names[0], str) else node.inputs[names[0]]
    if socket is None:
        raise Unknown(f"the node '{node.name}'")
    return evaluate(At(socket, groups))


def _computed(rule, *values):
    """Applies a function of arrays to values that share at most one image."""
    images = [value.image for value in values if value.image is not None]
    if any(not image.is_like(images[0]) for image in images):
        raise Unknown("several images, which are mixed")
    result = rule(*(value.array() for value in values))
    if not images:
        return Value(result)
    return Value(image=images[0], pixels=numpy.broadcast_to(result, numpy.broadcast_shapes(result.shape, (1, 1, 3))))


def _number(array):
    """Returns a colour as a number as Blender converts it: its luminance."""
    grey = array[..., 0] == array[..., 1]
    weighed = array @ numpy.array([0.2126, 0.7152, 0.0722])
    return numpy.where(grey & (array[..., 1] == array[..., 2]), array[..., 0], weighed)[..., None]


def _mix(node, output, groups):
    if node.type == "MIX":
        if node.data_type not in ("RGBA", "FLOAT") or getattr(node, "factor_mode", "UNIFORM") != "UNIFORM":
            raise Unknown(f"the node '{node.name}'")
        end = {"RGBA": "Color", "FLOAT": "Float"}[node.data_type]
        share, a, b = (_in(node, groups, f"{name}_{end}") for name in ("Factor", "A", "B")) if end == "Float" else \
            (_in(node, groups, name) for name in ("Factor_Float", "A_Color", "B_Color"))
        kind = node.blend_type if end == "Color" else "MIX"
        bounded = getattr(node, "clamp_factor", True)
        clamp = getattr(node, "clamp_result", False) and end == "Color"
    else:
        share, a, b = (_in(node, groups, number) for number in range(3))
        kind, bounded, clamp = node.blend_type, True, node.use_clamp
    if kind == "MULTIPLY" and share.is_constant and share.factor[0] == 1 and not clamp:
        product = a.times(b)
        if product is not None:
            return product
    if kind == "MIX" and share.is_constant and not clamp and share.factor[0] in (0, 1):
        return b if share.factor[0] else a
    blend = _BLENDS.get(kind)
    if blend is None:
        raise Unknown(f"the node '{node.name}' ({kind.lower()})")

    def rule(t, x, y):
        t = _number(t)
        t = numpy.clip(t, 0, 1) if bounded else t
        mixed = blend(t, x, y)
        return numpy.clip(mixed, 0, 1) if clamp else mixed
    return _computed(rule, share, a, b)


def _divided(t, x, y):
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return numpy.where(y != 0, (1 - t) * x + t * x / y, x)


def _overlay(t, x, y):
    return numpy.where(x < 0.5, x * (1 - t + 2 * t * y), 1 - (1 - t + 2 * t * (1 - y)) * (1 - x))


_BLENDS = {
    "MIX": lambda t, x, y: x + (y - x) * t,
    "MULTIPLY": lambda t, x, y: x * (1 - t + t * y),
    "ADD": lambda t, x, y: x + t * y,
    "SUBTRACT": lambda t, x, y: x - t * y,
    "SCREEN": lambda t, x, y: 1 - (1 - t + t * (1 - y)) * (1 - x),
    "DARKEN": lambda t, x, y: x + (numpy.minimum(x, y) - x) * t,
    "LIGHTEN": lambda t, x, y: x + (numpy.maximum(x, y) - x) * t,
    "DIFFERENCE": lambda t, x, y: x + (numpy.abs(x - y) - x) * t,
    "DIVIDE": _divided,
    "OVERLAY": _overlay,
}


def _hue_saturation(node, output, groups):
    def rule(hue, saturation, value, share, color):
        h, s, v = texels.hsv_of(color)
        h = numpy.mod(h + _number(hue)[..., 0] + 0.5, 1)
        s = numpy.clip(s * _number(saturation)[..., 0], 0, 1)
        v = v * _number(value)[..., 0]
        changed = texels.rgb_of(h, s, v)
        return numpy.maximum(color + (changed - color) * _number(share), 0)
    return _computed(rule, *(_in(node, groups, *names) for names in
                             (("Hue",), ("Saturation",), ("Value",), ("Fac", "Factor"), ("Color",))))


def _gamma(node, output, groups):
    return _computed(lambda color, gamma: numpy.where(color > 0, numpy.maximum(color, 1e-30) ** _number(gamma), color),
                     _in(node, groups, "Color"), _in(node, groups, "Gamma"))


def _bright_contrast(node, output, groups):
    def rule(color, bright, contrast):
        contrast = _number(contrast)
        return numpy.maximum((1 + contrast) * color + _number(bright) - contrast / 2, 0)
    return _computed(rule, _in(node, groups, "Color"), _in(node, groups, "Bright", "Brightness"), _in(node, groups, "Contrast"))


def _invert(node, output, groups):
    return _computed(lambda share, color: color + (1 - 2 * color) * _number(share),
                     _in(node, groups, "Fac", "Factor"), _in(node, groups, "Color"))


def _grey(node, output, groups):
    return _computed(lambda color: numpy.repeat((color @ numpy.array([0.2126, 0.7152, 0.0722]))[..., None], 3, axis=-1),
                     _in(node, groups, "Color"))


def _separate(node, output, groups):
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unknown(f"the node '{node.name}'")
    channel = list(node.outputs).index(output)
    return _computed(lambda color: numpy.repeat(color[..., channel:channel + 1], 3, axis=-1), evaluate(At(node.inputs[0], groups)))


def _combine(node, output, groups):
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unknown(f"the node '{node.name}'")
    return _computed(lambda *parts: numpy.concatenate(numpy.broadcast_arrays(*(_number(part) for part in parts)), axis=-1),
                     *(evaluate(At(node.inputs[number], groups)) for number in range(3)))


def _ramp(node, output, groups):
    alpha = output.name == "Alpha"
    table = numpy.array([node.color_ramp.evaluate(i / 1024) for i in range(1025)])
    table = numpy.repeat(table[:, 3:], 3, axis=-1) if alpha else table[:, :3]

    def rule(share):
        at = numpy.clip(_number(share)[..., 0], 0, 1)
        if at.ndim == 0:
            exact = node.color_ramp.evaluate(float(at))
            return numpy.array([exact[3]] * 3 if alpha else exact[:3])
        return numpy.stack([numpy.interp(at, numpy.linspace(0, 1, 1025), table[:, i]) for i in range(3)], axis=-1)
    return _computed(rule, _in(node, groups, "Fac", "Factor"))


def _blackbody(node, output, groups):
    return Value(spectrum.blackbody(constant(At(node.inputs[0], groups))[0]))


def _math(node, output, groups):
    rule = _MATH.get(node.operation)
    if rule is None:
        raise Unknown(f"the node '{node.name}' ({node.operation.lower()})")
    count = rule.__code__.co_argcount

    def whole(*parts):
        with numpy.errstate(all="ignore"):
            result = rule(*(_number(part) for part in parts))
        result = numpy.where(numpy.isfinite(result), result, 0.0)
        return numpy.repeat(numpy.clip(result, 0, 1) if node.use_clamp else result, 3, axis=-1)
    return _computed(whole, *(evaluate(At(node.inputs[number], groups)) for number in range(count)))


_MATH = {
    "ADD": lambda a, b: a + b, "SUBTRACT": lambda a, b: a - b, "MULTIPLY": lambda a, b: a * b, "DIVIDE": lambda a, b: a / b,
    "MULTIPLY_ADD": lambda a, b, c: a * b + c, "POWER": lambda a, b: a ** b, "MINIMUM": lambda a, b: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b: numpy.maximum(a, b), "LESS_THAN": lambda a, b: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b: (a > b) * 1.0, "ABSOLUTE": lambda a: numpy.abs(a), "SQRT": lambda a: numpy.sqrt(a),
    "FRACT": lambda a: a - numpy.floor(a), "FLOOR": lambda a: numpy.floor(a), "CEIL": lambda a: numpy.ceil(a),
    "ROUND": lambda a: numpy.floor(a + 0.5), "SIGN": lambda a: numpy.sign(a), "SINE": lambda a: numpy.sin(a),
    "COSINE": lambda a: numpy.cos(a), "RADIANS": lambda a: a * math.pi / 180, "DEGREES": lambda a: a * 180 / math.pi,
}


def _clamp(node, output, groups):
    if getattr(node, "clamp_type", "MINMAX") != "MINMAX":
        raise Unknown(f"the node '{node.name}'")
    return _computed(lambda value, least, most: numpy.minimum(numpy.maximum(_number(value), _number(least)), _number(most))
                     * numpy.ones(3), _in(node, groups, "Value"), _in(node, groups, "Min"), _in(node, groups, "Max"))


_RULES = {
    "MIX_RGB": _mix, "MIX": _mix, "HUE_SAT": _hue_saturation, "GAMMA": _gamma, "BRIGHTCONTRAST": _bright_contrast,
    "INVERT": _invert, "RGBTOBW": _grey, "SEPRGB": _separate, "SEPARATE_COLOR": _separate, "COMBRGB": _combine,
    "COMBINE_COLOR": _combine, "VALTORGB": _ramp, "BLACKBODY": _blackbody, "MATH": _math, "CLAMP": _clamp,
}
