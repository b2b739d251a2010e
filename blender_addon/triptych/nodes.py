# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's node trees: follows links through groups, reroutes and muted nodes; value nodes become a Program.

A node that has no counterpart is named in a warning, and the socket that reads it falls back to its own default value.
"""

from . import program
from .program import ONE, ZERO, Value, color, scalar


class Unsupported(Exception):
    """A node, or a setting of it, without a counterpart; the message says which setting."""


def input_of(node, *identifiers):
    """The first input socket with one of these identifiers, or None."""
    for identifier in identifiers:
        for socket in node.inputs:
            if socket.identifier == identifier:
                return socket
    return None


def output_node(tree):
    """The output node of a material's, world's or light's tree that renders, or None."""
    for target in ("ALL", "CYCLES", "EEVEE"):
        node = tree.get_output_node(target)
        if node is not None:
            return node
    return None


class TreeReader:
    """Values of sockets in one tree. `stack` is the tuple of group nodes that a place in the tree is inside of."""

    def __init__(self, owner, textures, warn):
        """owner: "material 'Name'", for warnings. textures: an export_texture.Textures. warn: takes a line."""
        self.owner = owner
        self.textures = textures
        self._warn = warn
        self.program = program.Program()
        self._values = {}

    def warn(self, text):
        self._warn(f"{self.owner}: {text}")

    def warn_node(self, node, why):
        kind = node.bl_label or node.bl_idname
        name = f"node '{node.name}'" if node.name == kind else f"node '{node.name}' ({kind})"
        self.warn(f"{name} {why}")

    # ---------------------------------------------------------------------------------------------------------- links

    def source(self, socket, stack):
        """Where a socket's value comes from: (node, output socket, stack), or (None, unlinked socket, stack)."""
        while True:
            link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
            if link is None:
                return None, socket, stack
            node, output = link.from_node, link.from_socket
            if node.mute:
                inner = next((way.from_socket for way in node.internal_links if way.to_socket == output), None)
                if inner is None:
                    return None, socket, stack
                socket = inner
            elif node.bl_idname == "NodeReroute":
                socket = node.inputs[0]
            elif node.bl_idname == "ShaderNodeGroup":
                inner = self._group_output(node, output)
                if inner is None:
                    return None, socket, stack
                socket, stack = inner, stack + (node,)
            elif node.bl_idname == "NodeGroupInput":
                if not stack:
                    return None, socket, stack
                socket, stack = input_of(stack[-1], output.identifier), stack[:-1]
            else:
                return node, output, stack

    @staticmethod
    def _group_output(group, output):
        if group.node_tree is None:
            return None
        ends = [node for node in group.node_tree.nodes if node.bl_idname == "NodeGroupOutput"]
        ends.sort(key=lambda node: not node.is_active_output)
        return input_of(ends[0], output.identifier) if ends else None

    # --------------------------------------------------------------------------------------------------------- values

    def value(self, socket, stack=()):
        """The Value of an input socket, turned into the socket's type."""
        node, source, at = self.source(socket, stack)
        if node is None:
            return self.default(source, socket.type)
        key = (node.as_pointer(), source.identifier, tuple(group.as_pointer() for group in at))
        if key not in self._values:
            handler = HANDLERS.get(node.bl_idname)
            try:
                if handler is None:
                    raise Unsupported("is not supported")
                self._values[key] = handler(self, node, source, at)
            except Unsupported as error:
                self.warn_node(node, f"{error}; the default of '{socket.name}' is used")
                self._values[key] = None
        value = self._values[key]
        if value is None:
            return self.default(socket, socket.type)
        return self.convert(value, source.type, socket.type)

    def default(self, socket, target):
        """The default value of a socket as the type of another."""
        number = getattr(socket, "default_value", None)
        if socket.type in {"RGBA", "VECTOR"}:
            return self.convert(color(number), socket.type, target)
        return scalar(number) if isinstance(number, (bool, int, float)) else ZERO

    def convert(self, value, source, target):
        if target in {"VALUE", "INT", "BOOLEAN"}:
            if source == "RGBA":
                return self.program.luminance(value)
            if source == "VECTOR":
                return self.program.average(value)
        return value

    def constant(self, socket, stack=()):
        """The four numbers of a socket that does not vary; Unsupported where it does."""
        value = self.value(socket, stack)
        if not value.is_constant:
            raise Unsupported(f"has a varying '{socket.name}', which is not supported")
        return value.constant

    def normal(self, socket, stack=()):
        """The Value of a linked Normal socket (a world-space normal), or None for the surface's own."""
        if socket is None:
            return None
        node, source, at = self.source(socket, stack)
        if node is None:
            return None
        try:
            if node.bl_idname != "ShaderNodeNormalMap":
                raise Unsupported("is not supported as a normal")
            if node.space != "TANGENT":
                raise Unsupported(f"has the space {node.space}, and only TANGENT is supported")
            strength = self.constant(node.inputs["Strength"], at)[0]
        except Unsupported as error:
            self.warn_node(node, f"{error}; the surface's own normal is used")
            return None
        picture = self.value(node.inputs["Color"], at)
        if picture.is_constant:
            return None
        return self.program.emit("normal_map", (picture,), ((strength,), (), ()), name=node.uv_map)


