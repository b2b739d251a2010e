# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images to data.Texture: by path, by the bytes of a packed file, or by pixels where Blender made them."""

import os
import struct
import zlib

import bpy
import numpy as np

from . import data

_LINEAR = {"Non-Color", "Raw", "Linear", "Linear Rec.709", "Generic Data", "data"}


class Textures:
    """The scene's textures: an image is exported once for each way of reading it."""

    def __init__(self, scene):
        """scene: the data.Scene whose textures are filled."""
        self._scene = scene
        self._known = {}

    def add(self, image, user=None, wrap=("repeat", "repeat"), filtering="smooth"):
        """The index of the texture for a bpy.types.Image; wrap and filtering: as in data.Texture."""
        key = (image.as_pointer(), wrap, filtering)
        if key not in self._known:
            texture = data.Texture(image.name, color_space=self._color_space(image), wrap=wrap, filter=filtering)
            self._fill(texture, image, user)
            self._known[key] = len(self._scene.textures)
            self._scene.textures.append(texture)
        return self._known[key]

    def _color_space(self, image):
        name = image.colorspace_settings.name
        if name == "sRGB":
            return "srgb"
        if name not in _LINEAR and not getattr(image.colorspace_settings, "is_data", False):
            self._scene.warn(f"image '{image.name}': the colour space {name} is not supported; it is read as linear")
        return "linear"

    def _fill(self, texture, image, user):
        made_here = image.source == "GENERATED" or image.is_dirty
        if image.packed_file is not None and not image.is_dirty:
            texture.file_data = bytes(image.packed_file.data)
        elif made_here and image.has_data or (made_here and image.source == "GENERATED"):
            self._fill_pixels(texture, image)
        else:
            if image.source in {"MOVIE", "TILED", "VIEWER"}:
                self._scene.warn(f"image '{image.name}': the source {image.source} is not supported; its file is read")
            path = image.filepath_from_user(image_user=user) if user is not None else image.filepath_from_user()
            texture.path = os.path.abspath(bpy.path.abspath(path, library=image.library)) if path else ""
            if not os.path.isfile(texture.path):
                self._scene.warn(f"image '{image.name}': cannot read '{texture.path or '(no file)'}'")

    @staticmethod
    def _fill_pixels(texture, image):
        width, height = image.size
        channels = image.channels
        pixels = np.empty(width * height * channels, np.float32)
        image.pixels.foreach_get(pixels)
        pixels = pixels.reshape(height, width, channels)
        if image.is_float:
            # Blender keeps floating-point pictures in its linear working space.
            texture.pixels, texture.color_space = np.nan_to_num(pixels, copy=False), "linear"
        else:
            texture.file_data = png_bytes(np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8))


def png_bytes(pixels):
    """A PNG file of height × width × channels (1 to 4) uint8, row 0 at the bottom."""
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # each row starts with its filter: none
    rows[:, 1:] = pixels[::-1].reshape(height, -1)

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 2: 4, 3: 2, 4: 6}[channels], 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def exr_bytes(pixels):
    """An OpenEXR file (scan lines, 32-bit float, uncompressed) of height × width × channels, row 0 at the bottom."""
    height, width, channels = pixels.shape
    names = {1: "Y", 2: "YA", 3: "RGB", 4: "RGBA"}[channels]
    order = sorted(range(channels), key=lambda k: names[k])

    def attribute(name, kind, content):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(content)) + content

    listed = b"".join(names[k].encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for k in order) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = b"\x76\x2f\x31\x01" + struct.pack("<I", 2)
    header += attribute(b"channels", b"chlist", listed)
    header += attribute(b"compression", b"compression", b"\0")
    header += attribute(b"dataWindow", b"box2i", window)
    header += attribute(b"displayWindow", b"box2i", window)
    header += attribute(b"lineOrder", b"lineOrder", b"\0")
    header += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    header += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    header += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))
    header += b"\0"
    line = 8 + 4 * width * channels
    start = len(header) + 8 * height
    offsets = (start + line * np.arange(height)).astype("<u8").tobytes()
    body = bytearray()
    top_down = pixels[::-1].astype("<f4")
    for y in range(height):
        body += struct.pack("<ii", y, line - 8)
        for k in order:
            body += top_down[y, :, k].tobytes()
    return header + offsets + bytes(body)
