# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes to coefficients. Programs are run by a small interpreter here, after triptych.h's words."""

import bpy
import numpy as np
import pytest
import stage
from triptych import compat, data
from triptych.export_material import export_material
from triptych.export_texture import Textures

UV = np.array([0.25, 0.75, 0, 0])
IMAGE = np.array([0.5, 0.25, 0.125, 0.5])
PAINT = np.array([0.9, 0.8, 0.7, 0.6])


class Exported:
    def __init__(self, material):
        self.scene = data.Scene()
        self.material = export_material(material, Textures(self.scene), self.scene.warn)
        self.values = []
        for node in self.material.nodes:
            self.values.append(self.run(node))

    def run(self, node):
        a, b, c = (
            np.array(value) if index == data.NONE else self.values[index]
            for index, value in zip(node.inputs, node.values, strict=True)
        )
        assert all(index < len(self.values) for index in node.inputs)

        def turned():
            (su, sv, ou, ov), angle = node.values[0], node.values[1][0]
            x, y = a[0] * su, a[1] * sv
            return np.array(
                [x * np.cos(angle) - y * np.sin(angle) + ou, x * np.sin(angle) + y * np.cos(angle) + ov, 0, 0]
            )

        self.last_uv = a if node.type == "image" and node.inputs[0] != data.NONE else UV
        return {
            "constant": lambda: a,
            "uv": lambda: UV,
            "color": lambda: PAINT,
            "object_color": lambda: np.array([0.1, 0.2, 0.3, 1]),
            "image": lambda: IMAGE,
            "normal_map": lambda: a,
            "uv_transform": turned,
            "channel": lambda: np.array([a[int(node.values[0][0])]] * 3 + [1]),
            "add": lambda: a + b,
            "subtract": lambda: a - b,
            "multiply": lambda: a * b,
            "divide": lambda: np.divide(a, b, out=np.zeros(4), where=b != 0),
            "power": lambda: np.maximum(a, 0) ** b,
            "mix": lambda: a + (b - a) * c,
            "clamp": lambda: np.clip(a, 0, 1),
            "greater": lambda: (a > b).astype(float),
        }[node.type]()

    def __getattr__(self, name):
        """The coefficient `name`, as numbers."""
        coefficient = getattr(self.material, name)
        value = np.array(coefficient.value)
        if coefficient.node != data.NONE:
            value = value * self.values[coefficient.node][: len(value)]
        return value


def principled(**words):
    material, tree, node = stage.material(shader="ShaderNodeBsdfPrincipled")
    for word, value in words.items():
        socket = compat.principled_socket(node, word)
        socket.default_value = (*value, 1) if isinstance(value, tuple) else value
    return material, tree, node


def linked(tree, kind, target, output=0, **inputs):
    node = tree.nodes.new(kind)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[output], target)
    return node


def image_node(tree, target, output="Color"):
    node = linked(tree, "ShaderNodeTexImage", target, output)
    node.image = stage.picture("Image", np.zeros((2, 2, 4), np.float32))
    return node


def luminance(rgb):
    return float(np.dot(rgb[:3], [0.2126, 0.7152, 0.0722]))


def reflectance(ior=1.5, level=0.5):
    return ((ior - 1) / (ior + 1)) ** 2 * 2 * level if compat.principled_has_ior_level() else 0.08 * level


def test_diffuse(scene):
    result = Exported(stage.material(Color=(0.2, 0.4, 0.6))[0])
    assert result.diffuse == pytest.approx([0.2, 0.4, 0.6]) and result.material.nodes == []
    assert not result.specular.any() and not result.emission.any() and result.alpha == 1
    assert result.material.ambient is None and result.material.mirror is None and result.material.double_sided


