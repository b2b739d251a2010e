# SPDX-License-Identifier: GPL-3.0-or-later
"""The sheet of shadings: one scene by flat, Gouraud and Phong shading, the intensity along one scan line under each.

It shows why one goes from each to the next: steps from polygon to polygon; kinks at their edges, which the eye sees as
Mach bands, and a highlight that is lost between vertices; a smooth curve with the highlight in it.
"""

from math import floor, log10

import bpy
import numpy as np

from . import abi, core, data, lettering
from .as_rendered import export_to_render, no_render_runs

METHODS = ("flat", "gouraud", "phong")
IMAGE = "Triptych Shadings"

# Linear light.
PAPER, FRAME, INK = (np.full(3, value, np.float32) for value in (0.02, 0.10, 0.8))
ACCENT = np.float32([1.0, 0.35, 0.03])  # the scan line and its curve
_REC709 = np.float32([0.2126, 0.7152, 0.0722])
_STEPS = (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)


# ------------------------------------------------------------------------------------------------------------ the sheet


def luminance(picture):
    """The intensity of linear pixels, by Rec. 709."""
    return picture[..., :3] @ _REC709


def row_of_difference(one, other):
    """The row in which two pictures differ most, by the sum of squares; the middle one where they are the same."""
    difference = ((luminance(one) - luminance(other)) ** 2).sum(axis=1)
    return int(difference.argmax()) if difference.any() else len(difference) // 2


def scale_top(most):
    """A round number just above the greatest intensity: the top of the graphs."""
    if most <= 0:
        return 1.0
    power = 10.0 ** floor(log10(most))
    return next((step * power for step in _STEPS if most <= step * power), 10 * power)


