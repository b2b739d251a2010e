# SPDX-License-Identifier: Apache-2.0
"""The figures of mitsuba_test.cpp: its scenes, built of the same numbers, rendered by Mitsuba 3.

    pip install mitsuba==3.9.1 numpy
    python mitsuba_figures.py room|terrace [PASSES [PICTURE.exr]]

prints means over blocks of pixels, rows from above, and the noise that is left in them.
"""

import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

T = mi.ScalarTransform4f
BLOCKS = 4
SAMPLES = 256  # of a pass


def look_at(origin, target, up=(0, 0, 1)):
    return T().look_at(origin=list(origin), target=list(target), up=list(up))


def rgb(*values):
    return {"type": "rgb", "value": list(values)}


def diffuse(*values):
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(*values)}}


def mirror(*values):
    return {"type": "twosided", "bsdf": {"type": "conductor", "material": "none", "specular_reflectance": rgb(*values)}}


def mesh(positions, faces, bsdf, normals=None, uvs=None):
    """Of polygons, cut into fans as convex ones are in the core."""
    triangles = [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(bsdf)
    made = mi.Mesh(
        "mesh",
        len(positions),
        len(triangles),
        has_vertex_normals=normals is not None,
        has_vertex_texcoords=uvs is not None,
        props=properties,
    )
    params = mi.traverse(made)
    params["vertex_positions"] = np.ravel(positions).astype(np.float32)
    params["faces"] = np.ravel(triangles).astype(np.uint32)
    if normals is not None:
        params["vertex_normals"] = np.ravel(normals).astype(np.float32)
    if uvs is not None:
        params["vertex_texcoords"] = np.ravel(uvs).astype(np.float32)
    params.update()
    return made


def quad(a, b, c, d, bsdf, uvs=None):
    return mesh([a, b, c, d], [(0, 1, 2, 3)], bsdf, uvs=uvs)


def box(low, high, bsdf):
    """Faces that share no vertices, so that they are flat."""
    corners = [[(high if k >> c & 1 else low)[c] for c in range(3)] for k in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return mesh([corners[v] for face in faces for v in face], [range(4 * f, 4 * f + 4) for f in range(6)], bsdf)


def sphere(centre, radius, rings, bsdf):
    segments = 2 * rings
    theta, phi = np.meshgrid(
        np.pi * np.arange(rings + 1) / rings, 2 * np.pi * np.arange(segments) / segments, indexing="ij"
    )
    normals = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1).reshape(-1, 3)
    faces = []
    for r in range(rings):
        for s in range(segments):
            at = [(r, s), (r + 1, s), (r + 1, s + 1), (r, s + 1)]
            face = [ring * segments + segment % segments for ring, segment in at]
            if r == 0:
                face = face[:3]  # the other half has no area
            elif r == rings - 1:
                face = [face[0], face[2], face[3]]
            faces.append(face)
    return mesh(np.asarray(centre) + radius * normals, faces, bsdf, normals)


def room():
    """Glass, a pane, a curved and a flat mirror, under a lamp in the ceiling that they show.

    No blendbsdf: in a closed room that glows, 3.9.1 makes it 8 % too bright, where the geometric series is known.
    """
    glass = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    scene = {
        "floor": quad((-2, -2, 0), (0.2, -2, 0), (0.2, 2, 0), (-2, 2, 0), diffuse(0.8, 0.7, 0.6)),
        "polished": quad((0.2, -2, 0), (2, -2, 0), (2, 2, 0), (0.2, 2, 0), mirror(0.6, 0.6, 0.5)),
        "ceiling": quad((-2, -2, 4), (-2, 2, 4), (2, 2, 4), (2, -2, 4), diffuse(0.7, 0.7, 0.7)),
        "left": quad((-2, -2, 0), (-2, 2, 0), (-2, 2, 4), (-2, -2, 4), diffuse(0.7, 0.2, 0.15)),
        "right": quad((2, -2, 0), (2, -2, 4), (2, 2, 4), (2, 2, 0), diffuse(0.2, 0.6, 0.25)),
        "back": quad((-2, 2, 0), (2, 2, 0), (2, 2, 4), (-2, 2, 4), diffuse(0.6, 0.6, 0.7)),
        "front": quad((-2, -2, 0), (-2, -2, 4), (2, -2, 4), (2, -2, 0), diffuse(0.5, 0.5, 0.5)),
        "ball": sphere((0.8, -0.2, 0.85), 0.8, 96, glass),
        "block": box((-0.3, -0.4, 0.05), (-0.05, 0.2, 1.2), glass),
        "mirror": sphere((-0.9, 0.8, 0.75), 0.7, 96, mirror(0.9, 0.8, 0.7)),
        "pane": quad(
            (-1.7, -0.6, 0.05),
            (-0.5, -0.6, 0.05),
            (-0.5, -0.6, 1.6),
            (-1.7, -0.6, 1.6),
            {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0},
        ),
        "lamp": {
            "type": "rectangle",
            "to_world": T().translate([0, 0, 3.999]).rotate([1, 0, 0], 180),
            "bsdf": diffuse(0, 0, 0),
            "emitter": {"type": "area", "radiance": rgb(6, 5, 4)},
        },
    }
    camera = {
        "type": "perspective",
        "fov": np.degrees(1.3),
        "fov_axis": "x",
        "near_clip": 0.01,
        "far_clip": 1000,
        "to_world": look_at((0.2, -1.95, 1.8), (0, 0.4, 0.9)),
    }
    return scene, camera, (128, 128), 64


def sky(d):
    """Radiance from the direction d."""
    towards = np.array([1, -1, 1.2]) / np.sqrt(3.44)
    return (0.6 + 0.4 * d[..., 2:]) * np.array([0.25, 0.35, 0.5]) + np.exp(12 * (d @ towards - 1))[
        ..., None
    ] * np.array([3, 2, 1])


def terrace():
    """A textured floor and smooth bodies under a sky, a sun, a spot and a point light, through a lens."""
    width, height = 512, 256
    to_world = T().rotate([1, 0, 0], 90)
    # Mitsuba's rows begin and end at the poles, its columns are pixels' centres.
    phi, theta = np.meshgrid(2 * np.pi * (np.arange(width) + 0.5) / width, np.pi * np.arange(height) / (height - 1))
    local = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)], -1)
    picture = sky(local @ np.array(to_world.matrix)[:3, :3].T).astype(np.float32)
    y, x = np.mgrid[0:8, 0:8]
    texels = 0.2 + 0.6 / 8 * np.stack([(3 * x + 5 * y) % 8, (5 * x + y) % 8, (x + 3 * y) % 8], -1)
    board = {
        "type": "twosided",
        "bsdf": {
            "type": "diffuse",
            "reflectance": {
                "type": "bitmap",
                "bitmap": mi.Bitmap(texels.astype(np.float32)),
                "raw": True,
                "filter_type": "nearest",
            },
        },
    }
    scene = {
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(picture), "to_world": to_world},
        "floor": quad((-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0), board, [(0, 0), (1, 0), (1, 1), (0, 1)]),
        "ball": sphere((-1, 0.3, 0.9), 0.9, 48, diffuse(0.8, 0.6, 0.3)),
        "far": sphere((1.2, 1.5, 0.7), 0.7, 48, diffuse(0.3, 0.5, 0.8)),
        "block": box((0.4, -1.2, 0), (1.4, -0.4, 1.1), diffuse(0.7, 0.7, 0.7)),
        "sun": {"type": "directional", "direction": [1, 2, -2], "irradiance": rgb(1.5, 1.4, 1.2)},
        "spot": {
            "type": "spot",
            "to_world": look_at((-3, -2, 4), (-0.5, 0, 0.3)),
            "intensity": rgb(20, 12, 8),
            "cutoff_angle": 20,
            "beam_width": 19.9999,
        },
        "point": {"type": "point", "position": [2.5, 0.5, 2.2], "intensity": rgb(2, 4, 6)},
    }
    camera = {
        "type": "thinlens",
        "fov": np.degrees(0.8),
        "fov_axis": "x",
        "near_clip": 0.01,
        "far_clip": 1000,
        "aperture_radius": 0.1,
        "focus_distance": 6,
        "to_world": look_at((0.5, -6, 2.6), (0, 0, 0.7)),
    }
    return scene, camera, (160, 96), 4


def main(name, passes=16, picture=None):
    scene, camera, (width, height), depth = {"room": room, "terrace": terrace}[name]()
    camera |= {
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }
    loaded = mi.load_dict(
        {"type": "scene", "integrator": {"type": "path", "max_depth": depth}, "camera": camera} | scene
    )
    means, total = [], 0
    for seed in range(int(passes)):
        image = np.array(mi.render(loaded, spp=SAMPLES, seed=seed)).astype(float)
        total = total + image / int(passes)
        means.append(image.reshape(BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, 3).mean(axis=(1, 3)))
    if picture:
        mi.Bitmap(total.astype(np.float32)).write(picture)
    mean = np.mean(means, axis=0)
    for block in mean.reshape(-1, 3):
        print("    {" + ", ".join(f"{value:.6g}" for value in block) + "},")
    noise = np.std(means, axis=0, ddof=1) / np.sqrt(len(means)) / mean
    print("greatest relative noise", noise.max())


if __name__ == "__main__":
    main(*sys.argv[1:])