def test_principled_constants(scene):
    result = Exported(
        principled(base=(0.8, 0.4, 0.2), metallic=0.25, roughness=0.5, ior=1.5, transmission=0.5, specular=0.4)[0]
    )
    base = np.array([0.8, 0.4, 0.2])
    assert result.diffuse == pytest.approx(base * 0.75 * 0.5)
    assert result.transmission == pytest.approx(base * 0.75 * 0.5)
    mirror = reflectance(1.5, 0.4) * 0.75 + base * 0.25
    assert result.mirror == pytest.approx(mirror)
    assert result.specular == pytest.approx(np.minimum(mirror * (7.5 + 2) / 2, 1))
    assert result.shininess == pytest.approx((2 / 0.5**4 - 2) / 4) and result.ior == pytest.approx(1.5)
    assert result.material.nodes == []


def test_principled_emission_and_alpha(scene):
    result = Exported(principled(emission=(1, 0.5, 0), emission_strength=3.0, alpha=0.25)[0])
    assert result.emission == pytest.approx([3, 1.5, 0]) and result.alpha == pytest.approx(0.25)


@pytest.mark.parametrize("roughness, shininess", [(0, 399.5), (1, 0)])
def test_roughness_ends(scene, roughness, shininess):
    assert Exported(principled(roughness=roughness)[0]).shininess == pytest.approx(shininess)


def test_principled_linked(scene):
    material, tree, node = principled(metallic=0.0, transmission=0.0)
    image_node(tree, node.inputs["Base Color"])
    node = compat.principled_socket(node, "roughness")
    linked(tree, "ShaderNodeValue", node).outputs[0].default_value = 0.5
    result = Exported(material)
    assert result.diffuse == pytest.approx(IMAGE[:3]) and result.shininess == pytest.approx(7.5)
    assert result.scene.textures[0].color_space == "srgb" and result.scene.warnings == []


def test_roughness_from_an_image(scene):
    material, tree, node = principled()
    image_node(tree, node.inputs["Roughness"])
    expected = (2 / luminance(IMAGE) ** 4 - 2) / 4
    assert Exported(material).shininess == pytest.approx(expected)


def test_metallic_and_transmission_from_images(scene):
    material, tree, node = principled(base=(0.8, 0.4, 0.2))
    image_node(tree, compat.principled_socket(node, "metallic"))
    image_node(tree, compat.principled_socket(node, "transmission"), "Alpha")
    result, metallic = Exported(material), luminance(IMAGE)
    base = np.array([0.8, 0.4, 0.2])
    assert result.diffuse == pytest.approx(base * (1 - metallic) * 0.5)
    assert result.transmission == pytest.approx(base * (1 - metallic) * 0.5)
    ior = compat.principled_socket(node, "ior").default_value
    assert result.mirror == pytest.approx(reflectance(ior) * (1 - metallic) + base * metallic)


def test_glossy_glass_and_transparent(scene):
    glossy = Exported(stage.material(shader="ShaderNodeBsdfGlossy", Color=(0.5, 0.6, 0.7), Roughness=0.2)[0])
    assert glossy.mirror == pytest.approx([0.5, 0.6, 0.7]) and not glossy.diffuse.any()
    assert glossy.shininess == pytest.approx((2 / 0.2**4 - 2) / 4, rel=1e-5)
    glass = Exported(stage.material(shader="ShaderNodeBsdfGlass", Color=(1.0, 1.0, 1.0), IOR=1.5)[0])
    assert glass.mirror == pytest.approx([1] * 3) and glass.transmission == pytest.approx([1] * 3)
    assert glass.material.fresnel, "which weighs both"
    assert glass.ior == pytest.approx(1.5) and not glass.material.thin
    clear = Exported(stage.material(shader="ShaderNodeBsdfTransparent", Color=(1.0, 1.0, 1.0))[0])
    assert clear.alpha == 0
    tinted = Exported(stage.material(shader="ShaderNodeBsdfTransparent", Color=(1.0, 0.5, 0.25))[0])
    assert tinted.transmission == pytest.approx([1, 0.5, 0.25]) and tinted.material.thin and tinted.alpha == 1


