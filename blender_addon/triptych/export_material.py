# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's materials to data.Material: shader nodes become the coefficients of the equation.

Each shader gives a Surface, a set of coefficients; Mix and Add Shader blend them number by number. Principled BSDF
(base colour b, metallic m, roughness r, transmission t, reflectance at normal incidence f0):

    K_D = b (1 − m)(1 − t)      mirror = mix(f0 · tint, b, m)      K_S = mirror · (n + 2)/2      K_T = b (1 − m) t

Roughness becomes Phong's exponent: a microfacet lobe of α = r² has Blinn's exponent 2/α² − 2, and a Phong lobe about
the mirror direction is as wide as a Blinn lobe of four times its exponent.
"""

from dataclasses import dataclass, replace

from . import compat, data
from .nodes import TreeReader, input_of, output_node
from .program import ONE, ZERO, Value, color, scalar

MAX_SHININESS = 20000.0
_LEAST_ROUGHNESS_4 = 1.25e-3  # an exponent of 400: the highlights of lamps stay wide enough to be seen


@dataclass
class Surface:
    """Coefficients as Values; ambient None: as diffuse; mirror None: as specular; normal None: the surface's own."""

    emission: Value = ZERO
    diffuse: Value = ZERO
    specular: Value = ZERO
    mirror: Value = None
    transmission: Value = ZERO
    ambient: Value = None
    shininess: Value = scalar(30)
    ior: Value = scalar(1.5)
    alpha: Value = ONE
    normal: Value = None
    thin: bool = False
    fresnel: bool = False
    priority: int = 0
    absorption: tuple = (0.0, 0.0, 0.0)


def export_material(material, textures, warn):
    """The data.Material of a bpy.types.Material. warn takes lines that name what could not be said in coefficients."""
    reader = TreeReader(f"material '{material.name}'", textures, warn)
    if compat.uses_nodes(material):
        surface = _MaterialReader(reader).output(material.node_tree)
    else:
        surface = _without_nodes(reader, material)
    _override(surface, getattr(material, "triptych", None))
    result = _finish(reader.program, surface, material.name)
    result.double_sided = not material.use_backface_culling
    result.index = material.pass_index
    return result


def _finish(program, surface, name):
    """A data.Material of a Surface; constants are held within the ranges that the core takes."""
    values = {key: getattr(surface, key) for key in data.COEFFICIENTS}
    values["normal"] = surface.normal
    nodes, place = program.used([value.node for value in values.values() if value is not None])
    result = data.Material(
        name,
        nodes=nodes,
        thin=surface.thin,
        fresnel=surface.fresnel,
        priority=surface.priority,
        absorption=surface.absorption,
    )
    for key, value in values.items():
        if value is None:
            continue
        if key == "normal":
            result.normal = place[value.node]
            continue
        least, most = {"ior": (1e-3, 1e3), "alpha": (0, 1), "shininess": (0, MAX_SHININESS)}.get(key, (0, 3e38))
        channels = 1 if key in data.SCALARS else 3
        if value.is_constant:
            numbers = tuple(min(max(number, least), most) for number in value.constant[:channels])
            setattr(result, key, data.Coefficient(numbers))
        else:
            setattr(result, key, data.Coefficient((1.0,) * channels, place[value.node]))
    return result


def _override(surface, settings):
    """Puts the classic coefficients of material.triptych in place, where its switch is on."""
    if settings is None or not settings.override:
        return
    surface.ambient = color(settings.ambient) if settings.use_ambient else None
    surface.diffuse = color(settings.diffuse)
    surface.specular = color(settings.specular)
    surface.shininess = scalar(settings.shininess)
    surface.mirror = color(settings.mirror) if settings.use_mirror else None
    surface.transmission = color(settings.transmission)
    surface.ior = scalar(settings.ior)
    surface.thin = settings.thin
    surface.fresnel, surface.priority = settings.fresnel, settings.priority
    surface.absorption = tuple(settings.absorption)


def _without_nodes(reader, material):
    """A material that has no nodes: the viewport's colour, metallic, roughness and specular."""
    rgba = material.diffuse_color
    return _principled(
        reader.program,
        base=color(rgba[:3]),
        metallic=scalar(material.metallic),
        roughness=scalar(material.roughness),
        level=scalar(material.specular_intensity),
        alpha=scalar(rgba[3]),
    )


def shininess(program, roughness):
    """Phong's exponent of a microfacet roughness."""
    square = program.power(roughness, scalar(4))
    blinn = program.subtract(program.divide(scalar(2), program.maximum(square, scalar(_LEAST_ROUGHNESS_4))), scalar(2))
    return program.multiply(blinn, scalar(0.25))


