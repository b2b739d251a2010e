# SPDX-License-Identifier: GPL-3.0-or-later
"""The still life by every method of the engine, rendered in Blender, a sheet of all of them, and a sheet of shadings.

    blender -b --factory-startup --python-exit-code 1 --python scripts/demo.py -- OUTPUT_FOLDER

Writes METHOD.png for each method and methods.png, which is itself a Blender scene of pictures and captions that the
engine renders; shadings.png, which sets flat, Gouraud and Phong shading of a coarse vase side by side, with the
intensity along one scan line under each; and whitted_spheres.png, a glass and a mirror ball by ray tracing.
"""

import os
import pathlib
import sys
import time

import bpy

ROOT = pathlib.Path(__file__).resolve().parents[1]
os.environ.setdefault("TRIPTYCH_LIBRARY", str(ROOT / "build/lib/libtriptych.so"))
sys.path[:0] = [str(ROOT / "blender_addon"), str(ROOT / "scenes")]

COLUMNS = 3
CAPTION = 0.12  # height of a caption, in picture widths


def use_engine(scene, method, samples):
    scene.render.engine = "TRIPTYCH"
    scene.triptych.method = method
    scene.triptych.samples = samples


def render_to(path):
    """Renders the current scene; gives the seconds that it took."""
    scene = bpy.context.scene
    scene.render.filepath = str(path)
    scene.render.image_settings.file_format = "PNG"
    path.unlink(missing_ok=True)
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    if not path.is_file():
        sys.exit(f"demo: error: {path.name} was not rendered")
    return time.monotonic() - start


def methods():
    """Identifier and label of each method in the engine's drop-down."""
    items = bpy.context.scene.triptych.bl_rna.properties["method"].enum_items
    return [(item.identifier, item.name) for item in items]


def emission(name, picture=None):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
    if picture:
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.load(str(picture))
        texture.extension = "EXTEND"
        material.node_tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    return material


def add_tile(index, count, path, text, ink):
    """A picture one unit wide and its caption, at its place on the sheet; the sheet's size so far."""
    from triptych import lettering

    scene = bpy.context.scene
    columns = min(COLUMNS, count)
    material = emission(text, path)
    picture = material.node_tree.nodes["Image Texture"].image
    height = picture.size[1] / picture.size[0]
    x, y = index % columns, -(index // columns) * (height + CAPTION)
    mesh = bpy.data.meshes.new(text)
    mesh.from_pydata([(x, y, 0), (x + 1, y, 0), (x + 1, y + height, 0), (x, y + height, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new()
    for corner, uv in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        mesh.uv_layers[0].data[corner].uv = uv
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new(text, mesh))
    caption = lettering.curve(text, 0.45 * CAPTION)
    caption.materials.append(ink)
    words = bpy.data.objects.new(text + " caption", caption)
    words.location = (x + 0.02, y - 0.65 * CAPTION, 0)
    scene.collection.objects.link(words)
    rows = (count + columns - 1) // columns
    return columns, rows * (height + CAPTION), height


def render_sheet(path, tiles):
    """All pictures, with label and seconds beneath each."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    ink = emission("Ink")
    ink.node_tree.nodes["Emission"].inputs["Color"].default_value = (0.8, 0.8, 0.8, 1)
    for index, (picture, label, seconds) in enumerate(tiles):
        width, total, height = add_tile(index, len(tiles), picture, f"{label}   {seconds:.1f} s", ink)
    scene.world = bpy.data.worlds.new("Paper")
    scene.world.use_nodes = False
    scene.world.color = (0.02, 0.02, 0.02)
    camera = bpy.data.cameras.new("Camera")
    camera.type = "ORTHO"
    camera.sensor_fit = "HORIZONTAL"
    camera.ortho_scale = width
    scene.camera = bpy.data.objects.new("Camera", camera)
    scene.camera.location = (width / 2, height - total / 2, 5)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = 640 * width
    scene.render.resolution_y = round(640 * total)
    use_engine(scene, "ray_casting", 16)
    render_to(path)


def build_vase():
    """A vase of few faces, whose vertices all miss its highlight; one face of its belly has it in the middle."""
    import common
    import shapes

    common.start("Vase", 600, 640)
    glaze = common.diffuse("Glaze", (0.16, 0.42, 0.44))
    classic = glaze.triptych
    classic.override, classic.diffuse = True, (0.16, 0.42, 0.44)
    classic.specular, classic.shininess = (0.35, 0.35, 0.35), 50
    outline = [(0, 0), (0.30, 0), (0.60, 0.40), (0.56, 0.80), (0.30, 1.16), (0.22, 1.40), (0.34, 1.60)]
    body = shapes.lathe(shapes.spline(outline, 11), 12)
    common.mesh_object("Vase", body, glaze, smooth=True)
    common.sun_light("Sun", (0.55, 0.80, -0.50), 3.5)
    common.world((0.030, 0.035, 0.045))
    common.camera((0, -6, 1.5), (0, 0, 0.8), lens=115)


def render_shadings(path):
    """Flat, Gouraud and Phong shading of the vase."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build_vase()
    bpy.ops.triptych.shading_sheet(filepath=str(path))
    print(f"demo: {path.name}", flush=True)


def render_whitted(path):
    """A glass and a mirror ball by ray tracing."""
    import whitted_spheres

    bpy.ops.wm.read_factory_settings(use_empty=True)
    whitted_spheres.build()
    use_engine(bpy.context.scene, "ray_tracing", 64)
    print(f"demo: {path.name} in {render_to(path):.1f} s", flush=True)


def main(folder):
    import still_life
    import triptych

    triptych.register()
    try:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        still_life.build()
        tiles = []
        for method, label in methods():
            use_engine(bpy.context.scene, method, 64)
            path = folder / f"{method}.png"
            tiles.append((path, label, render_to(path)))
            print(f"demo: {path.name} in {tiles[-1][2]:.1f} s", flush=True)
        render_sheet(folder / "methods.png", tiles)
        render_shadings(folder / "shadings.png")
        render_whitted(folder / "whitted_spheres.png")
    finally:
        triptych.unregister()


main(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).resolve())