def blended(kind, *shaders, factor=0.25):
    """(material, tree, the mixing node) of two (shader, inputs)."""
    material, tree, first = stage.material(shader=shaders[0][0], **shaders[0][1])
    second = tree.nodes.new(shaders[1][0])
    for key, value in shaders[1][1].items():
        second.inputs[key].default_value = value
    mixer = tree.nodes.new(kind)
    places = [socket for socket in mixer.inputs if socket.type == "SHADER"]
    tree.links.new(first.outputs[0], places[0])
    tree.links.new(second.outputs[0], places[1])
    output = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial")
    tree.links.new(mixer.outputs[0], output.inputs["Surface"])
    if kind == "ShaderNodeMixShader":
        mixer.inputs[0].default_value = factor
    return material, tree, mixer


def test_mix_shader(scene):
    material, tree, mixer = blended(
        "ShaderNodeMixShader",
        ("ShaderNodeBsdfDiffuse", {"Color": (0.4, 0.4, 0.4)}),
        ("ShaderNodeEmission", {"Color": (1, 0.5, 0, 1), "Strength": 2}),
    )
    result = Exported(material)
    assert result.diffuse == pytest.approx([0.3] * 3) and result.emission == pytest.approx([0.5, 0.25, 0])
    image_node(tree, mixer.inputs[0], "Alpha")
    result = Exported(material)
    assert result.diffuse == pytest.approx([0.2] * 3) and result.emission == pytest.approx([1, 0.5, 0])


def test_mix_with_transparent_is_alpha(scene):
    material, tree, mixer = blended(
        "ShaderNodeMixShader",
        ("ShaderNodeBsdfTransparent", {}),
        ("ShaderNodeBsdfDiffuse", {"Color": (0.4, 0.4, 0.4, 1)}),
    )
    result = Exported(material)
    assert result.alpha == pytest.approx(0.25) and result.diffuse == pytest.approx([0.4] * 3)
    image_node(tree, mixer.inputs[0], "Alpha")
    result = Exported(material)
    assert result.alpha == pytest.approx(0.5) and result.diffuse == pytest.approx([0.4] * 3)


def test_mix_of_half_covering_surfaces(scene):
    """Coefficients of a surface count as much as it covers: alpha · K blends linearly."""
    material, tree, first = principled(base=(1.0, 0.0, 0.0), alpha=0.5, specular=0.0)
    second = tree.nodes.new("ShaderNodeBsdfDiffuse")
    second.inputs["Color"].default_value = (0, 1, 0, 1)
    mixer = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(first.outputs[0], mixer.inputs[1])
    tree.links.new(second.outputs[0], mixer.inputs[2])
    tree.links.new(mixer.outputs[0], tree.nodes[0].inputs["Surface"])
    result = Exported(material)
    assert result.alpha == pytest.approx(0.75)
    assert result.alpha * result.diffuse == pytest.approx([0.25, 0.5, 0])


def test_add_shader(scene):
    result = Exported(
        blended(
            "ShaderNodeAddShader",
            ("ShaderNodeBsdfDiffuse", {"Color": (0.4, 0.4, 0.4)}),
            ("ShaderNodeEmission", {"Color": (1, 0.5, 0, 1), "Strength": 2}),
        )[0]
    )
    assert result.diffuse == pytest.approx([0.4] * 3) and result.emission == pytest.approx([2, 1, 0])
    result = Exported(
        blended("ShaderNodeAddShader", ("ShaderNodeBsdfTransparent", {}), ("ShaderNodeEmission", {"Strength": 2}))[0]
    )
    assert result.transmission == pytest.approx([1] * 3) and result.material.thin and result.emission[0] == 2


# ---------------------------------------------------------------------------------------------------------- value nodes


def diffuse_of(build):
    """The exported material of a Diffuse BSDF whose colour is what build(tree, socket) links."""
    material, tree, node = stage.material()
    build(tree, node.inputs["Color"])
    return Exported(material)