# ----------------------------------------------------------------------------------------------- one function to a node
# Each takes (reader, node, output socket, stack) and gives the Value of that output.


def _rgb(reader, node, output, stack):
    return color(output.default_value)


def _number(reader, node, output, stack):
    return scalar(output.default_value)


def _texture_coordinate(reader, node, output, stack):
    if output.identifier != "UV":
        raise Unsupported(f"gives '{output.name}', and only UV is supported")
    return reader.program.emit("uv")


def _uv_map(reader, node, output, stack):
    return reader.program.emit("uv", name=node.uv_map)


def _vertex_color(reader, node, output, stack):
    value = reader.program.emit("color", name=node.layer_name)
    return reader.program.channel(value, 3) if output.identifier == "Alpha" else value


def _attribute(reader, node, output, stack):
    if node.attribute_type != "GEOMETRY":
        raise Unsupported(f"reads {node.attribute_type} attributes, and only GEOMETRY is supported")
    if output.identifier == "Vector":
        return reader.program.emit("uv", name=node.attribute_name)
    value = reader.program.emit("color", name=node.attribute_name)
    if output.identifier == "Alpha":
        return reader.program.channel(value, 3)
    return reader.program.average(value) if output.identifier == "Fac" else value


def _object_info(reader, node, output, stack):
    if output.identifier != "Color":
        raise Unsupported(f"gives '{output.name}', and only Color is supported")
    return reader.program.emit("object_color")


def _image(reader, node, output, stack):
    if node.image is None:
        return color((0, 0, 0, 1)) if output.identifier == "Color" else ONE
    if node.projection != "FLAT":
        reader.warn_node(node, f"has the projection {node.projection}; FLAT is used")
    wrap = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}[node.extension]
    filtering = "nearest" if node.interpolation == "Closest" else "smooth"
    texture = reader.textures.add(node.image, node.image_user, (wrap, wrap), filtering)
    inputs = ()
    if reader.source(node.inputs["Vector"], stack)[0] is not None:
        inputs = (_as_node(reader, reader.value(node.inputs["Vector"], stack)),)
    value = reader.program.emit("image", inputs, texture=texture)
    if output.identifier == "Alpha":
        return ONE if node.image.alpha_mode == "NONE" else reader.program.channel(value, 3)
    return value


def _as_node(reader, value):
    """The same value as a node, for an input whose absence has a meaning of its own."""
    if value.is_constant:
        return reader.program.emit("constant", parameters=(value.constant, (), ()))
    return value


