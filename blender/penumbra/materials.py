"""What a material's nodes make of a surface that is diffuse, shines, and lets light through.

Knows nodes by their names and values alone, not bpy.
"""

from dataclasses import dataclass, field


@dataclass
class Look:
    """Light is reflected by `color` (diffuse), sent by `radiance`, and passes by 1 - `alpha`."""
    color: tuple = (0.8, 0.8, 0.8)
    radiance: tuple = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    image: object = None        # multiplies the colour
    image_alpha: bool = False   # and its alpha the alpha
    uv_map: str = ""            # by which the image lies on it; "": the active one
    nearest: bool = False
    wrap: str = "REPEAT"        # or EXTEND
    attribute: str = None       # a colour attribute that multiplies the colour; "": the active one


@dataclass
class _Shader:
    """A sum of diffuse reflection, emission and transparency, in linear colours."""
    diffuse: tuple = (0.0, 0.0, 0.0)
    emission: tuple = (0.0, 0.0, 0.0)
    through: float = 0.0
    pictured: list = field(default_factory=list)  # colour inputs behind `diffuse`
    cut: object = None          # an image node whose alpha lets the rest through


_GLOSSY = {"BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_TOON", "BSDF_VELVET", "BSDF_SHEEN", "SUBSURFACE_SCATTERING",
           "BSDF_HAIR", "BSDF_HAIR_PRINCIPLED", "EEVEE_SPECULAR"}
_CLEAR = {"BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSLUCENT"}


def _times(a, b):
    return tuple(x * y for x, y in zip(a, b))


def _mixed(a, b, share):
    return tuple(x + (y - x) * share for x, y in zip(a, b))


def _source(socket):
    """The node and socket that feed a socket, through reroutes; None where nothing does."""
    while socket.is_linked:
        link = socket.links[0]
        if link.from_node.type != "REROUTE":
            return link
        socket = link.from_node.inputs[0]
    return None


