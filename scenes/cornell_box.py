# SPDX-License-Identifier: GPL-3.0-or-later
"""The Cornell box, as measured by the Program of Computer Graphics, Cornell University.

Geometry, reflectance spectra and the light's spectrum are the published measurements (Goral, Torrance, Greenberg,
Battaile, "Modeling the Interaction of Light Between Diffuse Surfaces", SIGGRAPH 1984, and the box's data page), at
0.001 metres to a unit, turned from Y up to Z up. The ceiling has a hole in which the light sits.

Colours. The spectra become linear Rec. 709 under the box's own light: with XYZ(s) = ∫ s·(x̄, ȳ, z̄) dλ / ∫ ȳ dλ over
400 to 700 nm and RGB = M·XYZ, the light's radiance is EXPOSURE · RGB(L), and a wall's reflectance is, channel by
channel, RGB(L·ρ) / RGB(L), held between 0 and 1: light seen after one reflection is then exactly the spectral result.
The colour-matching functions are the multi-lobe fit to the CIE 1931 observer of Wyman, Sloan and Shirley, "Simple
Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013.
"""

import common
import numpy as np
import shapes

SCALE = 0.001  # metres to a unit of the measured geometry
EXPOSURE = 2.0  # the light's spectrum is in arbitrary units; this makes a picture in range

# From 400 to 700 nm in steps of 4 nm.
WAVELENGTHS = np.arange(400.0, 701.0, 4.0)
REFLECTANCES = {
    "white": [
        0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739,
        0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747,
        0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728,
        0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736, 0.734, 0.741, 0.740, 0.732,
        0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730, 0.727,
        0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737,
    ],
    "green": [
        0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096,
        0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285,
        0.343, 0.390, 0.435, 0.464, 0.472, 0.476, 0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373,
        0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207, 0.186, 0.171, 0.160, 0.148,
        0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118,
        0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159,
    ],
    "red": [
        0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061,
        0.061, 0.060, 0.062, 0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058,
        0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063,
        0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349,
        0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610, 0.650,
        0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642,
    ],
}
LIGHT_REFLECTANCE = 0.78
LIGHT_WAVELENGTHS, LIGHT_SPECTRUM = (400.0, 500.0, 600.0, 700.0), (0.0, 8.0, 15.6, 18.4)  # linear between

REC709_FROM_XYZ = np.array([  # IEC 61966-2-1, white D65
    [3.2404542, -1.5371385, -0.4985314],
    [-0.9692660, 1.8760108, 0.0415560],
    [0.0556434, -0.2040259, 1.0572252],
])

# Quads by corners (x, y, z) in the measured frame: x to the left, y up, z away from the camera.
WALLS = {
    "Floor": ("white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    "Back Wall": ("white", [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    "Green Wall": ("green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    "Red Wall": ("red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
}
CEILING = [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
LIGHT = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]
BLOCKS = {  # the corners of the top; the sides are upright
    "Short Block": [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
    "Tall Block": [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
}
CAMERA = (278, 273, -800)
FOCAL_LENGTH, FILM = 35.0, 25.0  # millimetres


def matching_functions(wavelengths):
    """x̄, ȳ, z̄ of the CIE 1931 observer, (3, n), by the fit of Wyman, Sloan and Shirley."""

    def lobe(weight, centre, below, above):
        width = np.where(wavelengths < centre, below, above)
        return weight * np.exp(-0.5 * ((wavelengths - centre) / width) ** 2)

    x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2)
    y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1)
    z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)
    return np.stack([x, y, z])


def rec709(spectrum, wavelengths):
    """Linear Rec. 709 of a spectrum sampled at 1 nm steps, in its own units."""
    matching = matching_functions(wavelengths)
    return REC709_FROM_XYZ @ ((matching * spectrum).sum(1) / matching[1].sum())


def colours():
    """The light's radiance and the reflectances by name, linear Rec. 709."""
    wavelengths = np.arange(400.0, 701.0)
    light = np.interp(wavelengths, LIGHT_WAVELENGTHS, LIGHT_SPECTRUM)
    emitted = rec709(light, wavelengths)
    reflectances = {
        name: np.clip(rec709(light * np.interp(wavelengths, WAVELENGTHS, table), wavelengths) / emitted, 0, 1)
        for name, table in REFLECTANCES.items()
    }
    return EXPOSURE * emitted, reflectances


def turned(points):
    """From the measured frame to metres, Z up: (x, y, z) to (x, −z, y)."""
    points = np.asarray(points, float) * SCALE
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], -1)


def block(top):
    """A closed box under the corners of its top."""
    top = np.asarray(top, float)
    vertices = np.concatenate([top * [1, 0, 1], top])
    sides = [(k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4) for k in range(4)]
    return shapes.polygons(turned(vertices), [(4, 5, 6, 7), (3, 2, 1, 0)] + [side[::-1] for side in sides])


def build():
    common.start("Cornell Box", 512, 512)
    radiance, reflectances = colours()
    materials = {name: common.diffuse(name.capitalize(), tuple(value)) for name, value in reflectances.items()}
    light = common.emitter("Light", tuple(radiance), (LIGHT_REFLECTANCE,) * 3)

    for name, (material, corners) in WALLS.items():
        common.mesh_object(name, shapes.polygons(turned(corners), [(0, 1, 2, 3)]), materials[material])
    rim = [(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4)]  # four quads about the hole
    common.mesh_object("Ceiling", shapes.polygons(turned(CEILING + LIGHT), rim), materials["white"])
    common.mesh_object("Light", shapes.polygons(turned(LIGHT), [(0, 1, 2, 3)]), light)
    for name, top in BLOCKS.items():
        common.mesh_object(name, block(top), materials["white"])

    x, y, z = turned(CAMERA)
    common.camera((x, y, z), (x, y - 1, z), FOCAL_LENGTH, FILM)
    common.world((0, 0, 0))