@pytest.mark.parametrize(
    "operation, expected",
    [
        *(("ADD", 1.0), ("SUBTRACT", 0.5), ("MULTIPLY", 0.1875), ("DIVIDE", 3.0), ("POWER", 0.75**0.25)),
        *(("GREATER_THAN", 1), ("LESS_THAN", 0), ("MINIMUM", 0.25), ("MAXIMUM", 0.75), ("ABSOLUTE", 0.75)),
    ],
)
@pytest.mark.parametrize("constant", [True, False])
def test_math(scene, operation, expected, constant):
    def build(tree, target):
        node = linked(tree, "ShaderNodeMath", target)
        node.operation = operation
        node.inputs[0].default_value, node.inputs[1].default_value = 0.75, 0.25
        if not constant:
            uv = linked(tree, "ShaderNodeSeparateXYZ", node.inputs[0], "Y")
            linked(tree, "ShaderNodeUVMap", uv.inputs[0])

    result = diffuse_of(build)
    assert result.diffuse == pytest.approx([expected] * 3) and bool(result.material.nodes) != constant


@pytest.mark.parametrize("kind", ["ShaderNodeMix", "ShaderNodeMixRGB"])
@pytest.mark.parametrize("blend", ["MIX", "ADD", "MULTIPLY", "SUBTRACT", "SCREEN", "DARKEN", "LIGHTEN", "DIFFERENCE"])
def test_mix_color(scene, kind, blend):
    b = np.array([0.2, 0.4, 0.6])

    def build(tree, target):
        node = tree.nodes.new(kind)
        node.blend_type = blend
        if kind == "ShaderNodeMix":
            node.data_type = "RGBA"
        sockets = {socket.identifier: socket for socket in node.inputs}
        names = ("Factor_Float", "A_Color", "B_Color") if kind == "ShaderNodeMix" else ("Fac", "Color1", "Color2")
        sockets[names[0]].default_value = 0.5
        sockets[names[2]].default_value = (*b, 1)
        image_node(tree, sockets[names[1]])
        output = next(socket for socket in node.outputs if socket.identifier in {"Result_Color", "Color"})
        tree.links.new(output, target)

    a = IMAGE[:3]
    full = {
        "MIX": b,
        "ADD": a + b,
        "MULTIPLY": a * b,
        "SUBTRACT": a - b,
        "SCREEN": 1 - (1 - a) * (1 - b),
        "DARKEN": np.minimum(a, b),
        "LIGHTEN": np.maximum(a, b),
        "DIFFERENCE": np.abs(a - b),
    }[blend]
    assert diffuse_of(build).diffuse == pytest.approx((a + full) / 2)


def test_vertex_color_object_color_and_attribute(scene):
    def painted(tree, target):
        linked(tree, "ShaderNodeVertexColor", target).layer_name = "Paint"

    result = diffuse_of(painted)
    assert result.diffuse == pytest.approx(PAINT[:3]) and result.material.nodes[0].name == "Paint"
    result = diffuse_of(lambda tree, target: linked(tree, "ShaderNodeObjectInfo", target, "Color"))
    assert result.diffuse == pytest.approx([0.1, 0.2, 0.3])


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR"])
def test_mapping(scene, kind):
    location, angle, scale = (0.5, -0.25), 0.3, (2.0, 4.0)

    def build(tree, target):
        node = image_node(tree, target)
        mapping = linked(tree, "ShaderNodeMapping", node.inputs["Vector"])
        mapping.vector_type = kind
        if kind != "VECTOR":
            mapping.inputs["Location"].default_value = (*location, 0)
        mapping.inputs["Rotation"].default_value = (0, 0, angle)
        mapping.inputs["Scale"].default_value = (*scale, 1)
        linked(tree, "ShaderNodeTexCoord", mapping.inputs["Vector"], "UV")

    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    expected = {
        "POINT": turn @ (UV[:2] * scale) + location,
        "VECTOR": turn @ (UV[:2] * scale),
        "TEXTURE": (turn.T @ (UV[:2] - location)) / scale,
    }[kind]
    assert diffuse_of(build).last_uv[:2] == pytest.approx(expected)