def highlight(program, reflectance, exponent):
    """K_S of a reflectance: a lamp's highlight holds as much light as its mirror image, and so is (n + 2)/2 times as
    bright at its middle (the normalization of Phong's lobe), but no brighter than its light on a white surface."""
    peak = program.multiply(program.add(exponent, scalar(2)), scalar(0.5))
    return program.clamp(program.multiply(reflectance, peak))


def _reflectance(program, ior):
    """((η − 1) / (η + 1))²"""
    ratio = program.divide(program.subtract(ior, ONE), program.add(ior, ONE))
    return program.multiply(ratio, ratio)


def _principled(
    program,
    base,
    metallic=ZERO,
    roughness=scalar(0.5),  # noqa: B008 - an immutable constant
    level=scalar(0.5),  # noqa: B008
    tint=ONE,
    ior=scalar(1.45),  # noqa: B008
    transmission=ZERO,
    emission=ZERO,
    alpha=ONE,
    normal=None,
    thin=False,
):
    p = program
    if compat.principled_has_ior_level():
        reflectance = p.multiply(_reflectance(p, ior), p.multiply(level, scalar(2)))
    else:
        reflectance = p.multiply(level, scalar(0.08))
    dielectric = p.multiply(base, p.one_minus(metallic))
    mirror, exponent = p.mix(p.multiply(reflectance, tint), base, metallic), shininess(p, roughness)
    return Surface(
        emission=emission,
        diffuse=p.multiply(dielectric, p.one_minus(transmission)),
        specular=highlight(p, mirror, exponent),
        mirror=mirror,
        transmission=p.multiply(dielectric, transmission),
        shininess=exponent,
        ior=ior,
        alpha=alpha,
        normal=normal,
        thin=thin,
    )


