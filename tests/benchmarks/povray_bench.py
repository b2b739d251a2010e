# SPDX-License-Identifier: GPL-3.0-or-later
"""Recursive ray tracing beside POV-Ray 3.7: one picture of 201 mirror balls on a floor, 1280 × 720 pixels.

POV-Ray traces true spheres; Triptych one finely tessellated ball, placed 201 times. Both have the same camera, one
point light without falloff, Phong's highlight, reflections to the same depth and no ambient light, so that the pictures
are alike up to tessellation; relMSE between them says how far. The model is Whitted's:

    POV-Ray   diffuse d, phong k, phong_size n, reflection r     a light of rgb 1
    Triptych  K_D = d, K_S = k in the highlight, n, K_S = r in the mirror     a light of I_L = 1, which is π W/sr

Three pictures: one ray through the middle of each pixel; nine samples in each, of both; and POV-Ray's adaptive
anti-aliasing (one sample, and nine more where neighbours differ by 0.1) beside nine of ours. Wall and CPU time are of
the whole process, from the scene's file to OpenEXR, starting and waiting included. The time of a ray is CPU seconds of
tracing alone on one thread, in the first picture; rays are primary and reflected ones and shadow tests, as each side
counts its own. Medians; the sides alternate.

relMSE between the first pictures is that of the tessellation; between the others also of two sets of samples.
"""

import json
import math
import re
import sys
from dataclasses import dataclass
from statistics import median

import numpy as np
from figures import ROOT, arguments, cost_of, figure, picture, relative_error

sys.path[:0] = [str(ROOT / "blender_addon" / "triptych"), str(ROOT / "scenes")]
import glb  # noqa: E402
import shapes  # noqa: E402

WIDTH, HEIGHT, DEPTH = 1280, 720, 6
LEAST_WEIGHT = 1e-3  # of rays in their pixel
EYE, TARGET, HALF_WIDTH = (0.0, 5.2, 9.5), (0.0, 0.1, 0.9), 0.56  # metres, Y up; of the film at distance 1
LIGHT, SKY = (-7.0, 12.0, 6.0), (0.25, 0.40, 0.65)
FLOOR_SIZE = 30.0  # metres from the middle to each side
BALL = {"diffuse": 0.15, "phong": 0.6, "size": 60, "mirror": 0.7}
FLOOR = {"diffuse": 0.55, "phong": 0.0, "size": 1, "mirror": 0.15}
FREQUENCY = 64  # of the divided icosahedron: 81,920 triangles
PICTURES = {  # our samples in a pixel, and POV-Ray's options
    "one_sample": (1, []),
    "nine_samples": (9, ["+A0.0", "+AM1", "+R3", "-J"]),
    "antialiased": (9, ["+A0.1", "+AM1", "+R3", "-J"]),
}


@dataclass
class Run:
    wall: float  # seconds of the process
    cpu: float  # seconds of the process
    tracing: float  # CPU seconds
    rays: dict[str, int]


def balls():
    """201 rows of (x, y, z, radius): a large ball, and 200 around it, along the spiral of a sunflower."""
    k = np.arange(1, 201)
    angle, distance, radius = k * math.pi * (3 - math.sqrt(5)), 1.2 + 0.33 * np.sqrt(k), 0.14 + 0.0006 * k
    around = np.stack([distance * np.cos(angle), radius, distance * np.sin(angle), radius], axis=1)
    return np.concatenate([[[0, 1.2, 0, 1.2]], around])


def camera_axes():
    """Unit vectors to the right, up and back."""
    back = shapes.unit(np.subtract(EYE, TARGET))
    right = shapes.unit(np.cross((0, 1, 0), back))
    return right, np.cross(back, right), back