def test_normal_map(scene):
    material, tree, node = stage.material()
    bump = linked(tree, "ShaderNodeNormalMap", node.inputs["Normal"], Strength=0.5)
    bump.uv_map = "Second"
    image_node(tree, bump.inputs["Color"]).image.colorspace_settings.name = "Non-Color"
    result = Exported(material)
    found = result.material.nodes[result.material.normal]
    assert (found.type, found.name, found.values[0][0]) == ("normal_map", "Second", 0.5)
    assert result.scene.textures[0].color_space == "linear"


def test_color_ramp(scene):
    def build(tree, target):
        node = linked(tree, "ShaderNodeValToRGB", target)
        node.color_ramp.elements[0].color = (1, 0, 0, 1)
        node.color_ramp.elements[1].color = (0, 0, 1, 1)
        node.color_ramp.elements.new(0.5).color = (0, 1, 0, 1)
        uv = linked(tree, "ShaderNodeSeparateXYZ", node.inputs["Fac"], "X")
        linked(tree, "ShaderNodeUVMap", uv.inputs[0])

    assert diffuse_of(build).diffuse == pytest.approx([0.5, 0.5, 0], abs=1e-6)


def test_group_reroute_and_mute(scene):
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    if compat.VERSION >= (4, 0):
        group.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
        group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        group.inputs.new("NodeSocketColor", "In")
        group.outputs.new("NodeSocketColor", "Out")
    start, end, invert = (group.nodes.new(k) for k in ("NodeGroupInput", "NodeGroupOutput", "ShaderNodeInvert"))
    muted = group.nodes.new("ShaderNodeGamma")
    muted.mute, muted.inputs["Gamma"].default_value = True, 5
    group.links.new(start.outputs[0], invert.inputs["Color"])
    group.links.new(invert.outputs[0], muted.inputs["Color"])
    group.links.new(muted.outputs[0], end.inputs[0])

    def build(tree, target):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        reroute = tree.nodes.new("NodeReroute")
        tree.links.new(node.outputs[0], reroute.inputs[0])
        tree.links.new(reroute.outputs[0], target)
        image_node(tree, node.inputs[0])

    assert diffuse_of(build).diffuse == pytest.approx(1 - IMAGE[:3])


def test_unknown_node_is_named(scene):
    def build(tree, target):
        target.default_value = (0.1, 0.2, 0.3, 1)
        linked(tree, "ShaderNodeTexNoise", target, "Color")

    result = diffuse_of(build)
    assert result.diffuse == pytest.approx([0.1, 0.2, 0.3])
    assert len(result.scene.warnings) == 1
    for word in ("Material", "Noise Texture", "Color"):
        assert word in result.scene.warnings[0]


def test_no_output_is_black(scene):
    material, tree, node = stage.material()
    tree.nodes.remove(tree.nodes[0])
    assert not Exported(material).diffuse.any()


def test_override(scene):
    material, _, _ = stage.material(Color=(1.0, 1.0, 1.0))
    chosen = material.triptych
    chosen.override = True
    chosen.diffuse, chosen.specular, chosen.shininess, chosen.ior, chosen.thin = (
        (0.1, 0.2, 0.3),
        (1, 1, 1),
        77,
        1.2,
        True,
    )
    result = Exported(material)
    assert result.diffuse == pytest.approx([0.1, 0.2, 0.3]) and result.shininess == pytest.approx(77)
    assert result.material.mirror is None and result.material.ambient is None and result.material.thin
    chosen.use_mirror, chosen.mirror, chosen.use_ambient, chosen.ambient = True, (0, 0, 0.5), True, (0.5, 0, 0)
    result = Exported(material)
    assert result.mirror == pytest.approx([0, 0, 0.5]) and result.ambient == pytest.approx([0.5, 0, 0])