def _mapping(reader, node, output, stack):
    kind = node.vector_type
    if kind == "NORMAL":
        raise Unsupported("has the type NORMAL, which is not supported")
    vector = reader.value(node.inputs["Vector"], stack)
    rotation = reader.constant(node.inputs["Rotation"], stack)
    scale = reader.constant(node.inputs["Scale"], stack)
    location = (0, 0, 0) if kind == "VECTOR" else reader.constant(node.inputs["Location"], stack)
    if rotation[0] or rotation[1]:
        reader.warn_node(node, "turns about X or Y; only the rotation about Z is used")
    vector = _as_node(reader, vector)
    transform = reader.program.emit
    if kind != "TEXTURE":
        return transform("uv_transform", (vector,), ((*scale[:2], *location[:2]), (rotation[2],), ()))
    # The inverse: moved back, then turned back, then divided by the scale.
    vector = transform("uv_transform", (vector,), ((1, 1, -location[0], -location[1]), (), ()))
    vector = transform("uv_transform", (vector,), ((1, 1, 0, 0), (-rotation[2],), ()))
    inverse = [1 / number if number else 0.0 for number in scale[:2]]
    return transform("uv_transform", (vector,), ((*inverse, 0, 0), (), ()))


def _math(reader, node, output, stack):
    a, b, c = (reader.value(socket, stack) for socket in node.inputs)
    p = reader.program
    operations = {
        "ADD": lambda: p.add(a, b),
        "SUBTRACT": lambda: p.subtract(a, b),
        "MULTIPLY": lambda: p.multiply(a, b),
        "DIVIDE": lambda: p.divide(a, b),
        "MULTIPLY_ADD": lambda: p.add(p.multiply(a, b), c),
        "POWER": lambda: p.power(a, b),
        "SQRT": lambda: p.power(a, scalar(0.5)),
        "GREATER_THAN": lambda: p.greater(a, b),
        "LESS_THAN": lambda: p.greater(b, a),
        "MINIMUM": lambda: p.minimum(a, b),
        "MAXIMUM": lambda: p.maximum(a, b),
        "ABSOLUTE": lambda: p.maximum(a, p.subtract(ZERO, a)),
    }
    if node.operation not in operations:
        raise Unsupported(f"does {node.operation}, which is not supported")
    result = operations[node.operation]()
    return p.clamp(result) if node.use_clamp else result


def _vector_math(reader, node, output, stack):
    a, b = (reader.value(socket, stack) for socket in list(node.inputs)[:2])
    p = reader.program
    operations = {
        "ADD": lambda: p.add(a, b),
        "SUBTRACT": lambda: p.subtract(a, b),
        "MULTIPLY": lambda: p.multiply(a, b),
        "DIVIDE": lambda: p.divide(a, b),
        "SCALE": lambda: p.multiply(a, reader.value(node.inputs["Scale"], stack)),
        "MINIMUM": lambda: p.minimum(a, b),
        "MAXIMUM": lambda: p.maximum(a, b),
    }
    if node.operation not in operations:
        raise Unsupported(f"does {node.operation}, which is not supported")
    return operations[node.operation]()


def _blend(p, kind, a, b, factor):
    operations = {
        "MIX": lambda: b,
        "ADD": lambda: p.add(a, b),
        "SUBTRACT": lambda: p.subtract(a, b),
        "MULTIPLY": lambda: p.multiply(a, b),
        "DIVIDE": lambda: p.divide(a, b),
        "SCREEN": lambda: p.one_minus(p.multiply(p.one_minus(a), p.one_minus(b))),
        "DIFFERENCE": lambda: p.subtract(p.maximum(a, b), p.minimum(a, b)),
        "DARKEN": lambda: p.minimum(a, b),
        "LIGHTEN": lambda: p.maximum(a, b),
    }
    if kind not in operations:
        raise Unsupported(f"blends by {kind}, which is not supported")
    return p.mix(a, operations[kind](), factor)


def _mix_rgb(reader, node, output, stack):
    a, b = (reader.value(node.inputs[name], stack) for name in ("Color1", "Color2"))
    factor = reader.program.clamp(reader.value(node.inputs["Fac"], stack))
    result = _blend(reader.program, node.blend_type, a, b, factor)
    return reader.program.clamp(result) if node.use_clamp else result


