# SPDX-License-Identifier: GPL-3.0-or-later
"""The sheet of shadings by numbers: what its curves show, where its line is, and what the operator leaves behind."""

from math import cos, radians, sin

import bpy
import numpy as np
import pytest
import stage
from triptych import abi, as_rendered, core, lettering, shading_sheet

pytestmark = pytest.mark.library

WIDTH, HEIGHT = 160, 96
SCALE = 2.5  # what the camera sees from left to right
ANGLES = (-75, -45, -15, 15, 45, 75)  # of the barrel's edges


def barrel(scene, smooth=True):
    """Five upright strips of a cylinder, seen from afar and lit by the sun, so that strips are bands of the picture.

    The highlight, at 6 degrees, lies within the middle strip and misses the vertices, at ±15.
    """
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    edge = [(sin(radians(angle)), cos(radians(angle))) for angle in ANGLES]
    corners = [(x, y, z) for x, z in edge for y in (-2, 2)]
    strips = [(k, k + 2, k + 3, k + 1) for k in range(0, 2 * len(edge) - 2, 2)]
    made = stage.mesh(scene, "Barrel", corners, strips)
    for face in made.data.polygons:
        face.use_smooth = smooth
    material, _, _ = stage.material(made)
    classic = material.triptych
    classic.override, classic.diffuse, classic.specular, classic.shininess = True, (0.3, 0.5, 0.7), (0.6,) * 3, 200
    stage.light(scene, "SUN", energy=2, rotation=(0, 12, 0), angle=0)
    stage.camera(scene, (0, 0, 10), type="ORTHO", ortho_scale=SCALE)
    scene.triptych.raster_samples, scene.triptych.film_filter_width = 1, 0
    return made


def bands():
    """Slices of the columns well within each strip."""
    edges = [round((sin(radians(angle)) / SCALE + 0.5) * WIDTH) for angle in ANGLES]
    return [slice(first + 1, last - 1) for first, last in zip(edges, edges[1:], strict=False)]


def profiles(scene, row=HEIGHT // 2):
    """The luminance along a row, by method."""
    pictures, _ = shading_sheet.render(scene, scene.view_layers[0].name, lambda fraction: None)
    rows = [shading_sheet.luminance(picture[row]) for picture in pictures.values()]
    return dict(zip(shading_sheet.METHODS, rows, strict=True))


def sheet_pixels():
    image = bpy.data.images[shading_sheet.IMAGE]
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], 4)[..., :3]