class _MaterialReader:
    """Surfaces of shader sockets."""

    def __init__(self, reader):
        self.reader = reader
        self.program = reader.program

    def output(self, tree):
        """The Surface of the tree's output; black where nothing is linked, as in Cycles."""
        output = output_node(tree)
        if output is None:
            return Surface()
        for name, what in (("Volume", "volumes are"), ("Displacement", "displacement is")):
            if self.reader.source(output.inputs[name], ())[0] is not None:
                self.reader.warn(f"{what} not supported yet")
        return self.surface(output.inputs["Surface"], ()) or Surface()

    def surface(self, socket, stack):
        """The Surface of a shader socket, or None where nothing is linked."""
        node, source, at = self.reader.source(socket, stack)
        if node is None:
            return None
        handler = getattr(self, "_" + node.bl_idname, None)
        if handler is not None:
            return handler(node, at)
        if source.type != "SHADER":  # a colour in a shader socket shines
            return Surface(emission=self.reader.convert(self.reader.value(socket, stack), source.type, "RGBA"))
        self.reader.warn_node(node, "is not supported; a diffuse surface of its colour stands in")
        return Surface(diffuse=self._value(node, at, "Color") or scalar(0.8))

    def _value(self, node, stack, *identifiers):
        socket = input_of(node, *identifiers)
        return None if socket is None else self.reader.value(socket, stack)

    def _normal(self, node, stack):
        return self.reader.normal(input_of(node, "Normal"), stack)

    # ---- shaders

    def _ShaderNodeBsdfPrincipled(self, node, stack):
        p, reader = self.program, self.reader

        def value(word, default=ZERO):
            socket = compat.principled_socket(node, word)
            return default if socket is None else reader.value(socket, stack)

        for word in ("subsurface", "coat", "sheen", "anisotropic"):
            if not value(word).is_always(0):
                reader.warn_node(node, f"uses {word}, which has no coefficient; it is left out")
        base, tint = value("base"), value("specular_tint")
        if not compat.principled_has_ior_level():
            # Before 4.0, the tint is a number: how far the highlight takes the hue of the base.
            tint = p.mix(ONE, p.divide(base, p.luminance(base)), tint)
        return _principled(
            p,
            base=base,
            metallic=p.clamp(value("metallic")),
            roughness=p.clamp(value("roughness")),
            level=value("specular"),
            tint=tint,
            ior=value("ior"),
            transmission=p.clamp(value("transmission")),
            emission=p.multiply(value("emission"), value("emission_strength", ONE)),
            alpha=p.clamp(value("alpha")),
            normal=self._normal(node, stack),
            thin=value("thin").is_always(1),
        )

    def _ShaderNodeBsdfDiffuse(self, node, stack):
        return Surface(diffuse=self._value(node, stack, "Color"), normal=self._normal(node, stack))

    def _ShaderNodeEmission(self, node, stack):
        strength = self._value(node, stack, "Strength")
        return Surface(emission=self.program.multiply(self._value(node, stack, "Color"), strength))

    _ShaderNodeBackground = _ShaderNodeEmission

    def _glossy(self, node, stack):
        mirror = self._value(node, stack, "Color", "Base Color")
        exponent = shininess(self.program, self.program.clamp(self._value(node, stack, "Roughness")))
        return Surface(
            specular=highlight(self.program, mirror, exponent),
            mirror=mirror,
            shininess=exponent,
            normal=self._normal(node, stack),
        )

    _ShaderNodeBsdfGlossy = _glossy
    _ShaderNodeBsdfAnisotropic = _glossy
    _ShaderNodeBsdfMetallic = _glossy

    def _ShaderNodeBsdfGlass(self, node, stack):
        p = self.program
        tint, ior = self._value(node, stack, "Color"), self._value(node, stack, "IOR")
        glossy = self._glossy(node, stack)
        return replace(
            glossy,
            specular=highlight(p, p.multiply(tint, _reflectance(p, ior)), glossy.shininess),
            mirror=tint,
            transmission=tint,
            ior=ior,
            fresnel=True,
        )

    def _ShaderNodeBsdfRefraction(self, node, stack):
        return replace(
            self._glossy(node, stack),
            specular=ZERO,
            mirror=ZERO,
            transmission=self._value(node, stack, "Color"),
            ior=self._value(node, stack, "IOR"),
        )

    def _ShaderNodeBsdfTransparent(self, node, stack):
        tint = self._value(node, stack, "Color")
        if tint.is_always(1):
            return Surface(alpha=ZERO)
        return Surface(transmission=tint, thin=True)

    def _ShaderNodeMixShader(self, node, stack):
        shaders = [socket for socket in node.inputs if socket.type == "SHADER"]
        a, b = (self.surface(socket, stack) or Surface() for socket in shaders)
        factor = self.program.clamp(self.reader.value(node.inputs[0], stack))
        return self._mix(node, a, b, factor)

    def _ShaderNodeAddShader(self, node, stack):
        a, b = (self.surface(socket, stack) or Surface() for socket in node.inputs)
        p = self.program
        # What is added to a clear surface is added to what is seen through it: not coverage, but transmission.
        a, b = (
            replace(one, alpha=ONE, transmission=ONE, thin=True) if one.alpha.is_always(0) else one for one in (a, b)
        )
        result = self._common(node, a, b, scalar(0.5))
        for name in ("emission", "diffuse", "specular", "transmission"):
            setattr(result, name, p.add(getattr(a, name), getattr(b, name)))
        if a.mirror is not None or b.mirror is not None:
            result.mirror = p.add(a.mirror or a.specular, b.mirror or b.specular)
        result.alpha = p.mix(a.alpha, b.alpha, scalar(0.5))
        return result

    def _mix(self, node, a, b, factor):
        """a to b by factor. Coefficients count as much as their surface covers."""
        p = self.program
        if factor.is_always(0):
            return a
        if factor.is_always(1):
            return b
        if a.alpha.is_always(0):
            return replace(b, alpha=p.multiply(b.alpha, factor))
        if b.alpha.is_always(0):
            return replace(a, alpha=p.multiply(a.alpha, p.one_minus(factor)))
        alpha = p.mix(a.alpha, b.alpha, factor)
        if a.alpha != b.alpha:
            factor = p.divide(p.multiply(b.alpha, factor), alpha)
        result = self._common(node, a, b, factor)
        for name in ("emission", "diffuse", "specular", "transmission"):
            setattr(result, name, p.mix(getattr(a, name), getattr(b, name), factor))
        if a.mirror is not None or b.mirror is not None:
            result.mirror = p.mix(a.mirror or a.specular, b.mirror or b.specular, factor)
        result.alpha = alpha
        return result

    def _common(self, node, a, b, factor):
        """What two surfaces have one of: of the surface that uses it, or in between where both do."""

        def chosen(name, weight):
            one, other = getattr(a, name), getattr(b, name)
            if getattr(b, weight).is_always(0):
                return one
            return other if getattr(a, weight).is_always(0) else self.program.mix(one, other, factor)

        if a.normal is not None and b.normal is not None and a.normal != b.normal:
            self.reader.warn_node(node, "blends two normals; the first is used")
        return Surface(
            shininess=chosen("shininess", "specular"),
            ior=chosen("ior", "transmission"),
            normal=a.normal if a.normal is not None else b.normal,
            thin=(a.thin and not a.transmission.is_always(0)) or (b.thin and not b.transmission.is_always(0)),
            # Of both or of none: what Fresnel's equations weigh cannot be told from what they do not.
            fresnel=(a.fresnel or a.mirror is None) and (b.fresnel or b.mirror is None) and (a.fresnel or b.fresnel),
        )