def write_pov(path):
    def vector(values):
        return "<" + ", ".join(f"{float(value):.9g}" for value in values) + ">"

    def surface(of):
        finish = f"ambient 0 diffuse {of['diffuse']} phong {of['phong']} phong_size {of['size']}"
        return f"pigment {{ rgb 1 }} finish {{ {finish} reflection {of['mirror']} }}"

    right, up, back = camera_axes()
    s = FLOOR_SIZE
    a, b, c, d = (vector(corner) for corner in ((-s, 0, s), (s, 0, s), (s, 0, -s), (-s, 0, -s)))
    lines = [
        "#version 3.7;",
        f"global_settings {{ assumed_gamma 1 max_trace_level {DEPTH} adc_bailout {LEAST_WEIGHT} }}",
        f"background {{ rgb {vector(SKY)} }}",
        f"camera {{ location {vector(EYE)} direction {vector(-back)} right {vector(2 * HALF_WIDTH * right)}",
        f"  up {vector(2 * HALF_WIDTH * HEIGHT / WIDTH * up)} }}",
        f"light_source {{ {vector(LIGHT)} rgb 1 }}",
        f"mesh {{ triangle {{ {a}, {b}, {c} }} triangle {{ {a}, {c}, {d} }} {surface(FLOOR)} }}",
        *(f"sphere {{ {vector(ball[:3])}, {ball[3]:.9g} {surface(BALL)} }}" for ball in balls()),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_glb(path):
    file = glb.Glb({"version": "2.0", "extras": {"triptych": {"version": 1}}})

    def material(of):
        values = {"diffuse": of["diffuse"], "specular": of["phong"], "shininess": of["size"], "mirror": of["mirror"]}
        return {"extras": {"triptych": values}}

    def mesh(points, triangles, normals, index):
        attributes = {
            "POSITION": file.accessor(points.astype(np.float32), glb.ARRAY_BUFFER, bounds=True),
            "NORMAL": file.accessor(normals.astype(np.float32), glb.ARRAY_BUFFER),
        }
        indices = file.accessor(triangles.astype(np.uint32), glb.ELEMENT_BUFFER)
        return {"primitives": [{"attributes": attributes, "indices": indices, "material": index}]}

    def node(columns, origin, **content):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = np.transpose(columns), origin
        return {"matrix": matrix.T.ravel().tolist(), **content}

    ball, s = shapes.sphere(FREQUENCY), FLOOR_SIZE
    corners = np.array([(-s, 0, s), (s, 0, s), (s, 0, -s), (-s, 0, -s)])
    lamp = {"type": "point", "emission": [math.pi] * 3, "falloff": "constant"}
    file.json["materials"] = [material(BALL), material(FLOOR)]
    file.json["meshes"] = [
        mesh(ball.vertices, ball.corners, ball.vertices, 0),
        mesh(corners, np.array([0, 1, 2, 0, 2, 3]), np.array([(0, 1, 0)] * 4), 1),
    ]
    view = {"yfov": 2 * math.atan(HALF_WIDTH * HEIGHT / WIDTH), "aspectRatio": WIDTH / HEIGHT, "znear": 0.1}
    file.json["cameras"] = [{"type": "perspective", "perspective": view}]
    file.json["nodes"] = [
        node(camera_axes(), EYE, camera=0),
        node(np.eye(3), LIGHT, extras={"triptych": {"light": lamp}}),
        node(np.eye(3), (0, 0, 0), mesh=1),
        *(node(np.eye(3) * radius, center, mesh=0) for *center, radius in balls()),
    ]
    world = {"radiance": SKY, "visible_camera": True, "light": False}
    nodes = list(range(len(file.json["nodes"])))
    file.json["scenes"] = [{"nodes": nodes, "extras": {"triptych": {"world": world}}}]
    file.write(path)


class Bench:
    def __init__(self, options):
        self.folder = options.build.resolve() / "bench"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.command = options.build.resolve() / "bin" / "triptych"
        write_pov(self.folder / "spheres.pov")
        write_glb(self.folder / "spheres.glb")

    def povray(self, name, threads):
        command = ["povray", "+Ispheres.pov", f"+O{name}_povray.exr", "+FE", f"+W{WIDTH}", f"+H{HEIGHT}", "-D"]
        wall, cpu, said = cost_of([*command, f"+WT{threads}", *PICTURES[name][1]], self.folder)

        def number(pattern):
            return float(re.search(pattern, said, re.M | re.S)[1])

        reflected = number(r"^Reflected Rays:\s+(\d+)")
        rays = {"primary": number(r"^Rays:\s+(\d+)") - reflected, "shadow": number(r"^Shadow Ray Tests:\s+(\d+)")}
        tracing = number(r"Trace Time:.*?with ([\d.]+) CPU-seconds")
        return Run(wall, cpu, tracing, {**rays, "reflection": reflected})

    def triptych(self, name, threads):
        samples = PICTURES[name][0]
        settings = {
            "samples": samples,
            "threads": threads,
            "trace.depth": DEPTH,
            "trace.least_weight": LEAST_WEIGHT,
            "film.filter": "box",
            "film.filter_width": 0 if samples == 1 else 1,
        }
        command = [self.command, "render", "spheres.glb", "--method", "ray_tracing", "--quiet"]
        command += ["--output", f"{name}_triptych.exr", "--stats", "stats.json", "--width", WIDTH, "--height", HEIGHT]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        wall, cpu, _ = cost_of([str(word) for word in command], self.folder)
        stats = json.loads((self.folder / "stats.json").read_text(encoding="utf-8"))
        seconds = stats["seconds"]
        # Stages are told in wall seconds, which on one thread are the process's CPU seconds but for what others take.
        stages = sum(seconds[stage] for stage in ("load", "commit", "render", "write"))
        return Run(wall, cpu, cpu * seconds["render"] / stages, stats["rays"])

    def pairs(self, name, threads, repeats):
        """Runs of both sides, in turn: ours and theirs."""
        return zip(*((self.triptych(name, threads), self.povray(name, threads)) for _ in range(repeats)), strict=True)

    def error(self, name):
        return relative_error(*(picture(self.folder / f"{name}_{side}.exr") for side in ("triptych", "povray")))


def main():
    options = arguments(__doc__).parse_args()
    bench = Bench(options)

    def compare(name, unit, sides, value, goal=None):
        ours, theirs = (median(value(run) for run in side) for side in sides)
        figure(f"ray_tracing.povray.{name}", ours, unit, "POV-Ray 3.7", theirs, goal)

    sides = tuple(bench.pairs("one_sample", 1, options.repeats))
    compare("ray", "CPU ns", sides, lambda run: 1e9 * run.tracing / sum(run.rays.values()), 0.2)
    for kind in ("primary", "reflection", "shadow"):
        compare(f"{kind}_rays", "Mrays", sides, lambda run, kind=kind: 1e-6 * run.rays[kind])
    for name in PICTURES:
        sides = tuple(bench.pairs(name, options.threads, options.repeats))
        compare(name, "s", sides, lambda run: run.wall, 0.2)
        compare(f"{name}.cpu", "CPU s", sides, lambda run: run.cpu)
        figure(f"ray_tracing.povray.{name}.error", bench.error(name), "relMSE to POV-Ray's", goal=1e-3)


if __name__ == "__main__":
    main()
