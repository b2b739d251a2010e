# SPDX-License-Identifier: GPL-3.0-or-later
"""Recursive ray tracing beside Cycles: the CPU seconds that each needs for a picture with the same noise, relMSE 1e-3.

    build/bpy/bin/python tests/benchmarks/cycles_bench.py still_life [--rough]

Both render the same Blender scene, 320 × 180 pixels, by Blender's render operator; that is what is measured, export,
building and writing included. Neither bounces diffuse light; both reflect and refract 8 times, with the same filter.
Metal and glass are sharp in both pictures; with --rough they are as rough as the scene has them, and Triptych's
trace.rough is on.

The two light models differ, so that each renderer is its own reference: the noise of a picture is its relMSE to what
the same renderer converges to. It is estimated without a long reference, as the variance between four pictures of
different seeds over R² + 0.01, where R is the mean of the last, and best, four. (Seeds of Cycles are not wholly
independent, and its rare bright pixels are seldom met, so that its noise is rather taken for less than it is.) Samples
are quadrupled until the noise is reached (at most 256), and CPU seconds are interpolated between the last two counts,
logarithm by logarithm, or extrapolated where 256 do not reach it.

What differs between the pictures: Cycles' Principled shader reflects more at grazing angles (Fresnel), where Triptych's
K_S is the same at every angle; the sun's highlights on metal are brighter in Cycles, as Triptych holds Phong's to the
light's brightness on a white surface; and without trace.rough what is neither metal nor glass reflects sharply too,
though little. The pictures are left in bench/ of the build directory, and a row says how far they are apart.
"""

import importlib
import math
import os
import sys

import bpy
import numpy as np
from figures import ROOT, arguments, cpu_seconds, figure, picture, relative_error

WIDTH, HEIGHT, DEPTH = 320, 180, 8
NOISE = 1e-3  # relMSE
COUNTS = (4, 16, 64, 256)
SEEDS = (1, 500, 20_000, 900_001)


def sharpen_metal_and_glass():
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type != "BSDF_PRINCIPLED":
                continue
            if max(node.inputs[name].default_value for name in ("Metallic", "Transmission Weight")) > 0:
                node.inputs["Roughness"].default_value = 0


def use_triptych(rough):
    scene = bpy.context.scene
    scene.render.engine = "TRIPTYCH"
    scene.triptych.method = "ray_tracing"
    scene.triptych.trace_depth = DEPTH
    scene.triptych.trace_rough = rough
    return scene.triptych


def use_cycles():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.diffuse_bounces = cycles.volume_bounces = 0
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = DEPTH
    cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    return cycles


def render(engine, samples, seed, path):
    """(the picture, CPU seconds)"""
    engine.samples, engine.seed = samples, seed
    bpy.context.scene.render.filepath = str(path)
    path.unlink(missing_ok=True)
    start = cpu_seconds()
    bpy.ops.render.render(write_still=True)
    spent = cpu_seconds() - start
    return picture(path), spent


def noise(variance, reference):
    return np.mean(variance / (reference**2 + 0.01))


def cost_of_noise(engine, path):
    """(CPU seconds, samples) for a picture of relMSE NOISE, and the best picture that was made."""
    render(engine, 1, 0, path)  # what is loaded late is loaded
    points = []  # (CPU seconds, samples, variance of each pixel)
    for count in COUNTS:
        pictures, seconds = zip(*(render(engine, count, seed, path) for seed in SEEDS), strict=True)
        best = np.mean(pictures, axis=0)
        points.append((np.mean(seconds), count, np.var(pictures, axis=0, ddof=1)))
        if noise(points[-1][2], best) < NOISE:
            break
    before, after = (noise(variance, best) for _, _, variance in points[-2:])
    share = math.log(NOISE / before) / math.log(after / before)
    (*low, _), (*high, _) = points[-2:]
    return [a ** (1 - share) * b**share for a, b in zip(low, high, strict=True)], best


def measure(options):
    name = f"ray_tracing.cycles.{options.scene}" + (".rough" if options.rough else "")
    folder = options.build.resolve() / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    importlib.import_module(options.scene).build()
    settings = bpy.context.scene.render
    settings.resolution_x, settings.resolution_y = WIDTH, HEIGHT
    settings.threads_mode, settings.threads = "FIXED", options.threads
    output = settings.image_settings
    output.file_format, output.color_depth, output.exr_codec = "OPEN_EXR", "32", "NONE"
    if not options.rough:
        sharpen_metal_and_glass()

    ours, our_picture = cost_of_noise(use_triptych(options.rough), folder / f"{name}_triptych.exr")
    theirs, their_picture = cost_of_noise(use_cycles(), folder / f"{name}_cycles.exr")
    peer = f"Cycles of Blender {bpy.app.version_string}"
    figure(name, ours[0], f"CPU s to relMSE {NOISE:g}", peer, theirs[0], 0.1)
    figure(f"{name}.samples", ours[1], "samples", peer, theirs[1])
    figure(f"{name}.difference", relative_error(our_picture, their_picture), "relMSE to Cycles'")


def main():
    parser = arguments(__doc__)
    parser.add_argument("scene", metavar="SCENE", help="a script of scenes/")
    parser.add_argument("--rough", action="store_true", help="metal and glass as rough as the scene has them")
    options = parser.parse_args()
    os.environ["TRIPTYCH_LIBRARY"] = str(options.build.resolve() / "lib" / "libtriptych.so")
    sys.path[:0] = [str(ROOT / "scenes"), str(ROOT / "blender_addon")]
    # What Blender prints is for the reader; standard output is for figures.
    sys.stdout = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    import triptych

    triptych.register()
    try:
        measure(options)
    finally:
        triptych.unregister()


if __name__ == "__main__":
    main()
