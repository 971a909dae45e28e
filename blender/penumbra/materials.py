# SPDX-License-Identifier: Apache-2.0
"""Converts a material's nodes to a surface that reflects diffusely, emits, and transmits light.

Uses only names and values of nodes, not bpy.
"""

from dataclasses import dataclass, field
from math import cos, sin

from . import graph
from .graph import At, Unknown, find_socket


@dataclass
class Look:
    """A surface: `color` is its diffuse reflectance, `radiance` its emission, 1 - `alpha` the share of light that passes."""
    color: tuple = (0.8, 0.8, 0.8)
    radiance: tuple = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    image: object = None        # its colour multiplies `color`
    image_alpha: bool = False   # whether its alpha multiplies `alpha`
    pixels: object = None       # linear texels computed by nodes, in place of the image's
    uv_map: str = ""            # UV map of the image; "": the active one
    placing: tuple = None       # transform of the UV map: two rows of three numbers; None: identity
    interpolation: str = "Linear"
    wrap: str = "REPEAT"        # or EXTEND
    attribute: str = None       # a colour attribute that multiplies the colour; "": the active one

    @property
    def nearest(self):
        return self.interpolation == "Closest"


@dataclass
class _Shader:
    """A sum of diffuse reflection, emission and transparency, in linear colours."""
    diffuse: tuple = (0.0, 0.0, 0.0)
    emission: tuple = (0.0, 0.0, 0.0)
    through: float = 0.0
    pictured: list = field(default_factory=list)  # Values of `diffuse`, with their factors
    cut: object = None          # an image (graph.ImageUse) whose alpha makes the rest transparent


_GLOSSY = {"BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_TOON", "BSDF_VELVET", "BSDF_SHEEN", "SUBSURFACE_SCATTERING",
           "BSDF_HAIR", "BSDF_HAIR_PRINCIPLED", "BSDF_METALLIC", "EEVEE_SPECULAR"}
_CLEAR = {"BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSLUCENT"}
_GREY = (0.8, 0.8, 0.8)  # in place of an unknown colour, if left out


def may_shine(material):
    """Returns whether the material has a node that emits light. Called before a render, to name the passes."""
    if not material.use_nodes or material.node_tree is None:
        return False
    for node in material.node_tree.nodes:
        if node.type == "EMISSION":
            return True
        if node.type == "BSDF_PRINCIPLED":
            color, strength = find_socket(node.inputs, "Emission Color", "Emission"), find_socket(node.inputs, "Emission Strength")
            if color is not None and (color.is_linked or max(color.default_value[:3]) > 0) and \
                    (strength is None or strength.is_linked or strength.default_value > 0):
                return True
    return False