def _mix(reader, node, output, stack):
    suffix = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
    if suffix is None:
        raise Unsupported(f"mixes {node.data_type}, which is not supported")
    a, b = (reader.value(input_of(node, f"{side}_{suffix}"), stack) for side in "AB")
    uniform = suffix != "Vector" or node.factor_mode == "UNIFORM"
    factor = reader.value(input_of(node, "Factor_Float" if uniform else "Factor_Vector"), stack)
    if node.clamp_factor:
        factor = reader.program.clamp(factor)
    if suffix != "Color":
        return reader.program.mix(a, b, factor)
    result = _blend(reader.program, node.blend_type, a, b, factor)
    return reader.program.clamp(result) if node.clamp_result else result


def _invert(reader, node, output, stack):
    value = reader.value(node.inputs["Color"], stack)
    return reader.program.mix(value, reader.program.one_minus(value), reader.value(node.inputs["Fac"], stack))


def _gamma(reader, node, output, stack):
    return reader.program.power(reader.value(node.inputs["Color"], stack), reader.value(node.inputs["Gamma"], stack))


def _separate(reader, node, output, stack):
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unsupported(f"separates {node.mode}, and only RGB is supported")
    index = [socket.identifier for socket in node.outputs].index(output.identifier)
    return reader.program.channel(reader.value(node.inputs[0], stack), index)


def _combine(reader, node, output, stack):
    if getattr(node, "mode", "RGB") != "RGB":
        raise Unsupported(f"combines {node.mode}, and only RGB is supported")
    return reader.program.combine(*(reader.value(socket, stack) for socket in list(node.inputs)[:3]))


def _color_ramp(reader, node, output, stack):
    ramp = node.color_ramp
    position = reader.value(node.inputs["Fac"], stack)
    if position.is_constant:
        result = color(ramp.evaluate(position.constant[0]))
    elif ramp.color_mode == "RGB" and ramp.interpolation in {"LINEAR", "CONSTANT"}:
        result = _ramp(reader.program, ramp, position)
    else:
        raise Unsupported(f"interpolates by {ramp.color_mode} {ramp.interpolation}, which is not supported")
    return reader.program.channel(result, 3) if output.identifier == "Alpha" else result


def _ramp(p, ramp, position):
    """Each stop moves the colour on from that of the stop before it."""
    stops = sorted(ramp.elements, key=lambda stop: stop.position)
    result = color(stops[0].color)
    for before, stop in zip(stops, stops[1:], strict=False):
        width = stop.position - before.position
        if ramp.interpolation == "CONSTANT" or width <= 0:
            factor = p.greater(position, scalar(stop.position))
        else:
            factor = p.clamp(p.multiply(p.subtract(position, scalar(before.position)), scalar(1 / width)))
        result = p.mix(result, color(stop.color), factor)
    return result


HANDLERS = {
    "ShaderNodeRGB": _rgb,
    "ShaderNodeValue": _number,
    "ShaderNodeTexCoord": _texture_coordinate,
    "ShaderNodeUVMap": _uv_map,
    "ShaderNodeVertexColor": _vertex_color,
    "ShaderNodeAttribute": _attribute,
    "ShaderNodeObjectInfo": _object_info,
    "ShaderNodeTexImage": _image,
    "ShaderNodeMapping": _mapping,
    "ShaderNodeMath": _math,
    "ShaderNodeVectorMath": _vector_math,
    "ShaderNodeMixRGB": _mix_rgb,
    "ShaderNodeMix": _mix,
    "ShaderNodeInvert": _invert,
    "ShaderNodeGamma": _gamma,
    "ShaderNodeSeparateColor": _separate,
    "ShaderNodeSeparateRGB": _separate,
    "ShaderNodeSeparateXYZ": _separate,
    "ShaderNodeCombineColor": _combine,
    "ShaderNodeCombineRGB": _combine,
    "ShaderNodeCombineXYZ": _combine,
    "ShaderNodeValToRGB": _color_ramp,
}
__all__ = ["TreeReader", "Unsupported", "Value", "input_of", "output_node"]