def display(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def is_accent(pixels):
    return np.abs(pixels - display(shading_sheet.ACCENT)).max(axis=-1) < 0.02


def layout():
    return shading_sheet.Layout(3, WIDTH, HEIGHT)


def marked_row():
    """The scan line, as the tick left of the first picture has it."""
    place = layout()
    column = is_accent(sheet_pixels()[:, place.columns[0] - 2])
    return int(np.flatnonzero(column)[0]) - place.picture


# ------------------------------------------------------------------------------------------------------------- shadings


def test_flat_is_constant_in_each_polygon(scene):
    barrel(scene)
    flat = profiles(scene)["flat"]
    values = [flat[band] for band in bands()]
    assert max(np.ptp(band) for band in values) < 1e-6
    assert min(abs(a[0] - b[0]) for a, b in zip(values, values[1:], strict=False)) > 0.01


def test_gouraud_is_straight_in_each_polygon_and_kinks_between(scene):
    barrel(scene)
    gouraud = profiles(scene)["gouraud"]
    assert max(np.abs(np.diff(gouraud[band], 2)).max() for band in bands()) < 1e-5
    slopes = [np.diff(gouraud[band]).mean() for band in bands()]
    assert np.abs(np.diff(slopes)).min() > 3e-4
    steps = np.abs(np.diff(gouraud[bands()[0].start : bands()[-1].stop]))
    assert steps.max() < 1.01 * np.abs(slopes).max()  # no step at an edge


def test_phong_has_the_highlight_that_gouraud_misses(scene):
    """K_S S I_L on top of what is diffuse, in the middle strip, and a curve without the other's kinks."""
    barrel(scene)
    rows = profiles(scene)
    middle = bands()[2]
    light = 2 / np.pi
    assert rows["phong"][middle].max() == pytest.approx(light * (0.6 + 0.4719), rel=0.02)
    assert rows["gouraud"][middle].max() < 0.55 * light
    # Diffuse alone, the curve bends evenly: what Gouraud does at an edge is spread over both polygons.
    bpy.data.materials["Material"].triptych.specular = (0, 0, 0)
    rows = profiles(scene)
    inner = slice(bands()[1].start, bands()[3].stop)
    assert np.abs(np.diff(rows["phong"][inner], 2)).max() < 0.25 * np.abs(np.diff(rows["gouraud"][inner], 2)).max()


# ------------------------------------------------------------------------------------------------------------ the sheet


def test_the_curves_are_the_rendered_rows(scene):
    """Pictures and curves of the sheet against F12's by each method."""
    barrel(scene).rotation_euler.z = radians(20)
    assert bpy.ops.triptych.shading_sheet(height=0.25) == {"FINISHED"}
    row = round(0.25 * (HEIGHT - 1))
    assert marked_row() == row
    place, sheet = layout(), sheet_pixels()
    assert sheet.shape == (*place.shape, 3)
    rendered = []
    for method in shading_sheet.METHODS:
        scene.triptych.method = method
        rendered.append(stage.render(scene))
    rows = [picture[row, :, :3] @ np.float32([0.2126, 0.7152, 0.0722]) for picture in rendered]
    top = shading_sheet.scale_top(max(profile.max() for profile in rows))
    for x, picture, profile in zip(place.columns, rendered, rows, strict=True):
        shown = sheet[place.picture : place.picture + HEIGHT, x : x + WIDTH]
        others = np.abs(np.arange(HEIGHT) - row) > place.line
        assert np.abs(shown - display(picture[..., :3]))[others].max() < 0.6 / 255
        graph = sheet[place.graph : place.graph + place.graph_height, x : x + WIDTH]
        heights = profile / top * (place.graph_height - 1)
        assert is_accent(graph[np.round(heights).astype(int), np.arange(WIDTH)]).all()
        # Away from steps, the curve is nowhere else.
        calm = np.convolve(np.abs(np.diff(heights, append=heights[-1])) > 0.5, np.ones(9), "same") == 0
        assert np.count_nonzero(calm) > WIDTH // 4
        ink = np.abs(graph - display(shading_sheet.PAPER)).max(axis=-1)
        away = np.abs(np.arange(place.graph_height)[:, None] - heights) > place.line + 1
        assert ink[away & calm].max() < 0.01


def test_the_line_is_found_where_gouraud_and_phong_differ_most(scene):
    ball = barrel(scene)
    ball.scale.y, ball.location.y = 0.1, 0.3  # from y = 0.1 to 0.5
    bpy.ops.triptych.shading_sheet()
    place = (marked_row() + 0.5 - HEIGHT / 2) * SCALE / WIDTH
    assert 0.1 < place < 0.5
    bpy.ops.triptych.shading_sheet(automatic=True, height=0.1)
    assert (marked_row() + 0.5 - HEIGHT / 2) * SCALE / WIDTH == place
    bpy.ops.triptych.shading_sheet(height=1)
    assert marked_row() == HEIGHT - 1


def test_row_of_difference():
    one = np.zeros((5, 4, 4), np.float32)
    assert shading_sheet.row_of_difference(one, one) == 2
    other = one.copy()
    other[1, :, 0], other[3, 2, 1] = 0.1, -0.5
    assert shading_sheet.row_of_difference(one, other) == 3


def test_scale_top():
    tops = [shading_sheet.scale_top(most) for most in (0, 1, 0.71, 13, 0.0021)]
    assert tops == pytest.approx([1, 1, 0.8, 15, 0.0025])


def test_any_size_and_a_clear_background():
    """One pixel and a strip compose; where a picture is clear, the paper is seen."""
    for height, width in ((1, 1), (3, 200), (200, 3)):
        clear = np.zeros((height, width, 4), np.float32)
        sheet = shading_sheet.compose({"A": clear, "B": clear}, 0, lambda text, size: np.ones((size, 2)))
        place = shading_sheet.Layout(2, width, height)
        assert sheet.shape == (*place.shape, 3) and np.isfinite(sheet).all()
        if height > 1:
            top = sheet[place.picture + height - 1, place.columns[0]]
            assert top == pytest.approx(display(shading_sheet.PAPER), abs=1e-5)


def test_letters_cover_what_they_cover_in_blender(addon):
    """The mask's sum is the area of the letters' faces; L stands on its foot."""
    mask = lettering.mask("Lag", 60)
    content = lettering.curve("Lag", 60)
    words = bpy.data.objects.new("Words", content)
    assert mask.sum() == pytest.approx(sum(face.area for face in words.to_mesh().polygons), rel=0.01)
    foot = lettering.mask("L", 60).sum(axis=1)
    lines = np.flatnonzero(foot > 0.5)
    assert foot[lines[: len(lines) // 2]].sum() > 1.3 * foot[lines[len(lines) // 2 :]].sum()


# -------------------------------------------------------------------------------------------------- what is left behind


def test_the_image_is_written_and_stays_in_the_file(scene, tmp_path):
    barrel(scene)
    bpy.ops.triptych.shading_sheet(filepath=str(tmp_path / "sheet"))
    pixels = sheet_pixels()
    written = bpy.data.images.load(str(tmp_path / "sheet.png"))
    assert np.reshape(written.pixels, (*pixels.shape[:2], 4))[..., :3] == pytest.approx(pixels)
    (tmp_path / "sheet.png").unlink()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "file.blend"))
    assert np.array_equal(sheet_pixels(), pixels)


def test_undo_and_redo(scene):
    barrel(scene)
    bpy.ops.ed.undo_push(message="Barrel")
    bpy.ops.triptych.shading_sheet("EXEC_DEFAULT", True)
    pixels = sheet_pixels()
    bpy.ops.ed.undo()
    assert shading_sheet.IMAGE not in bpy.data.images
    bpy.ops.ed.redo()
    assert np.array_equal(sheet_pixels(), pixels)


def test_a_second_sheet_takes_the_place_of_the_first(scene):
    barrel(scene)
    bpy.ops.triptych.shading_sheet()
    holder = bpy.data.textures.new("Holder", "IMAGE")
    holder.image = bpy.data.images[shading_sheet.IMAGE]
    scene.render.resolution_x = 80
    bpy.ops.triptych.shading_sheet()
    assert [image.name for image in bpy.data.images if image.name.startswith("Triptych")] == [shading_sheet.IMAGE]
    assert holder.image == bpy.data.images[shading_sheet.IMAGE]
    assert holder.image.size[0] == shading_sheet.Layout(3, 80, HEIGHT).shape[1]


def test_it_is_shown_in_an_image_editor(scene):
    barrel(scene)
    area = bpy.context.window_manager.windows[0].screen.areas[0]
    area.ui_type = "IMAGE_EDITOR"
    bpy.ops.triptych.shading_sheet()
    assert area.spaces.active.image == bpy.data.images[shading_sheet.IMAGE]


def test_nothing_else_changes(scene, tmp_path):
    """Not the settings, not what is in the file, and not the picture of the last render."""
    barrel(scene)
    scene.render.use_border, scene.render.border_max_x, scene.render.use_compositing = True, 0.5, True

    def state():
        render = scene.render
        settings = (render.engine, render.use_border, render.use_compositing, scene.triptych.method)
        counts = [len(getattr(bpy.data, name)) for name in ("objects", "meshes", "curves", "materials", "scenes")]
        result = bpy.data.images["Render Result"]
        scene.render.image_settings.file_format = "PNG"
        result.save_render(str(tmp_path / "result.png"))
        return settings, counts, result.render_slots.active_index, (tmp_path / "result.png").read_bytes()

    stage.render(scene)
    before = state()
    bpy.ops.triptych.shading_sheet()
    assert state() == before
    bpy.ops.triptych.shading_sheet()
    assert state() == before
    names = [slot.name for slot in bpy.data.images["Render Result"].render_slots]
    assert names.count(as_rendered.RENDER_SLOT) == 1
    assert marked_row() >= 0 and sheet_pixels().shape == (*layout().shape, 3)  # the border cuts nothing off


def test_settings_reach_the_sheet(scene):
    barrel(scene)
    scene.triptych.shading_ambient = (0.5, 0.5, 0.5)
    plain = profiles(scene)["phong"]
    scene.triptych.shading_ambient = (1, 1, 1)
    ambient = 0.5 * (0.2126 * 0.3 + 0.7152 * 0.5 + 0.0722 * 0.7)
    assert (profiles(scene)["phong"] - plain)[bands()[1]] == pytest.approx(ambient, rel=1e-4)


# --------------------------------------------------------------------------------------------------------------- errors


def fails(match, **values):
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.triptych.shading_sheet(**values)


def test_without_a_camera(scene):
    barrel(scene)
    scene.camera = None
    fails("there is no camera")
    assert shading_sheet.IMAGE not in bpy.data.images


def test_cameras_that_will_not_do(scene):
    barrel(scene)
    camera = scene.camera.data
    camera.type = "PANO"
    fails("PANO")
    camera.type, camera.dof.use_dof = "PERSP", True
    fails("depth of field")
    camera.dof.use_dof = False
    bpy.ops.triptych.shading_sheet()
    scene.camera = scene.objects["Barrel"]
    fails("no camera")


def test_without_the_library(scene, monkeypatch):
    barrel(scene)
    monkeypatch.setenv("TRIPTYCH_LIBRARY", "/nowhere/libtriptych.so")
    monkeypatch.setattr(abi, "_library", None)
    fails("/nowhere/libtriptych.so")


def test_a_file_that_cannot_be_written(scene, tmp_path):
    barrel(scene)
    (tmp_path / "file").write_text("")
    fails("could not be saved|not write|Not a directory", filepath=str(tmp_path / "file" / "sheet.png"))
    assert shading_sheet.IMAGE in bpy.data.images


def test_captions_are_the_methods_labels(scene):
    barrel(scene)
    pictures, _ = shading_sheet.render(scene, scene.view_layers[0].name, lambda fraction: None)
    labels = {name: label for name, label, _ in core.methods()}
    assert list(pictures) == [labels[name] for name in shading_sheet.METHODS]


def test_unregister_takes_the_operator_away(addon):
    assert "shading_sheet" in dir(bpy.ops.triptych)
    addon.unregister()
    try:
        assert "shading_sheet" not in dir(bpy.ops.triptych)
    finally:
        addon.register()