class Reader:
    """Reads one material. Adds unsupported parts to `losses`, under `name`."""

    def __init__(self, losses, name):
        self.losses, self.name = losses, name

    def look(self, material):
        if material is None:
            return Look()
        if not material.use_nodes or material.node_tree is None:
            return Look(color=tuple(material.diffuse_color[:3]))
        output = material.node_tree.get_output_node("CYCLES")
        if output and output.inputs["Volume"].is_linked:
            self.losses.refuse("has a volume, which is not rendered; take it off the material's output", self.name)
        if output and output.inputs["Displacement"].is_linked:
            self.losses.mention("is not displaced by its material", self.name)
        return self._look_of(self._input(At(output.inputs["Surface"])) if output else _Shader())

    def _look_of(self, shader):
        solid = 1 - shader.through
        look = Look(alpha=min(max(solid, 0.0), 1.0), radiance=shader.emission)
        if solid > 0:
            look.color = tuple(x / solid for x in shader.diffuse)
            look.radiance = tuple(x / solid for x in shader.emission)
        for value in shader.pictured:
            self._picture(value, look)
        if shader.cut is not None:
            self._cut(shader.cut, look)
        return look

    def _picture(self, value, look):
        """Reads a colour's image and attribute into `look`."""
        if value.attribute is not None:
            if look.attribute not in (None, value.attribute):
                self.losses.refuse("mixes several colour attributes", self.name)
            look.attribute = value.attribute
        if value.image is None:
            return
        if value.image.node.type == "TEX_ENVIRONMENT":
            self.losses.refuse(f"has a colour made by the node '{value.image.node.name}', which is for worlds", self.name)
            return
        if look.image is not None and not (look.image is value.image.node.image and look.pixels is value.pixels):
            self.losses.refuse("mixes surfaces of several images", self.name)
            return
        self._use_image(value.image, look)
        look.pixels = value.pixels

    def _cut(self, use, look):
        if look.image is not None and look.image != use.node.image:
            self.losses.refuse("takes its colour and its alpha from different images", self.name)
        elif look.pixels is not None:
            self.losses.refuse("has an image whose alpha cuts holes and whose colours are changed by nodes", self.name)
        elif look.image is None:  # glTF multiplies the colour by the image, too
            self.losses.mention("is shown in its image's colour: only its alpha was requested", self.name)
        self._use_image(use, look)
        look.image_alpha, look.pixels = True, None
        if not look.nearest:
            self.losses.mention("has an image whose alpha is not interpolated: its nearest texel decides", self.name)

    def _use_image(self, use, look):
        node = use.node
        look.image, look.interpolation = node.image, node.interpolation
        look.wrap = "EXTEND" if node.extension == "EXTEND" else "REPEAT"
        if node.extension not in ("EXTEND", "REPEAT") or node.projection != "FLAT":
            self.losses.refuse("has an image that neither repeats nor extends, or is not laid flat", self.name)
        if graph.is_moved(getattr(node, "texture_mapping", None)):
            self.losses.refuse("has an image that is placed by its node's own texture mapping", self.name)
        try:
            self._place(At(find_socket(node.inputs, "Vector"), use.groups), look)
        except Unknown as error:
            self.losses.refuse(f"has an image that is placed by {error}", self.name)

    def _place(self, at, look):
        source = at.source()
        if source is None:
            return
        node, output, groups = source
        if node.type == "UVMAP":
            look.uv_map = node.uv_map
        elif node.type == "MAPPING":
            look.placing = _placing(node, groups)
            self._place(At(find_socket(node.inputs, "Vector"), groups), look)
        elif not (node.type == "TEX_COORD" and output.name == "UV"):
            raise Unknown(f"the node '{node.name}' and not by UV maps")

    def _color(self, at, pictured):
        """Returns a colour input's factor; adds its image and attribute to `pictured`."""
        try:
            value = graph.evaluate(at)
        except Unknown as error:
            self.losses.refuse(f"has a colour made by {error}, which is not evaluated; bake it into an image (Cycles, Bake, Diffuse, only Color) and use that (left out, it is grey)", self.name)
            return _GREY
        except OSError as error:
            self.losses.refuse(f"has an image that cannot be read ({error})", self.name)
            return _GREY
        if not value.is_constant:
            pictured.append(value)
        if min(value.factor) < 0:
            self.losses.refuse("has a colour below 0", self.name)
        return tuple(max(float(x), 0.0) for x in value.factor)

    def _plain(self, at, what):
        """Returns a colour (or a number, three times) that must be the same everywhere."""
        try:
            return graph.constant(at)
        except Unknown as error:
            self.losses.refuse(f"has {what} made by {error}, which is not evaluated", self.name)
            value = at.socket.default_value
            return tuple(value[:3]) if hasattr(value, "__len__") else (value,) * 3

    def _number(self, at, what):
        red, green, blue = self._plain(at, what)
        return red if red == green == blue else 0.2126 * red + 0.7152 * green + 0.0722 * blue

    def _emission(self, color, strength):
        strength = self._number(strength, "a light")
        return tuple(x * strength for x in self._plain(color, "a light")) if strength else (0.0, 0.0, 0.0)

    def _input(self, at):
        """Returns the shader that feeds a socket."""
        try:
            source = at.source()
        except Unknown as error:
            self.losses.refuse(f"has {error}, which is not known", self.name)
            return _Shader()
        return self._shader(source[0], source[2]) if source else _Shader()

    def _shader(self, node, groups):
        def at(*names):
            return At(find_socket(node.inputs, *names), groups)
        normal = find_socket(node.inputs, "Normal")
        if normal is not None and normal.is_linked:
            self.losses.mention("has a normal or bump map, which is left out", self.name)
        if node.type == "BSDF_PRINCIPLED":
            return self._principled(node, at)
        if node.type == "BSDF_DIFFUSE":
            shader = _Shader()
            shader.diffuse = self._color(at("Color"), shader.pictured)
            roughness = find_socket(node.inputs, "Roughness")
            if roughness.is_linked or roughness.default_value > 0:
                self.losses.mention("is a Lambert surface, however rough", self.name)
            return shader
        if node.type == "EMISSION":
            return _Shader(emission=self._emission(at("Color"), at("Strength")))
        if node.type == "BSDF_TRANSPARENT":
            color = self._plain(at("Color"), "a transparency")
            if max(color) - min(color) > 1e-6:
                self.losses.refuse("colours the light that it lets through", self.name)
            return _Shader(through=color[1])
        if node.type == "ADD_SHADER":
            return self._sum([self._input(At(socket, groups)) for socket in node.inputs], [1.0, 1.0], None)
        if node.type == "MIX_SHADER":
            return self._mix(node, groups)
        if node.type == "HOLDOUT":
            self.losses.refuse("is a holdout", self.name)
            return _Shader()
        if node.type in _CLEAR:
            self.losses.refuse("lets light through by refraction or translucency", self.name)
        elif node.type in _GLOSSY:
            self.losses.mention("is diffuse: gloss and what is below a surface are not rendered", self.name)
        else:
            self.losses.refuse(f"has a node '{node.name}' that is not known", self.name)
        shader = _Shader()
        color = find_socket(node.inputs, "Color", "Base Color")
        if color is not None:
            shader.diffuse = self._color(At(color, groups), shader.pictured)
        return shader

    def _sum(self, shaders, shares, cut):
        total = _Shader(cut=cut)
        pictured = [shader for shader, share in zip(shaders, shares) if share and shader.pictured]
        plain = [shader for shader, share in zip(shaders, shares) if share and not shader.pictured and max(shader.diffuse) > 0]
        if pictured and (plain or len(pictured) > 1):
            self.losses.refuse("mixes a surface of an image or a colour attribute with another", self.name)
        for shader, share in zip(shaders, shares):
            total.diffuse = tuple(x + share * y for x, y in zip(total.diffuse, shader.diffuse))
            total.emission = tuple(x + share * y for x, y in zip(total.emission, shader.emission))
            total.through += share * shader.through
            total.pictured += shader.pictured if share else []
            total.cut = total.cut or shader.cut
        return total

    def _mix(self, node, groups):
        first, second = (self._input(At(socket, groups)) for socket in list(node.inputs)[1:3])
        share = At(node.inputs[0], groups)
        try:
            source = share.source()
            # The only supported graph that cuts holes: an image's alpha between transparent and a surface.
            if source and source[0].type == "TEX_IMAGE" and source[1].name == "Alpha" and first.through == 1:
                return self._sum([second], [1.0], graph.ImageUse(source[0], source[2]))
            share = min(max(graph.constant(share)[0], 0.0), 1.0)
        except Unknown as error:
            self.losses.refuse(f"mixes shaders by {error}, which is not evaluated", self.name)
            share = 0.5
        return self._sum([first, second], [1 - share, share], None)

    def _principled(self, node, at):
        shader = _Shader()
        color = self._color(at("Base Color"), shader.pictured)
        shader.emission = self._emission(at("Emission Color", "Emission"), at("Emission Strength"))
        alpha, source = 1.0, at("Alpha").source()
        if source and source[0].type == "TEX_IMAGE" and source[1].name == "Alpha":
            shader.cut = graph.ImageUse(source[0], source[2])
        else:
            alpha = min(max(self._number(at("Alpha"), "an alpha"), 0.0), 1.0)

        def used(*names):
            socket = find_socket(node.inputs, *names)
            return socket is not None and (socket.is_linked or socket.default_value > 0)
        if used("Transmission Weight", "Transmission"):
            self.losses.refuse("lets light through (transmission)", self.name)
        if used("Metallic"):
            self.losses.mention("is metallic; every surface is diffuse here", self.name)
        if any(used(*names) for names in (("Subsurface Weight", "Subsurface"), ("Specular IOR Level", "Specular"),
                                          ("Coat Weight", "Clearcoat"), ("Sheen Weight", "Sheen"))):
            self.losses.mention("is diffuse: gloss and what is below a surface are not rendered", self.name)
        elif find_socket(node.inputs, "Specular") is not None or used("Diffuse Roughness"):
            # Before Blender 4 the diffuse part is Burley's, brighter or darker at grazing angles by the roughness.
            self.losses.mention("is a Lambert surface, however rough", self.name)
        shader.diffuse = tuple(alpha * x for x in color)
        shader.emission = tuple(alpha * x for x in shader.emission)
        shader.through = 1 - alpha
        return shader


def _placing(node, groups):
    """Returns a mapping node's transform of (u, v), as two rows of three numbers."""
    def numbers(name):
        socket = find_socket(node.inputs, name)
        return graph.constant(At(socket, groups)) if socket is not None else (0.0, 0.0, 0.0)
    place, turn, scale = numbers("Location"), numbers("Rotation"), numbers("Scale")
    if turn[0] or turn[1] or node.vector_type not in ("POINT", "TEXTURE", "VECTOR"):
        raise Unknown(f"the node '{node.name}', which rotates it out of its plane")
    c, s = cos(turn[2]), sin(turn[2])
    if node.vector_type == "TEXTURE":  # inverse translation, rotation and scale
        x, y = (1 / one if one else 0.0 for one in scale[:2])
        rows = ((x * c, x * s), (-y * s, y * c))
        return tuple((a, b, -(a * place[0] + b * place[1])) for a, b in rows)
    if node.vector_type == "VECTOR":
        place = (0.0, 0.0, 0.0)
    return ((c * scale[0], -s * scale[1], place[0]), (s * scale[0], c * scale[1], place[1]))