class Reader:
    """Reads one material. What is lost goes to `losses`, under `name`."""

    def __init__(self, losses, name):
        self.losses, self.name = losses, name

    def look(self, material):
        if material is None:
            return Look()
        if not material.use_nodes or material.node_tree is None:
            return Look(color=tuple(material.diffuse_color[:3]))
        output = material.node_tree.get_output_node("CYCLES")
        surface = _source(output.inputs["Surface"]) if output else None
        if output and output.inputs["Volume"].is_linked:
            self.losses.refuse("has a volume, which is not rendered", self.name)
        if output and output.inputs["Displacement"].is_linked:
            self.losses.mention("is not displaced by its material", self.name)
        shader = self._shader(surface.from_node) if surface else _Shader()
        return self._look_of(shader)

    def _look_of(self, shader):
        solid = 1 - shader.through
        look = Look(alpha=min(max(solid, 0.0), 1.0), radiance=shader.emission)
        if solid > 0:
            look.color = tuple(min(x / solid, 1.0) for x in shader.diffuse)
            look.radiance = tuple(x / solid for x in shader.emission)
        for link in shader.pictured:
            self._picture(link, look)
        if shader.cut is not None:
            if look.image is not None and look.image != shader.cut.image:
                self.losses.refuse("takes its colour and its alpha from different images", self.name)
            elif look.image is None:  # glTF multiplies the colour by the image, too
                self.losses.mention("is shown in its image's colour: its alpha alone was wanted", self.name)
            self._use_image(shader.cut, look)
            look.image_alpha = True
        return look

    def _use_image(self, node, look):
        look.image = node.image
        look.nearest = node.interpolation == "Closest"
        look.wrap = "EXTEND" if node.extension == "EXTEND" else "REPEAT"
        if node.extension == "CLIP" or node.projection != "FLAT":
            self.losses.refuse("has an image that neither repeats nor extends, or is not laid flat", self.name)
        place = _source(node.inputs["Vector"])
        if place is None:
            return
        if place.from_node.type == "UVMAP":
            look.uv_map = place.from_node.uv_map
        elif not (place.from_node.type == "TEX_COORD" and place.from_socket.name == "UV"):
            self.losses.refuse("has an image that lies on it by other nodes than UV maps", self.name)

    def _picture(self, link, look):
        node = link.from_node
        if node.type == "TEX_IMAGE" and node.image is not None and look.image in (None, node.image):
            self._use_image(node, look)
        elif node.type in ("VERTEX_COLOR", "ATTRIBUTE") and look.attribute is None:
            look.attribute = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
        else:
            self.losses.mention(f"is not coloured by its node '{node.name}'", self.name)

    def _color(self, socket, pictured):
        """A colour input: its factor; what feeds it is added to `pictured`."""
        link = _source(socket)
        if link is None:
            return tuple(socket.default_value[:3])
        node = link.from_node
        if node.type == "RGB":
            return tuple(node.outputs[0].default_value[:3])
        if node.type == "MIX_RGB" and node.blend_type == "MULTIPLY" and not node.inputs[0].is_linked and \
                node.inputs[0].default_value == 1:
            return _times(self._color(node.inputs[1], pictured), self._color(node.inputs[2], pictured))
        pictured.append(link)
        return (1.0, 1.0, 1.0)

    def _plain(self, socket, what):
        """A number or colour that must not be fed by nodes."""
        link = _source(socket)
        if link is not None:
            if link.from_node.type in ("RGB", "VALUE"):
                return link.from_node.outputs[0].default_value
            self.losses.refuse(f"has {what} made by nodes, which are not evaluated", self.name)
        return socket.default_value

    def _emission(self, color, strength):
        color = tuple(self._plain(color, "a light")[:3])
        return tuple(x * self._plain(strength, "a light") for x in color)

    def _shader(self, node):
        if node.type == "BSDF_PRINCIPLED":
            return self._principled(node)
        if node.type == "BSDF_DIFFUSE":
            shader = _Shader()
            shader.diffuse = self._color(node.inputs["Color"], shader.pictured)
            if node.inputs["Roughness"].default_value > 0:
                self.losses.mention("is a Lambert surface, however rough", self.name)
            return shader
        if node.type == "EMISSION":
            return _Shader(emission=self._emission(node.inputs["Color"], node.inputs["Strength"]))
        if node.type == "BSDF_TRANSPARENT":
            color = self._plain(node.inputs["Color"], "a transparency")
            if max(color[:3]) - min(color[:3]) > 1e-6:
                self.losses.refuse("colours the light that it lets through", self.name)
            return _Shader(through=color[1])
        if node.type == "ADD_SHADER":
            return self._sum([self._input(socket) for socket in node.inputs], [1.0, 1.0], None)
        if node.type == "MIX_SHADER":
            return self._mix(node)
        if node.type in _CLEAR:
            self.losses.refuse("lets light through by refraction or translucency", self.name)
        elif node.type in _GLOSSY:
            self.losses.mention("is diffuse: gloss and what is below a surface are not rendered", self.name)
        else:
            self.losses.refuse(f"has a node '{node.name}' that is not known", self.name)
        shader = _Shader()
        if "Color" in node.inputs:
            shader.diffuse = self._color(node.inputs["Color"], shader.pictured)
        return shader

    def _input(self, socket):
        link = _source(socket)
        return self._shader(link.from_node) if link else _Shader()

    def _sum(self, shaders, shares, cut):
        total = _Shader(cut=cut)
        for shader, share in zip(shaders, shares):
            total.diffuse = tuple(x + share * y for x, y in zip(total.diffuse, shader.diffuse))
            total.emission = tuple(x + share * y for x, y in zip(total.emission, shader.emission))
            total.through += share * shader.through
            total.pictured += shader.pictured if share else []
            total.cut = total.cut or shader.cut
        return total

    def _mix(self, node):
        first, second = (self._input(socket) for socket in list(node.inputs)[1:3])
        link = _source(node.inputs[0])
        if link is None:
            share = min(max(node.inputs[0].default_value, 0.0), 1.0)
            return self._sum([first, second], [1 - share, share], None)
        # The one graph that cuts holes: an image's alpha between nothing and a surface.
        if link.from_node.type == "TEX_IMAGE" and link.from_socket.name == "Alpha" and first.through == 1:
            return self._sum([second], [1.0], link.from_node)
        self.losses.refuse("mixes shaders by nodes, which are not evaluated", self.name)
        return self._sum([first, second], [0.5, 0.5], None)

    def _principled(self, node):
        inputs, shader = node.inputs, _Shader()
        color = self._color(inputs["Base Color"], shader.pictured)
        shader.emission = self._emission(inputs["Emission"], inputs["Emission Strength"])
        alpha, link = 1.0, _source(inputs["Alpha"])
        if link is None:
            alpha = min(max(inputs["Alpha"].default_value, 0.0), 1.0)
        elif link.from_node.type == "TEX_IMAGE" and link.from_socket.name == "Alpha":
            shader.cut = link.from_node
        else:
            alpha = min(max(self._plain(inputs["Alpha"], "an alpha"), 0.0), 1.0)
        if inputs["Transmission"].is_linked or inputs["Transmission"].default_value > 0:
            self.losses.refuse("lets light through (transmission)", self.name)
        if inputs["Metallic"].is_linked or inputs["Metallic"].default_value > 0:
            self.losses.mention("is metallic; every surface is diffuse here", self.name)
        if inputs["Subsurface"].is_linked or inputs["Subsurface"].default_value > 0:
            self.losses.mention("is diffuse: gloss and what is below a surface are not rendered", self.name)
        if inputs["Normal"].is_linked:
            self.losses.mention("has a normal or bump map, which is left out", self.name)
        shader.diffuse = tuple(alpha * x for x in color)
        shader.emission = tuple(alpha * x for x in shader.emission)
        shader.through = 1 - alpha
        return shader