class Layout:
    """Where things stand on a sheet of pictures of one size, in pixels from its bottom left corner."""

    def __init__(self, count, width, height):
        self.letter = max(width // 26, 9)
        self.line = max(round(width / 300), 1)
        self.gap = self.letter
        first = 3 * self.letter  # after the graphs' scale
        self.columns = [first + k * (width + self.gap) for k in range(count)]  # of the pictures and of their graphs
        self.graph_height = max(round(0.4 * width), 16)
        self.graph = self.gap
        self.picture = self.graph + self.graph_height + self.gap
        self.caption = self.picture + height + self.gap // 3
        self.shape = (self.caption + 2 * self.letter, self.columns[-1] + width + self.gap)


def compose(pictures, row, letter):
    """The sheet in display values: height × width × 3, sRGB, row 0 at the bottom.

    pictures: {caption: height × width × 4, linear}; row: the scan line, from the bottom; letter(text, size): a line of
    text as lettering.mask has it.
    """
    height, width = next(iter(pictures.values())).shape[:2]
    layout = Layout(len(pictures), width, height)
    sheet = np.empty((*layout.shape, 3), np.float32)
    sheet[:] = PAPER
    profiles = [luminance(picture[row]) for picture in pictures.values()]
    top = scale_top(max(profile.max() for profile in profiles))
    for x, (caption, picture), profile in zip(layout.columns, pictures.items(), profiles, strict=True):
        _blend(sheet, x, layout.caption, letter(caption, layout.letter), INK)
        place = sheet[layout.picture : layout.picture + height, x : x + width]
        place[:] = picture[..., :3] + (1 - picture[..., 3:]) * PAPER
        _mark(sheet, layout, x, layout.picture + row, width)
        _graph(sheet, layout, x, profile * ((layout.graph_height - 1) / top))
    size = 2 * layout.letter // 3
    for text, y in (("0", layout.graph), (f"{top:g}", layout.graph + layout.graph_height)):
        words = letter(text, size)
        _blend(sheet, max(layout.columns[0] - words.shape[1] - size // 2, 0), y - size // 2, words, INK)
    words = np.rot90(letter("Intensity", size), -1)
    _blend(sheet, size, layout.graph + (layout.graph_height - len(words)) // 2, words, INK)
    return _display(sheet)


def _blend(sheet, x, y, mask, color):
    """Lays a colour over the sheet where the mask is."""
    place = sheet[y : y + mask.shape[0], x : x + mask.shape[1]]
    place += mask[: place.shape[0], : place.shape[1], None] * (color - place)


def _mark(sheet, layout, x, y, width):
    """The scan line: faint across the picture, firm beside it."""
    first, tick = y - (layout.line - 1) // 2, layout.gap // 2
    _blend(sheet, x, first, np.full((layout.line, width), 0.5), ACCENT)
    for start in (x - tick, x + width):
        _blend(sheet, start, first, np.ones((layout.line, tick)), ACCENT)


def _graph(sheet, layout, x, heights):
    """A frame, its lower side at 0, and the curve through the heights, in pixels, one for each column."""
    line, rows, width = layout.line, layout.graph_height, len(heights)
    outside = sheet[layout.graph - line : layout.graph + rows + line, x - line : x + width + line]
    outside[:] = FRAME
    outside[:line] = INK
    outside[line:-line, line:-line] = PAPER
    _blend(sheet, x, layout.graph, _curve(heights, rows, line + 1), ACCENT)


def _curve(heights, rows, thickness):
    """The mask of a line that joins the heights of neighbouring columns."""
    ends = np.append(heights, heights[-1])
    x, y = np.arange(len(heights)), np.arange(rows)[:, None]
    nearest = np.full((rows, len(heights)), np.inf)
    reach = thickness // 2 + 1
    for shift in range(-reach, reach):
        start = (x + shift).clip(0, len(heights) - 1)
        rise = ends[start + 1] - ends[start]
        along = ((x - start + (y - ends[start]) * rise) / (1 + rise**2)).clip(0, 1)
        np.minimum(nearest, np.hypot(x - start - along, y - ends[start] - along * rise), out=nearest)
    return (thickness / 2 + 0.5 - nearest).clip(0, 1)


def _display(linear):
    linear = linear.clip(0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


# ------------------------------------------------------------------------------------------------------------ rendering


def render(scene, view_layer, progress):
    """({caption: pixels} by each of METHODS, warnings) of a bpy.types.Scene, exported once.

    progress(fraction of the whole) is called now and then.
    """
    abi.library()
    source = export_to_render(scene, view_layer)
    labels = {name: label for name, label, _ in core.methods()}
    pictures = {}
    with core.Scene() as core_scene:
        core_scene.fill(source)
        core_scene.commit(int(source.settings.get("threads", 0)))
        for done, method in enumerate(METHODS):
            with core.Render(core_scene, method) as job:
                job.set_film(*source.film)
                for name, value in source.settings.items():
                    job.set(name, value)
                job.run(lambda state, done=done: progress((done + state.fraction) / len(METHODS)) or True)
                pictures[labels[method]] = job.read("Combined", 0, 0, *source.film)
        return pictures, source.warnings + core_scene.warnings()


def _image(sheet):
    """The sheet as the packed image IMAGE, in place of the one of that name; it stays in the file."""
    height, width = sheet.shape[:2]
    made = bpy.data.images.new(IMAGE, width, height)
    before = bpy.data.images.get(IMAGE)
    if before != made:
        before.user_remap(made)
        bpy.data.images.remove(before)
        made.name = IMAGE
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = sheet
    made.pixels.foreach_set(pixels.ravel())
    made.update()
    made.pack()
    made.use_fake_user = True
    return made


def _show(image, windows):
    """Shows the image in an image editor, if there is one and none shows it yet."""
    areas = [area for window in windows for area in window.screen.areas if area.ui_type == "IMAGE_EDITOR"]
    if areas and all(area.spaces.active.image != image for area in areas):
        areas[0].spaces.active.image = image


class TRIPTYCH_OT_shading_sheet(bpy.types.Operator):
    bl_idname = "triptych.shading_sheet"
    bl_label = "Sheet of Shadings"
    bl_description = (
        "Render the scene with flat, Gouraud and Phong shading side by side. Under each picture, "
        "a curve shows how bright it is along one line across it"
    )
    bl_options = {"REGISTER", "UNDO"}

    automatic: bpy.props.BoolProperty(
        name="Find the Line",
        description="Take the line where Gouraud and Phong shading differ most",
        default=True,
    )
    height: bpy.props.FloatProperty(
        name="Height",
        description="Where in the picture the line is, from the bottom (0) to the top (1)",
        subtype="FACTOR",
        default=0.5,
        min=0,
        max=1,
    )
    filepath: bpy.props.StringProperty(
        name="File", description="Where to write the sheet as a PNG too", subtype="FILE_PATH", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return no_render_runs(cls)

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context):
        column = self.layout.column()
        column.prop(self, "automatic")
        line = column.column()
        line.active = not self.automatic
        line.prop(self, "height")

    def execute(self, context):
        manager = context.window_manager
        manager.progress_begin(0, 1)
        try:
            pictures, warnings = render(context.scene, context.view_layer.name, manager.progress_update)
            sheet = compose(pictures, self._row(*list(pictures.values())[1:]), lettering.mask)
        except (abi.LibraryMissing, abi.Error, data.ExportError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        for line in warnings:
            self.report({"WARNING"}, line)
        image = _image(sheet)
        _show(image, manager.windows)
        self.report({"INFO"}, f"The sheet is the image '{image.name}'")
        if self.filepath:
            image.filepath_raw, image.file_format = bpy.path.ensure_ext(self.filepath, ".png"), "PNG"
            try:
                image.save()
            except RuntimeError as error:
                self.report({"ERROR"}, str(error))
        return {"FINISHED"}

    def _row(self, gouraud, phong):
        """The scan line. A height that a script gives is meant, even without automatic=False."""
        given = self.properties.is_property_set
        if self.automatic and (given("automatic") or not given("height")):
            return row_of_difference(gouraud, phong)
        return round(self.height * (len(phong) - 1))


def _draw(self, context):
    if context.engine == "TRIPTYCH":
        self.layout.operator(TRIPTYCH_OT_shading_sheet.bl_idname)


def register():
    bpy.utils.register_class(TRIPTYCH_OT_shading_sheet)
    bpy.types.TOPBAR_MT_render.append(_draw)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_draw)
    bpy.utils.unregister_class(TRIPTYCH_OT_shading_sheet)
